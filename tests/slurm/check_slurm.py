#!/usr/bin/env python3
"""Planets, sweeps and fits as jobs of Slurm's that are drained, killed, cancelled and out of time.

check_slurm.py PROGRAM FOLDER [--only WORD ...] [--measure]

FOLDER/cluster is a cluster that tests/slurm/cluster has started; its environment must be set. After whatever happens to
a job, the planet must have the values and the files of one that nothing happened to. With --measure, the same planets
are made by Snakemake with a job each, and with eight in a job, and the times are printed.
"""
import argparse
import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "workflows" / "slurm"
# Erosion takes most of its time; plates and isostasy are what a second life finds.
PLANET = ["--preset", "preview", "--grid", "64x32", "--to", "erosion", "--no-maps", "--no-vtk"]
SWEEP = ["--preset", "earth", "--grid", "64x32", "--to", "isostasy"]
ENDED = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY")
SMALL = ["--cpus-per-task=2", "--mem=500M"]


class Failure(Exception):
    pass


def require(holds, what):
    if not holds:
        raise Failure(what)


def call(*words, timeout=600, **how):
    done = subprocess.run([str(word) for word in words], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=timeout, **how)
    require(done.returncode == 0, f"{' '.join(map(str, words))}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout.strip()


def wait_until(what, holds, seconds=600):
    last = time.monotonic() + seconds
    while time.monotonic() < last:
        found = holds()
        if found:
            return found
        time.sleep(0.3)
    raise Failure(f"waited {seconds} s in vain: {what}")


class Job:
    """A job of Slurm's, as slurmctld sees it."""

    def __init__(self, number, log):
        self.number, self.log = number, log

    def facts(self):
        line = call("scontrol", "show", "job", "-o", self.number)
        return dict(word.split("=", 1) for word in line.split() if "=" in word)

    def state(self):
        return self.facts()["JobState"]

    def restarts(self):
        return int(self.facts()["Restarts"])

    def wait_for_second_life(self):
        def holds():
            facts = self.facts()
            require(facts["JobState"] not in ENDED, f"job {self.number} is {facts['JobState']}: {self.tail()}")
            return int(facts["Restarts"]) >= 1
        wait_until(f"a second life of job {self.number}", holds)

    def wait_for(self, *states, seconds=900):
        def holds():
            state = self.state()
            require(state in states or state not in ENDED,
                    f"job {self.number}: {state}, not {' or '.join(states)}: {self.tail()}")
            return state in states
        wait_until(f"job {self.number} to be {' or '.join(states)}", holds, seconds)

    def tail(self):
        return self.log.read_text(errors="replace")[-400:] if self.log.exists() else "no log"

    def processes(self):
        """Everything that works for the job, and the slurmstepd that watch it: (number, command line)."""
        mine = f"SLURM_JOB_ID={self.number}".encode()
        found = []
        for entry in Path("/proc").iterdir():
            try:
                if not entry.name.isdigit():
                    continue
                words = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
                if mine in (entry / "environ").read_bytes().split(b"\0") or f"[{self.number}." in words:
                    found.append((int(entry.name), words))
            except OSError:  # it is gone
                continue
        return found

    def planet(self, program, rank=None):
        """The process of terrane run, or that of one of its ranks."""
        def is_rank(number):
            return rank is None or f"SLURM_PROCID={rank}".encode() in Path(f"/proc/{number}/environ").read_bytes().split(b"\0")
        return next((number for number, words in self.processes()
                     if words.startswith(f"{program} run ") and is_rank(number)), None)


class Cluster:
    def __init__(self, folder):
        self.folder = folder

    def pid_file(self, node):
        return self.folder / "run" / f"slurmd-{node}.pid"

    def kill_slurmd(self, node):
        os.kill(int(self.pid_file(node).read_text()), signal.SIGKILL)

    def lose(self, node, job):
        """As if the power of the node had failed."""
        self.kill_slurmd(node)
        for number, _ in job.processes():
            try:
                os.kill(number, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def start_slurmd(self, node):
        subprocess.run(["slurmd", "-N", node], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, check=True)

    def state(self, node):
        return call("sinfo", "-h", "-n", node, "-o", "%T")

    def works(self, node):
        try:
            return "slurmd" in Path(f"/proc/{int(self.pid_file(node).read_text())}/cmdline").read_text()
        except (OSError, ValueError):
            return False

    def all_idle(self):
        """As before each check, whatever the last one has left."""
        for node in ("one", "two"):
            if not self.works(node):
                self.start_slurmd(node)
        wait_until("nodes that answer", lambda: not any("*" in self.state(node) for node in ("one", "two")), 120)
        for node in ("one", "two"):
            state = self.state(node)
            if state.startswith(("drain", "down")):
                call("scontrol", "update", f"NodeName={node}", "State=RESUME")
        wait_until("idle nodes", lambda: all(self.state(node) == "idle" for node in ("one", "two")), 120)


class Checks:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.cluster = Cluster(folder / "cluster")
        self.work = folder / "work"
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(parents=True)
        self.environment = {**os.environ, "TERRANE": str(program), "TERRANE_PATIENCE": "5", "USER": "root",
                            "OMP_WAIT_POLICY": "passive", "XDG_CACHE_HOME": str(self.work / "cache")}
        self._straight = None

    def straight(self):
        """The planet to which nothing happens."""
        if self._straight is None:
            self._straight = self.work / "straight"
            call(self.program, "run", *PLANET, "--threads", "1", "--quiet", "-o", self._straight)
        return self._straight

    def submit(self, folder, *options, script="planet.sbatch", arguments=()):
        log = self.work / f"{folder.name}.log"
        number = call("sbatch", "--parsable", "-D", self.work, "-o", log, *SMALL, *options, SCRIPTS / script, folder,
                      *(arguments or PLANET), env=self.environment)
        return Job(number, log)

    def under_way(self, job, folder):
        """Waits until the planet is in the middle of a stage; when the files of earlier ones were written."""
        def has_relief():
            state = job.state()
            require(state not in ENDED, f"job {job.number}: {state} before it was under way: {job.tail()}")
            try:
                stages = json.loads((folder / "manifest.json").read_text())["stages"]
            except OSError:
                return False
            return any(stage["name"] == "isostasy" for stage in stages)
        wait_until(f"isostasy in {folder}: {job.tail()}", has_relief)
        require(not (folder / "03-erosion.nc").exists(), "the planet was done before anything could happen to it")
        return {path: path.stat().st_mtime_ns for path in (folder / "01-plates.nc", folder / "02-isostasy.nc")}

    def must_be_the_same(self, folder, kept=None):
        straight = self.straight()
        call(self.program, "diff", straight, folder)
        call(self.program, "info", "--verify", folder)
        names = [sorted(str(path.relative_to(each)) for path in each.rglob("*")) for each in (straight, folder)]
        require(names[0] == names[1], f"{folder} has other files: {set(names[0]) ^ set(names[1])}")
        for path, written in (kept or {}).items():
            require(path.stat().st_mtime_ns == written, f"{path} was made again: the planet began anew")

    def must_have_been_asked_to_end(self, job):
        """By SIGTERM, which Slurm may send twice: to the second the planet ends at once."""
        wait_until("its processes to end", lambda: not job.processes(), 60)
        told = job.log.read_text()
        require("interrupted" in told or "task 0: Terminated" in told, f"the planet was not asked to end: {told}")

    # What happens to jobs ---------------------------------------------------------------------------

    def check_step(self):
        """A planet is a step of a job, with the threads of its allocation."""
        out = self.work / "step"
        call("srun", "-n1", "-c3", "--mem=500M", "sh", "-c",
             f'exec "{self.program}" run "$@" --threads "$SLURM_CPUS_PER_TASK" --quiet -o "{out}"', "sh", *PLANET,
             env=self.environment)
        self.must_be_the_same(out)
        threads = json.loads((out / "manifest.json").read_text())["threads"]
        require(threads == 3, f"the step had 3 processors, the planet {threads} threads")

    def check_ranks(self):
        """A planet of three ranks on two nodes loses one of them: the job ends at once and says so; two go on."""
        out = self.work / "ranks"
        job = self.submit(out, "--nodes=2", "--ntasks=3")
        kept = self.under_way(job, out)
        wait_until("the second rank", lambda: job.planet(self.program, rank=1))
        begun = time.monotonic()
        os.kill(job.planet(self.program, rank=1), signal.SIGKILL)
        job.wait_for(*ENDED)
        require(time.monotonic() - begun < 30, "the job did not end with its rank")
        told = [line for line in job.log.read_text().splitlines() if "terrane: error:" in line]
        require(len(told) == 1 and "another of its ranks died" in told[0], f"said of it: {told}")
        self.submit(out, "--nodes=1", "--ntasks=2").wait_for("COMPLETED")
        self.must_be_the_same(out, kept)

    def check_drained(self):
        """A node is drained: its job goes on, and requeued it goes on elsewhere."""
        out = self.work / "drained"
        job = self.submit(out)
        kept = self.under_way(job, out)
        node = job.facts()["NodeList"]
        call("scontrol", "update", f"NodeName={node}", "State=DRAIN", "Reason=check")
        require(job.state() == "RUNNING", f"a drained node's job is {job.state()}")
        call("scontrol", "requeue", job.number)
        job.wait_for("COMPLETED")
        facts = job.facts()
        require(facts["NodeList"] != node and facts["Restarts"] == "1", f"requeued on {facts['NodeList']}")
        self.must_be_the_same(out, kept)

    def check_lost(self):
        """A node is lost with all that runs there: Slurm queues the job again."""
        out = self.work / "lost"
        job = self.submit(out)
        kept = self.under_way(job, out)
        node = job.facts()["NodeList"]
        self.cluster.lose(node, job)
        job.wait_for_second_life()
        job.wait_for("COMPLETED")
        require(job.facts()["NodeList"] != node, "the lost node made the planet")
        self.must_be_the_same(out, kept)
        self.cluster.start_slurmd(node)

    def check_cut_off(self):
        """A node is cut off and its planet still at work when the job begins again elsewhere: one of them at a time."""
        out = self.work / "cut-off"
        job = self.submit(out)
        kept = self.under_way(job, out)
        node, planet = job.facts()["NodeList"], job.planet(self.program)
        os.kill(planet, signal.SIGSTOP)
        self.cluster.kill_slurmd(node)
        wait_until("the second life to find the folder taken",
                   lambda: "another run is at work in this folder" in job.log.read_text(errors="replace"))
        require(Path(f"/proc/{planet}").exists(), "the first life is over")
        self.cluster.start_slurmd(node)  # which ends what is left of the job there
        os.kill(planet, signal.SIGCONT)
        job.wait_for("COMPLETED")
        require(job.restarts() >= 2, "the second life did not wait")
        self.must_be_the_same(out, kept)

    def check_cancelled(self):
        """A job is cancelled; submitted again, it goes on."""
        out = self.work / "cancelled"
        job = self.submit(out)
        kept = self.under_way(job, out)
        call("scancel", job.number)
        job.wait_for("CANCELLED")
        self.must_have_been_asked_to_end(job)
        require(job.state() == "CANCELLED", "the job came back")
        self.submit(out).wait_for("COMPLETED")
        self.must_be_the_same(out, kept)

    def check_out_of_time(self):
        """A job reaches its limit unwarned: SIGTERM, later SIGKILL. Submitted again, it goes on."""
        out = self.work / "out-of-time"
        unwarned = self.work / "unwarned.sbatch"
        unwarned.write_text("".join(line for line in open(SCRIPTS / "planet.sbatch") if "--signal" not in line))
        job = self.submit(out, "--time=1", script=unwarned)
        kept = self.under_way(job, out)
        os.kill(job.planet(self.program), signal.SIGSTOP)  # Slurm wakes it to end it; it must not finish before
        job.wait_for("TIMEOUT", seconds=240)
        self.must_have_been_asked_to_end(job)
        self.submit(out).wait_for("COMPLETED")
        self.must_be_the_same(out, kept)

    def check_warned(self):
        """A job is warned before its limit, ends in order and queues again by itself."""
        out = self.work / "warned"
        job = self.submit(out, "--time=2", "--signal=TERM@60")
        kept = self.under_way(job, out)
        os.kill(job.planet(self.program), signal.SIGSTOP)  # Slurm wakes it with the warning
        job.wait_for_second_life()
        require("interrupted" in job.log.read_text(), f"the planet was not asked to end: {job.tail()}")
        job.wait_for("COMPLETED")
        self.must_be_the_same(out, kept)

    # Many planets -----------------------------------------------------------------------------------

    def check_array(self):
        """An array of sweeps makes the planets of one sweep; what is done is not done again."""
        out, straight = self.work / "array", self.work / "sweep"
        call(self.program, "sweep", *SWEEP, "--seeds", "1..4", "--quiet", "-o", straight, env=self.environment)
        for life in (1, 2):
            self.environment["SBATCH_WAIT"] = "1"
            job = self.submit(out, "--array=1-2", script="sweep.sbatch", arguments=["2", *SWEEP])
            del self.environment["SBATCH_WAIT"]
            wait_until(f"both jobs of the array to be done: {job.tail()}", lambda: call(
                "sacct", "-n", "-X", "-j", job.number, "-o", "State").split() == ["COMPLETED"] * 2, 60)
            if life == 1:
                written = {path: path.stat().st_mtime_ns for path in out.glob("part-*/seed-*/*.nc")}
        require(len(written) == 8, f"{len(written)} files of four planets")
        require(all(path.stat().st_mtime_ns == at for path, at in written.items()), "planets were made again")
        for seed, part in ((1, 1), (2, 1), (3, 2), (4, 2)):
            call(self.program, "diff", straight / f"seed-{seed}", out / f"part-{part}" / f"seed-{seed}")
        rows = [row for part in (1, 2) for row in csv.DictReader(open(out / f"part-{part}" / "sweep.csv"))]
        require([row["run"] for row in rows] == [f"seed-{seed}" for seed in (1, 2, 3, 4)], "rows of sweep.csv")

    def snakemake(self, name, *targets, settings):
        """The workflow by its profile; the seconds that it took and the jobs of Slurm's."""
        out = self.work / name
        out.mkdir()
        (out / "small.json").write_text(json.dumps({
            "terrane": str(self.program), "sweep_grid": "64x32", "to": "isostasy", "threads": 2,
            "calibration": {"seeds": "1", "held_out": "2", "grid": "64x32", "held_out_grid": "64x32", "iterations": 1,
                            "profiles": False, "free": ["isostasy.collision_km"]},
            "presets": {"earth": {"calibration": {"free": ["isostasy.collision_km"]}},
                        "many-plates": {"calibration": {"free": ["isostasy.collision_km"]}}}, **settings}))
        command = ["snakemake", *targets, "--profile", str(ROOT / "workflows/profiles/slurm"), "-s",
                   str(ROOT / "workflows/Snakefile"), "--directory", str(out), "--configfile", str(out / "small.json"),
                   "--default-resources", "mem_mb=1000", "runtime=20", "slurm_account=planets",
                   "slurm_partition=planets", "slurm_extra=--no-requeue"]
        begun = time.monotonic()
        since = time.strftime("%Y-%m-%dT%H:%M:%S")
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, env=self.environment, timeout=3000)
        require(done.returncode == 0, f"snakemake: exit {done.returncode}: {done.stdout[-1500:]}")
        seconds = time.monotonic() - begun
        table = call("sacct", "-n", "-X", "-P", "-S", since, "-o", "JobID,JobName,State,ElapsedRaw")
        jobs = [line.split("|") for line in table.splitlines() if "|snakejob_" in line]
        return done.stdout, seconds, jobs, command

    def check_workflow(self):
        """The workflow ends on Slurm by its profile, several planets a job; a second call has nothing to do."""
        told, seconds, jobs, command = self.snakemake(
            "workflow", settings={"sweep_seeds": [21, 22, 23, 24], "planets_per_job": 2})
        out = self.work / "workflow" / "results"
        require(len(list(csv.reader(open(out / "summary.csv")))) == 9, "rows of summary.csv")
        for rule, count in (("before", 4), ("after", 4), ("calibrate", 2)):
            mine = [job for job in jobs if job[1].startswith(f"snakejob_{rule}_")]
            require([job[2] for job in mine] == ["COMPLETED"] * count, f"{rule}: {mine}")
        require(len(jobs) == 10, f"{len(jobs)} jobs of Slurm's")
        call(self.program, "run", *SWEEP, "--seed", "23", "--no-vtk", "--no-maps", "--quiet", "-o", self.work / "seed-23")
        call(self.program, "diff", self.work / "seed-23", out / "earth/before/part-2/seed-23")
        require("Nothing to be done" in subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                                       env=self.environment).stderr, "a second call does it again")
        print(f"   {len(jobs)} jobs, 16 planets and 2 fits: {seconds:.0f} s", flush=True)

    def check_workflow_lost(self):
        """A node is lost with a job of the workflow: Snakemake submits another, and the workflow ends."""
        lost = []

        def lose():
            number, node = wait_until("a job of the workflow", lambda: call("squeue", "-h", "-t", "R", "-o", "%i %N").split())
            job = Job(number, self.work / "none.log")
            wait_until("its planets", lambda: any(f"{self.program} sweep" in words for _, words in job.processes()))
            self.cluster.lose(node, job)
            lost.append(job)
        losing = threading.Thread(target=lose)
        losing.start()
        _, _, jobs, _ = self.snakemake("workflow-lost", "results/earth/before/part-1",
                                       settings={"sweep_seeds": [21, 22, 23], "planets_per_job": 3})
        losing.join()
        require(lost and [job[2] for job in jobs] == ["NODE_FAIL", "COMPLETED"], f"jobs of Slurm's: {jobs}")
        call(self.program, "run", *SWEEP, "--seed", "22", "--no-vtk", "--no-maps", "--quiet", "-o", self.work / "seed-22")
        call(self.program, "diff", self.work / "seed-22", self.work / "workflow-lost/results/earth/before/part-1/seed-22")

    def measure(self):
        """The same planets with a job each and with eight in a job."""
        begun = time.monotonic()
        call(self.program, "sweep", *SWEEP, "--seeds", "21..28", "--quiet", "-o", self.work / "here", env=self.environment)
        print(f"   here, one at a time: 8 planets in {time.monotonic() - begun:.0f} s")
        for each, parts in ((1, 8), (8, 1)):
            _, seconds, jobs, _ = self.snakemake(
                f"measure-{each}", *(f"results/earth/before/part-{1 + part}" for part in range(parts)),
                settings={"sweep_seeds": list(range(21, 29)), "planets_per_job": each})
            at_work = sum(int(job[3]) for job in jobs)
            print(f"   {len(jobs)} jobs of {each}: {seconds:.0f} s, jobs at work for {at_work} s together", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--measure", action="store_true")
    options = parser.parse_args()
    checks = Checks(options.program.resolve(), options.folder.resolve())
    names = [name for name in vars(Checks) if name.startswith("check_")]
    wanted = [f"check_{word.replace('-', '_')}" for word in options.only]
    unknown = set(wanted) - set(names)
    if unknown:
        parser.error(f"no {', '.join(sorted(unknown))} among {', '.join(names)}")
    failed = 0
    for name in wanted or names:
        begun = time.monotonic()
        try:
            checks.cluster.all_idle()
            getattr(checks, name)()
            print(f"passed {name.removeprefix('check_').replace('_', '-')}, {time.monotonic() - begun:.0f} s", flush=True)
        except (Failure, OSError, LookupError, subprocess.SubprocessError) as failure:
            failed += 1
            print(f"FAILED {name.removeprefix('check_').replace('_', '-')}: {failure!r}", flush=True)
            subprocess.run(["scancel", "--user=root"], check=False)
    if options.measure and not failed:
        checks.measure()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
