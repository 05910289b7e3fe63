#!/usr/bin/python3
"""Holds configurations against the JSON Schema that terrane writes for editors: check_schema.py PROGRAM

Every preset, and the file that names every parameter with its default, must be valid; a wrong key, type or
range must not.
"""

import json
import subprocess
import sys
import tomllib

from jsonschema import Draft7Validator

program = sys.argv[1]
failures = []


def output(*words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


schema = json.loads(output("params", "--format", "schema"))
Draft7Validator.check_schema(schema)
validator = Draft7Validator(schema)


def expect(valid, name, configuration):
    errors = [f"{'.'.join(map(str, error.path))}: {error.message[:120]}" for error in
              validator.iter_errors(configuration)]
    if valid != (not errors):
        failures.append(name)
        print("FAIL", name, *(errors or ["is valid"]), sep="\n  ")


names = [line.split()[0] for line in output("presets").splitlines() if line and not line.startswith(" ")]
for name in names:
    expect(True, f"preset {name}", tomllib.loads(output("presets", "--show", name)))
expect(True, "every parameter", tomllib.loads(output("params", "--format", "toml")))
expect(True, "every event", tomllib.loads(output("params", "event", "--format", "toml")))
expect(True, "a list", {"calibration": {"free": ["planet.ocean_fraction"]}})
for name, wrong in {
    "a wrong section": {"planets": {}},
    "a wrong key": {"planet": {"radios_km": 3}},
    "a wrong key of a model": {"plates": {"sphere": {"sample": 3}}},
    "a wrong type": {"run": {"seed": "many"}},
    "a wrong range": {"planet": {"radius_km": -3}},
    "a wrong choice": {"plates": {"model": "spehre"}},
    "an event without a kind": {"event": [{"diameter_km": 3}]},
    "an event of another kind": {"event": [{"kind": "flood"}]},
    "a wrong key of an event": {"event": [{"kind": "impact", "depth_km": 3}]},
}.items():
    expect(False, name, wrong)
print(f"schema: {len(names)} presets, {len(failures)} failures")
sys.exit(1 if failures or len(names) < 5 else 0)
