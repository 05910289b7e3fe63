#!/usr/bin/env bash
# The workflow plans every planet and every fit: dry_run.sh SOURCE WORK. Exits with 77, which ctest
# takes as skipped, where Snakemake is not installed.
set -euo pipefail
source=$1 work=$2
command -v snakemake >/dev/null || { echo "snakemake is not installed"; exit 77; }
rm -rf "$work" && mkdir -p "$work"
export XDG_CACHE_HOME=$work/cache

plan() {
  snakemake -n -s "$source/workflows/Snakefile" --directory "$work" "$@" >"$work/plan.txt" 2>&1 ||
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
  expect before 8
  expect after 8
  expect calibrate 2
  expect summary 1
done
plan -j2 --config 'sweep_seeds=[3, 4, 5]'
expect before 6
! (plan -j2 --config to=islands) >"$work/refused.txt"
grep -q "must be one of isostasy" "$work/refused.txt"
