#!/usr/bin/env python3
"""Changes files that the program reads at random, runs it, and tells how it ends.

usage: mutate_inputs.py PROGRAM FOLDER [RUNS] [SEED] [KIND...]

What libFuzzer cannot do in one process: whole files of HDF5 and TIFF as bytes, commands from end to
end. Each run of a kind (relief, geotiff, frame, plates, folder) must end with a code of the contract
and, unless that is 0, one line of error. All others are kept in FOLDER/finds; ends with 1 if there
are any. Sound files are made by the program itself in FOLDER/sound.
"""

import os
import random
import re
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

HEADERS = rb"OHDR|OCHK|FRHP|FHDB|BTHD|BTLF|TREE|SNOD|HEAP|GCOL|BTIN|FADB|FAHD|EAHD|EADB|FSHD|FSSE"
NUMBERS = (b"1e999", b"-1", b"0", b"1e300", b"nan", b"null", b'"x"', b"[]", b"{}",
           b"99999999999999999999", b"1e-320", b"-90.0000001", b"361", b"true")
DRIFT = """[run]
seed = 3
grid = "32x16"
to = "plates"
[plates]
model = "sphere"

[plates.sphere]
samples = 1500
time_myr = 20.0
frames_myr = 10.0
"""
SECONDS = 120  # a reader gives up after 20 s of its own


def changed_text(data, dice):
    number = list(re.finditer(rb"-?\d+\.?\d*", data))
    if not number or dice.random() < 0.6:
        return changed_bytes(data, dice)
    at = dice.choice(number)
    return data[:at.start()] + dice.choice(NUMBERS) + data[at.end():]


def changed_bytes(data, dice):
    data = bytearray(data)
    at, size = dice.randrange(len(data)), dice.choice((1, 4, 8, 64, 512))
    kind = dice.randrange(7)
    if kind == 0:
        data[at] ^= 1 << dice.randrange(8)
    elif kind == 1:
        for _ in range(size):
            data[dice.randrange(len(data))] = dice.randrange(256)
    elif kind == 2:
        del data[at:]
    elif kind == 3:
        data[at:at + size] = bytes([dice.choice((0, 255))]) * len(data[at:at + size])
    elif kind == 4:
        data[at:at] = bytes(dice.randrange(256) for _ in range(size))
    elif kind == 5:
        del data[at:at + size]
    else:
        number = dice.choice((0, 1, 2**16, 2**31 - 1, 2**32 - 1, 2**63 - 1))
        data[at:at + 8] = number.to_bytes(8, "little")
    return bytes(data)


def changed_hdf5(data, dice):
    """Mostly within what HDF5 keeps about its data."""
    places = [match.start() for match in re.finditer(HEADERS, data)]
    if not places or dice.random() < 0.3:
        return changed_bytes(data, dice)
    data = bytearray(data)
    for _ in range(dice.choice((1, 1, 2, 4))):
        at = dice.choice(places) + dice.randrange(dice.choice((16, 64, 256)))
        if at < len(data):
            data[at] = dice.choice((dice.randrange(256), 0, 255, data[at] ^ 1 << dice.randrange(8)))
    return bytes(data)


class Trial:
    def __init__(self, program, folder, seed):
        self.program, self.folder, self.sound = program, folder, folder / "sound"
        self.dice = random.Random(seed)

    def run(self, *arguments):
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_WAIT_POLICY="passive")
        try:
            result = subprocess.run([self.program, *map(str, arguments)], capture_output=True,
                                    timeout=SECONDS, env=environment, check=False)
        except subprocess.TimeoutExpired:
            return "never", ""
        return result.returncode, result.stderr.decode(errors="replace")

    def make_sound_files(self):
        self.sound.mkdir(parents=True, exist_ok=True)
        config = self.sound / "drift.toml"
        config.write_text(DRIFT)
        for arguments in (
                ("run", "--preset", "preview", "--grid", "64x32", "-o", self.sound / "run", "--no-vtk",
                 "--no-maps", "--overwrite", "--set", "climate.resolution_deg=10", "--set", "island.nx=64",
                 "--set", "island.ny=32", "--set", "island.cell_m=2000"),
                ("run", config, "-o", self.sound / "drift", "--no-vtk", "--no-maps", "--overwrite")):
            code, error = self.run(*arguments)
            if code != 0:
                sys.exit(error)
        shutil.copy(self.sound / "run" / "03-erosion.nc", self.sound / "relief.nc")
        for name, corners in (("relief", ()), ("exemplar", ("-a_ullr", "10", "46", "14", "44"))):
            subprocess.run(["gdal_translate", "-q", *corners, f"NETCDF:{self.sound}/relief.nc:elevation",
                            str(self.sound / f"{name}.tif")], check=False)
        (self.sound / "exemplars").mkdir(exist_ok=True)
        shutil.copy(self.sound / "exemplar.tif", self.sound / "exemplars")
        for arguments in (self.dem(f"{self.sound}/relief.nc:elevation"), self.dem(self.sound / "relief.tif"),
                          self.exemplars(self.sound / "exemplars")):
            code, error = self.run(*arguments)  # refused unchanged they would try nothing
            if code != 0:
                sys.exit(error)

    def dem(self, file):
        return "run", "--dem", file, "--dry-run", "-o", self.folder / "new"

    def exemplars(self, folder):
        return (*self.dem(f"{self.sound}/relief.nc:elevation"), "--exemplars", folder)

    def write(self, source, change, target):
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(change(source.read_bytes(), self.dice))
        return target

    def drift(self, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        return ("run", self.sound / "drift.toml", "--no-vtk", "--no-maps", "--overwrite", "-o",
                self.folder / "out", "--set", "plates.sphere.frames_myr=0", *words)

    def relief(self):
        file = self.write(self.sound / "relief.nc", changed_hdf5, self.folder / "in.nc")
        return file, self.dice.choice((self.dem(f"{file}:elevation"), ("score", file), ("info", file)))

    def geotiff(self):
        if self.dice.random() < 0.5:
            file = self.write(self.sound / "relief.tif", changed_bytes, self.folder / "in.tif")
            return file, self.dem(file)
        file = self.write(self.sound / "exemplar.tif", changed_bytes, self.folder / "exemplars" / "in.tif")
        return file, self.exemplars(file.parent)

    def frame(self):
        frames = sorted((self.sound / "drift" / "frames").glob("*.nc"))
        file = self.write(self.dice.choice(frames), changed_hdf5, self.folder / "in.nc")
        return file, self.drift(f"fields.start_frame={file}")

    def plates(self):
        seeds = sorted((Path(__file__).parent / "corpus" / "plates").iterdir())
        file = self.write(self.dice.choice(seeds), changed_text, self.folder / "in.geojson")
        return file, self.drift(f"fields.plates={file}", "plates.sphere.time_myr=4")

    def folder_of_run(self):
        run = self.folder / "run"
        shutil.rmtree(run, ignore_errors=True)
        shutil.copytree(self.sound / "run", run)
        stages = sorted(run.glob("*.nc"))
        file = self.dice.choice(stages * 4 + [run / "manifest.json", run / "config.toml"])
        self.write(file, changed_hdf5 if file in stages else changed_text, file)
        return file, self.dice.choice((
            ("score", run), ("score", self.dice.choice(stages)), ("info", self.dice.choice(stages)),
            ("maps", run, "--width", "256"), ("island", run, "--size", "64,32", "--no-maps"),
            ("run", "--resume", "-o", run)))

    def try_once(self, kind, number):
        """How the program ended; what is wrong with that, or nothing."""
        file, arguments = (self.folder_of_run if kind == "folder" else getattr(self, kind))()
        code, error = self.run(*arguments)
        errors = [line for line in error.splitlines() if "error: " in line]
        good = code == 0 or code in (2, 3, 4) and len(errors) == 1
        if not good:
            kept = self.folder / "finds" / f"{kind}-{number}"
            kept.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, kept)
            (kept / "how").write_text(f"{' '.join(map(str, arguments))}\n{code}\n{error}")
        return code, None if good else f"{arguments[0]}: {code} {error.strip()[-160:]}"


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder = Path(sys.argv[2]).absolute()
    runs, seed = (int(word) for word in (sys.argv[3:5] + ["100", "1"][len(sys.argv[3:5]):]))
    trial = Trial(sys.argv[1], folder, seed)
    trial.make_sound_files()
    finds = 0
    for kind in sys.argv[5:] or ("relief", "geotiff", "frame", "plates", "folder"):
        ends = Counter()
        for number in range(runs):
            code, wrong = trial.try_once(kind, f"{seed}-{number}")
            ends[code] += 1
            if wrong:
                finds += 1
                print(f"{kind} {number}: {wrong}", flush=True)
        print(kind, runs, "runs ended with", dict(ends), flush=True)
    sys.exit(1 if finds else 0)


if __name__ == "__main__":
    main()
