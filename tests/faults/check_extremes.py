#!/usr/bin/env python3
"""Every parameter at both ends of its range, one at a time, through all stages of small planets:
check_extremes.py PROGRAM FOLDER [--every N] [--preset NAME] [--only WORD] [--jobs N]

A run must end with 0, or with 2 and one line that says why this value does not go with the others; without a number
that is not finite, with every budget closed, and in a time that suits a few hundred cells. --every N takes each Nth
case, for a quick look; releases are checked with all.
"""
import argparse
import concurrent.futures
import json
import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

SIZE = ["--grid", "24x12", "--no-maps", "--no-vtk", "--quiet", "--overwrite", "--threads", "1"]
SMALL = {"island.nx": 32, "island.ny": 32, "plates.sphere.samples": 2000, "plates.raster.map_columns": 64,
         "plates.raster.map_rows": 32, "climate.resolution_deg": 10}
# What says how long, how large or where, but not what the planet is like.
APART = {"run.grid", "run.threads", "plates.sphere.samples", "plates.raster.map_columns", "plates.raster.map_rows",
         "island.nx", "island.ny", "calibration."}
PRESETS = ["preview", "tectonica", "sphere", "raster", "hypsography"]
SECONDS = 120
# Air of half a degree has a thousand times the cells of these planets.
DEAR_SECONDS = {"climate.resolution_deg": 900}
CLOSED = 1e-9
# Fields of rain hold single precision.
CLOSED_RAIN = 1e-6


def parameters(program):
    return json.loads(subprocess.run([program, "params", "--format", "json"], capture_output=True, check=True).stdout)


def at_its_ends(parameter):
    if "choices" in parameter:
        return [choice for choice in parameter["choices"] if choice != parameter["default"]]
    if parameter["type"] == "boolean":
        return [not parameter["default"]]
    if parameter["type"] in ("integer", "real") and "min" in parameter:
        ends = [parameter["min"], parameter["max"]]
        return [int(end) if parameter["type"] == "integer" else end for end in ends]
    return []


def written(value):
    return json.dumps(value) if not isinstance(value, str) else value


def cases(program, presets):
    for preset in presets:
        for parameter in parameters(program):
            name = parameter["name"]
            if any(name == apart or apart.endswith(".") and name.startswith(apart) for apart in APART):
                continue
            for value in at_its_ends(parameter):
                yield preset, name, value


def faults_of(folder):
    manifest = json.loads((folder / "manifest.json").read_text())
    for stage in manifest["stages"]:
        for name, field in stage["fields"].items():
            for what in ("min", "mean", "max"):
                value = field[what]
                if value is None or not math.isfinite(value):
                    yield f"{stage['name']}: {name} has {what} {value}"
        for name, value in stage.get("budget", {}).items():
            if value is None or not math.isfinite(value):
                yield f"{stage['name']}: budget {name} is {value}"
            elif name.endswith("_error") and abs(value) > (CLOSED_RAIN if name.startswith("air_water") else CLOSED):
                yield f"{stage['name']}: budget {name} is {value:.3g}"


def run(program, folder, preset, name, value):
    arguments = [program, "run", "--preset", preset, *SIZE, "-o", str(folder)]
    for key, small in SMALL.items():
        if key != name:
            arguments += ["--set", f"{key}={small}"]
    arguments += ["--set", f"{name}={written(value)}"]
    shutil.rmtree(folder, ignore_errors=True)
    most = DEAR_SECONDS.get(name, SECONDS)
    begun = time.monotonic()
    try:
        ended = subprocess.run(arguments, capture_output=True, text=True, timeout=most, check=False,
                               stdin=subprocess.DEVNULL, env={**os.environ, "OMP_WAIT_POLICY": "passive"})
    except subprocess.TimeoutExpired:
        return [f"took more than {most} s"], most
    seconds = time.monotonic() - begun
    errors = [line for line in ended.stderr.splitlines() if "error:" in line]
    if ended.returncode == 2 and len(errors) == 1 and not (folder / "manifest.json").exists():
        return [], seconds
    if ended.returncode != 0:
        return [f"exit {ended.returncode}: {ended.stderr.strip()[-300:]}"], seconds
    faults = list(faults_of(folder))
    shutil.rmtree(folder, ignore_errors=True)
    return faults, seconds


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program")
    options.add_argument("folder", type=Path)
    options.add_argument("--every", type=int, default=1)
    options.add_argument("--preset", action="append")
    options.add_argument("--only", default="", help="parameters whose name holds this")
    options.add_argument("--jobs", type=int, default=os.cpu_count())
    chosen = options.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    wanted = [case for case in cases(chosen.program, chosen.preset or PRESETS) if chosen.only in case[1]]
    wanted = wanted[:: chosen.every]
    faulty, longest = 0, (0.0, "")
    with concurrent.futures.ThreadPoolExecutor(chosen.jobs) as pool:
        runs = {pool.submit(run, chosen.program, chosen.folder / str(number), *case): case
                for number, case in enumerate(wanted)}
        for done in concurrent.futures.as_completed(runs):
            preset, name, value = runs[done]
            faults, seconds = done.result()
            longest = max(longest, (seconds, f"{preset}, {name} = {written(value)}"))
            for fault in faults:
                print(f"{preset}, {name} = {written(value)}: {fault}", flush=True)
            faulty += bool(faults)
    print(f"{len(wanted)} runs, {faulty} with faults; the longest took {longest[0]:.1f} s ({longest[1]})")
    return 1 if faulty or not wanted else 0


sys.exit(main())
