#!/usr/bin/env python3
"""Ends runs at random moments, fills their disk, takes their folder away: check_faults.py PROGRAM FOLDER [options]

Every fault must leave whole files under final names, one line of error with the right exit code, and a folder that
--resume completes to the same values, bit for bit. Random moments come from --seed, so that a failure can be repeated.
Faults that need rights which this user lacks (mounting a small disk) are skipped and said so.
"""
import argparse
import filecmp
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

COARSE_AIR = ["--set", "climate.resolution_deg=10"]
PLANET = ["run", "--preset", "preview", "--grid", "96x48", "--to", "island", "--set", "output.vtk=true",
          "--set", "output.globe=true", "--set", "output.map_width_px=300", "--set", "island.nx=64", "--set", "island.ny=32",
          "--set", "erosion.steps=10", *COARSE_AIR, "--threads", "2"]
DRIFT = ["run", "--preset", "sphere", "--grid", "64x32", "--to", "erosion", "--no-maps", "--set",
         "plates.sphere.samples=3000", "--set", "plates.sphere.time_myr=120", "--set", "plates.sphere.frames_myr=10",
         *COARSE_AIR, "--threads", "2"]
FIT = ["calibrate", "--target", "earth", "--preset", "preview", "--set", "calibration.grid=64x32", "--set",
       "calibration.seeds=1", "--set", "calibration.held_out=2", "--set", "calibration.held_out_grid=", "--set",
       "calibration.iterations=3", *COARSE_AIR, "--threads", "2"]


class Failure(Exception):
    pass


def require(holds, what):
    if not holds:
        raise Failure(what)


class Faults:
    def __init__(self, program, folder, seed):
        self.program, self.folder, self.random = program, folder, random.Random(seed)
        self.skipped = []
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        self.environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}

    # Running ------------------------------------------------------------------------------------

    def start(self, arguments, out, **how):
        return subprocess.Popen([self.program, *arguments, "-o", str(out)], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.environment, **how)

    def finish(self, running, seconds=600):
        try:
            out, err = running.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            running.kill()
            raise Failure(f"hangs: {' '.join(running.args)}")
        return running.returncode, out, err

    def call(self, arguments, out, **how):
        return self.finish(self.start(arguments, out, **how))

    def straight(self, name, arguments, codes=(0,)):
        """An undisturbed run to compare with, and how long it takes."""
        out = self.folder / f"{name}-straight"
        begun = time.monotonic()
        code, _, err = self.call(arguments, out)
        require(code in codes, f"{name}: exit {code}: {err}")
        return out, time.monotonic() - begun

    # Judging ------------------------------------------------------------------------------------

    def results(self, out):
        """What must be equal: digests of all fields, or what a fit has found."""
        if (out / "calibration.json").exists():
            found = json.loads((out / "calibration.json").read_text())
            return {key: found[key] for key in ("parameters", "fitted", "held_out", "cost") if key in found}
        stages = json.loads((out / "manifest.json").read_text())["stages"]
        return {f"{s['name']}/{f}": v["digest"] for s in stages for f, v in s["fields"].items()}

    def one_line(self, err, what):
        lines = [line for line in err.splitlines() if "error:" in line]
        require(len(lines) == 1, f"{what}: {len(lines)} lines of error instead of one: {err!r}")

    def no_leftovers(self, out):
        left = [p.name for p in out.rglob("*") if p.name.endswith(".tmp")]
        require(not left, f"temporary files are left: {left}")

    @staticmethod
    def ended(out):
        """Whether all has been done; --resume alone would go on beyond its --to."""
        manifest = out / "manifest.json"
        return manifest.exists() and json.loads(manifest.read_text())["complete"]

    def resumed(self, arguments, out, straight, codes=(0,)):
        """The folder goes on to what the undisturbed run has made."""
        if not (out / "config.toml").exists():  # ended before anything was written
            resume = [*arguments, "--overwrite"]
        elif arguments[0] == "calibrate" or self.ended(out):
            resume = [*arguments, "--resume"]
        else:
            resume = ["run", "--resume"]
        code, _, err = self.call(resume, out)
        if code == 2 and arguments[0] == "calibrate" and "nothing to resume" in err:
            code, _, err = self.call([*arguments, "--overwrite"], out)
        require(code in codes, f"resume: exit {code}: {err}")
        ours, theirs = self.results(out), self.results(straight)
        differing = [key for key in theirs if ours.get(key) != theirs[key]]
        require(not differing, f"resumed to other values: {differing[:5]}")
        self.no_leftovers(out)
        names = lambda folder: sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
        require(names(out) == names(straight), f"other files: {set(names(out)) ^ set(names(straight))}")

    # Faults -------------------------------------------------------------------------------------

    def kills(self, name, arguments, count, codes=(0,)):
        straight, seconds = self.straight(name, arguments, codes)
        hit = 0
        for k in range(count):
            out = self.folder / f"{name}-killed"
            shutil.rmtree(out, ignore_errors=True)
            running = self.start(arguments, out)
            for life in range(self.random.choice((1, 1, 2))):  # some are killed in their second life too
                if life > 0:
                    if arguments[0] != "run" or not (out / "config.toml").exists() or self.ended(out):
                        break
                    running = self.start(["run", "--resume"], out)
                begun = time.monotonic()
                try:
                    running.wait(self.random.uniform(0.0, seconds))
                    if life == 0:  # it has done all: the machine is less busy than it was
                        seconds = min(seconds, time.monotonic() - begun)
                except subprocess.TimeoutExpired:
                    hit += 1
                running.kill()
                self.finish(running)
            try:
                self.resumed(arguments, out, straight, codes)
            except Failure as failure:
                raise Failure(f"{name}, kill {k}: {failure}")
        print(f"{name}: {count} kills, {hit} of them in mid-run ({seconds:.1f} s)", flush=True)

    def signals(self, name, arguments):
        straight, seconds = self.straight(name, arguments)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            out = self.folder / f"{name}-{number.name}"
            running = self.start(arguments, out)
            while not (out / "config.toml").exists() and running.poll() is None:  # the run has begun
                time.sleep(0.01)
            time.sleep(seconds * self.random.uniform(0.0, 0.5))
            running.send_signal(number)
            code, _, err = self.finish(running)
            require(code in (0, 130), f"{number.name}: exit {code}: {err}")
            if code == 130:
                self.one_line(err, number.name)
                self.no_leftovers(out)
            self.resumed(arguments, out, straight)
        print(f"{name}: SIGINT, SIGTERM, SIGHUP", flush=True)

    def full_disk(self, name, arguments, levels):
        straight, _ = self.straight(name, arguments)
        size = sum(p.stat().st_size for p in straight.rglob("*") if p.is_file())
        disk = self.folder / "disk"
        disk.mkdir()
        told = 0
        for level in range(1, levels + 1):
            room = size * level // (levels + 1)
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={room}", "terrane", str(disk)],
                                     capture_output=True, check=False)
            if mounted.returncode != 0:
                self.skipped.append("full disk: may not mount a small disk here")
                return
            try:
                out = disk / "out"
                code, _, err = self.call(arguments, out)
                require(code == 4, f"disk of {room} bytes: exit {code}: {err}")
                self.one_line(err, f"disk of {room} bytes")
                told += 1
                if out.exists():
                    self.no_leftovers(out)
                subprocess.run(["mount", "-o", f"remount,size={4 * size + (64 << 20)}", str(disk)], check=True)
                self.resumed(arguments, out, straight)
            finally:
                subprocess.run(["umount", "-l", str(disk)], check=True)
        print(f"{name}: disk full at {told} levels", flush=True)

    def disk_that_fills(self, name, arguments, levels):
        """Somebody else takes the room after the run has looked how much there is."""
        straight, seconds = self.straight(name, arguments)
        size = sum(p.stat().st_size for p in straight.rglob("*") if p.is_file())
        disk = self.folder / "filling"
        disk.mkdir()
        told = 0
        for level in range(levels):
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={4 * size + (64 << 20)}", "terrane",
                                      str(disk)], capture_output=True, check=False)
            if mounted.returncode != 0:
                self.skipped.append("disk that fills: may not mount a small disk here")
                return
            try:
                out = disk / "out"
                running = self.start(arguments, out)
                time.sleep(seconds * (level + 0.5) / levels)
                free = os.statvfs(disk)
                with open(disk / "others", "wb") as others:
                    try:
                        others.write(b"\0" * (free.f_bavail * free.f_frsize))
                    except OSError:
                        pass
                code, _, err = self.finish(running)
                require(code in (0, 4), f"disk that fills, level {level}: exit {code}: {err}")
                if code == 4:
                    told += 1
                    self.one_line(err, "disk that fills")
                (disk / "others").unlink(missing_ok=True)
                self.resumed(arguments, out, straight)
            finally:
                subprocess.run(["umount", "-l", str(disk)], check=True)
        print(f"{name}: disk filled by others in mid-run, told {told} of {levels} times", flush=True)

    def folder_taken(self, name, arguments):
        straight, seconds = self.straight(name, arguments)
        for how in ("removed", "replaced by a file", "read-only"):
            out = self.folder / f"{name}-taken"
            shutil.rmtree(out, ignore_errors=True)
            if out.exists():
                out.unlink()
            if how == "read-only":
                out.mkdir()
                if subprocess.run(["mount", "-t", "tmpfs", "terrane", str(out)], capture_output=True,
                                  check=False).returncode != 0:
                    self.skipped.append("read-only: may not mount a disk here")
                    continue
            running = self.start(arguments, out / "run")
            time.sleep(0.35 * seconds)
            if how == "read-only":
                subprocess.run(["mount", "-o", "remount,ro", str(out)], capture_output=True, check=False)
            else:
                os.rename(out, self.folder / f"{name}-away")
                if how == "replaced by a file":
                    out.write_text("in the way\n")
            code, _, err = self.finish(running)
            require(code in (0, 4), f"folder {how}: exit {code}: {err}")
            if code == 4:
                self.one_line(err, f"folder {how}")
            if how == "read-only":
                if subprocess.run(["mount", "-o", "remount,rw", str(out)], check=False).returncode == 0:
                    self.resumed(arguments, out / "run", straight)
                subprocess.run(["umount", "-l", str(out)], check=True)
            shutil.rmtree(self.folder / f"{name}-away", ignore_errors=True)
        print(f"{name}: folder removed, replaced and read-only", flush=True)

    def rights_lost(self, name, arguments):
        """The folder's rights go in mid-run: of a user who has none beyond them."""
        powers = "-dac_override,-dac_read_search"
        bound = ["setpriv", "--bounding-set", powers, "--inh-caps", powers] if os.geteuid() == 0 else []
        if bound and subprocess.run([*bound, "true"], capture_output=True, check=False).returncode != 0:
            self.skipped.append("rights lost: may not give up root's")
            return
        straight, _ = self.straight(name, arguments)
        for mode in (0o500, 0o000):
            for begun in ("config.toml", "02-isostasy.nc"):
                what = f"rights of the folder {mode:03o} once {begun} is there"
                out = self.folder / f"{name}-rights"
                shutil.rmtree(out, ignore_errors=True)
                running = subprocess.Popen([*bound, self.program, *arguments, "-o", str(out)], stdin=subprocess.DEVNULL,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.environment)
                while not (out / begun).exists() and running.poll() is None:
                    time.sleep(0.002)
                out.chmod(mode)
                code, _, err = self.finish(running)
                out.chmod(0o700)
                require(code == 4, f"{what}: exit {code}: {err}")
                self.one_line(err, what)
                self.resumed(arguments, out, straight)
        print(f"{name}: rights of the folder lost at 4 moments", flush=True)

    def streams(self):
        """Closed and broken standard streams."""
        out = self.folder / "streams"
        arguments = ["run", "--preset", "preview", "--grid", "32x16", "--to", "isostasy", "--no-maps", "--overwrite",
                     "-o", str(out)]
        for closing in (">&-", "2>&-", "<&-", ">&- 2>&-", "<&- >&- 2>&-"):
            code = subprocess.run(["bash", "-c", f'"$0" "$@" {closing}', self.program, *arguments], env=self.environment,
                                  capture_output=True, check=False).returncode
            require(code == 0, f"with {closing}: exit {code}")
        piped = subprocess.run(["bash", "-c", 'set -o pipefail; "$0" params | head -n 1; echo "${PIPESTATUS[0]}"',
                                self.program], capture_output=True, text=True, check=False)
        code = int(piped.stdout.split()[-1])
        require(code in (0, 4, 128 + signal.SIGPIPE), f"params | head: exit {code}")
        require("terminate" not in piped.stderr and "Abort" not in piped.stderr, piped.stderr)
        broken = subprocess.run(["bash", "-c", '"$0" "$@" 2> >(exec 0<&-; sleep 0.2)', self.program, *arguments],
                                env=self.environment, check=False).returncode
        require(broken in (0, 4), f"stderr that nobody reads: exit {broken}")
        print("closed and broken standard streams", flush=True)

    def locales(self):
        """Decimal commas: files and values stay as they are."""
        available = subprocess.run(["locale", "-a"], capture_output=True, text=True, check=False).stdout.split()
        comma = next((l for l in available if l.lower().startswith(("de_", "fr_", "es_", "it_", "nl_"))), None)
        environment = dict(self.environment)
        if comma is None:
            made = self.folder / "locales"
            made.mkdir()
            if shutil.which("localedef") is None or not Path("/usr/share/i18n/locales/de_DE").exists():
                self.skipped.append("decimal commas: no such locale here")
                return
            subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(made / "de_DE.UTF-8")], check=False,
                           capture_output=True)
            environment["LOCPATH"], comma = str(made), "de_DE.UTF-8"
        arguments = [*PLANET, "--no-maps"]
        straight, _ = self.straight("locale", arguments)
        out = self.folder / "locale-comma"
        environment["LC_ALL"] = comma
        self.environment, plain = environment, self.environment
        code, _, err = self.call(arguments, out)
        require(code == 0, f"decimal commas: exit {code}: {err}")
        for file in sorted(straight.glob("*.toml")):  # as written: a finished run that is resumed goes on without its --to
            require(filecmp.cmp(file, out / file.name, shallow=False), f"{file.name} differs under {comma}")
        self.resumed(arguments, out, straight)
        self.environment = plain
        print(f"locale {comma}", flush=True)


PARTS = ("streams", "locales", "signals", "folder-taken", "rights-lost", "full-disk", "filling-disk", "planet-kills",
         "drift-kills", "fit-kills")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program")
    options.add_argument("folder", type=Path)
    options.add_argument("--kills", type=int, default=6, help="of each kind of run")
    options.add_argument("--levels", type=int, default=3, help="at which a disk is full")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--only", action="append", default=[], choices=PARTS, help="all parts when none is named")
    chosen = options.parse_args()
    faults = Faults(chosen.program, chosen.folder, chosen.seed)
    parts = {
        "streams": faults.streams,
        "locales": faults.locales,
        "signals": lambda: faults.signals("planet", PLANET),
        "folder-taken": lambda: faults.folder_taken("planet-folder", PLANET),
        "rights-lost": lambda: faults.rights_lost("planet-rights", PLANET),
        "full-disk": lambda: faults.full_disk("planet-disk", PLANET, chosen.levels),
        "filling-disk": lambda: faults.disk_that_fills("planet-filling", PLANET, chosen.levels),
        "planet-kills": lambda: faults.kills("planet-kills", PLANET, chosen.kills),
        "drift-kills": lambda: faults.kills("drift-kills", DRIFT, chosen.kills),
        "fit-kills": lambda: faults.kills("fit-kills", FIT, chosen.kills, codes=(0, 5)),
    }
    try:
        for name in PARTS:
            if not chosen.only or name in chosen.only:
                parts[name]()
    except Failure as failure:
        print(f"FAILED (seed {chosen.seed}): {failure}", file=sys.stderr)
        return 1
    for skipped in faults.skipped:
        print(f"skipped: {skipped}")
    shutil.rmtree(chosen.folder, ignore_errors=True)
    return 0


sys.exit(main())
