#!/usr/bin/env bash
# The workflow plans every planet and every fit: dry_run.sh SOURCE WORK. Exits with 77, which ctest
# takes as skipped, where Snakemake is not installed.
set -euo pipefail
source=$1 work=$2
command -v snakemake >/dev/null || { echo "snakemake is not installed"; exit 77; }
rm -rf "$work" && mkdir -p "$work"
export XDG_CACHE_HOME=$work/cache

plan() {
  snakemake -n -p -s "$source/workflows/Snakefile" --directory "$work" "$@" >"$work/plan.txt" 2>&1 ||
    { cat "$work/plan.txt"; exit 1; }
}
# Lines "after 8 1 1" of the table of jobs.
expect() {
  grep -Eq "^$1 +$2 " "$work/plan.txt" || { cat "$work/plan.txt"; echo "no $2 jobs $1"; exit 1; }
}

for how in "-j2" "--profile $source/workflows/profiles/local" \
           "--profile $source/workflows/profiles/slurm"; do
  # shellcheck disable=SC2086
  plan $how
  expect before 2
  expect after 2
  expect calibrate 2
  expect summary 1
done
# Seeds of a sweep are shared out among jobs, the last of which may have fewer.
plan -j2 --config 'sweep_seeds=[3, 4, 5, 16, 17]' planets_per_job=2
expect before 6
grep -Eq -- "--seeds 3,4 .*before/part-1" "$work/plan.txt"
grep -Eq -- "--seeds 17 .*after/part-3" "$work/plan.txt"
# What a job asks for is what its planets need: in a plan, which knows one processor, time for one after the other.
plan -j1 --config 'sweep_seeds=[3, 4, 5, 16, 17]'
grep -Eq "mem_mb=1000, .*runtime=100" "$work/plan.txt"
! (plan -j2 --config to=islands) >"$work/refused.txt"
grep -q "must be one of isostasy" "$work/refused.txt"
