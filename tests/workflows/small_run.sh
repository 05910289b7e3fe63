#!/usr/bin/env bash
# The workflow makes small planets to biomes, fits and summarises them: small_run.sh SOURCE PROGRAM WORK. Exits with 77,
# which ctest takes as skipped, where Snakemake is not installed.
set -euo pipefail
source=$1 program=$2 work=$3
command -v snakemake >/dev/null || { echo "snakemake is not installed"; exit 77; }
rm -rf "$work" && mkdir -p "$work"
export XDG_CACHE_HOME=$work/cache OMP_WAIT_POLICY=passive

cat >"$work/small.yaml" <<END
terrane: $program
sweep_seeds: [21]
sweep_grid: 64x32
threads: 1
calibration: {seeds: "1", held_out: "2", grid: 64x32, held_out_grid: 64x32, iterations: 1, profiles: false}
presets:
  earth: {calibration: {free: [isostasy.collision_km]}}
  many-plates: {calibration: {free: [isostasy.collision_km]}}
END
snakemake -j2 -s "$source/workflows/Snakefile" --directory "$work" --configfile "$work/small.yaml" \
  >"$work/log.txt" 2>&1 || { cat "$work/log.txt"; exit 1; }

for preset in earth many-plates; do
  for when in before after; do
    test -s "$work/results/$preset/$when/part-1/seed-21/06-biomes.nc"
    # Every line of a log is an object, and one says that the planet was made.
    python3 - "$work/results/$preset/logs/$when-1.jsonl" <<'END'
import json, sys
told = [json.loads(line) for line in open(sys.argv[1])]
assert any(line.get("event") == "run-ends" and line["run"] == "seed-21" and line["exit"] == 0 for line in told), told
END
  done
done
[ "$(wc -l <"$work/results/summary.csv")" -eq 3 ]
test -s "$work/results/summary.png"
# A second call has nothing to do. It is heard to its end: grep alone would leave and break its pipe.
told=$(snakemake -j2 -s "$source/workflows/Snakefile" --directory "$work" --configfile "$work/small.yaml" 2>&1)
grep -q "Nothing to be done" <<<"$told"
