#!/usr/bin/python3
"""Runs the commands of pages as a reader would, in a scratch folder, and holds what they print against what the pages say.

  run_page.py PAGE.md PROGRAM SCRATCH            one page at the small size of its test
  run_page.py --full PAGE.md PROGRAM SCRATCH     at the page's own sizes, hours for some
  run_page.py --all PROGRAM SCRATCH              every page that this machine has the programs for
  run_page.py --update ...                       writes what is printed in place of what was expected
  run_page.py --pages                            the pages, those left out whose programs are missing

Blocks fenced as sh, python, and those named as files are done in their order; the first that fails ends
the page with its output. Comments above a block, which no reader sees, say how:

  <!-- test: file NAME -->             the block is the content of file NAME
  <!-- test: output -->                the block is what the block before it prints
  <!-- test: exit 0 or 5 -->           exit codes that are as they should be
  <!-- test: skip, REASON -->          the block is not run
  <!-- test: replace `A` by `B` -->    in every block from here on; the test's planets are small

In expected output three dots stand for any words of a line, a line of three dots for any lines; all else
must be there as it stands, numbers too, spaces aside. Only times, dates, versions and commits may differ;
the path of the folder is left out.
At the page's own sizes the page says what is expected. At the sizes of the test its numbers are others:
expected/PAGE.txt has the page's blocks with those. --update mends numbers alone: words that differ are
for an author.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXPECTED = Path(__file__).resolve().parent / "expected"
# Pages and what they need beside the program.
PAGES = {
    "README.md": (),
    "docs/tutorials/first-planet.md": (),
    "docs/tutorials/calibration.md": (),
    "docs/tutorials/library.md": (),
    "docs/tutorials/earth.md": ("cdo", "gdal_translate", "xarray", "netCDF4", "matplotlib"),
    "docs/tutorials/island.md": ("cdo", "gdal_translate", "xarray", "netCDF4", "matplotlib"),
    "docs/tutorials/analysis.md": ("cdo", "gdal_translate", "xarray", "netCDF4", "matplotlib"),
    "docs/tutorials/paraview.md": ("pvbatch",),
}
# What commands of pages name by a path from the folder of the sources.
NAMED = ("scripts", "paraview", "workflows", "docs", "tests", "data")
NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
FENCE = re.compile(r"^(?P<marks>```+)(?P<language>\w*)\s*$")
NOTE = re.compile(r"<!-- test: (.*?) -->", re.S)


@dataclass
class Block:
    line: int
    language: str
    text: str
    notes: list = field(default_factory=list)

    def note(self, word):
        """What follows the word in the note that begins with it; None without such a note."""
        return next((note[len(word):].strip(" ,") for note in self.notes if re.match(rf"{word}\b", note)), None)


def blocks_of(text, full):
    """All fenced blocks with the notes above them; replacements are done unless `full`."""
    lines = iter(enumerate(text.splitlines(), 1))
    replacements, notes, blocks = [], [], []
    for number, line in lines:
        if found := NOTE.fullmatch(line.strip()):
            if pair := re.fullmatch(r"replace `(.*)` by `(.*)`", found[1]):
                replacements += [] if full else [pair.groups()]
            else:
                notes.append(found[1])
        elif fence := FENCE.match(line):
            body = []
            for _, line in lines:
                if line.startswith(fence["marks"]):
                    break
                body.append(line)
            block = "\n".join(body) + "\n"
            for old, new in replacements:
                block = block.replace(old, new)
            blocks.append(Block(number, fence["language"], block, notes))
            notes = []
        elif line.strip() and notes:
            sys.exit(f"line {number}: {notes[0]!r} stands above no block")
    return blocks


# What differs from run to run and from build to build, and is not for a page to promise.
VOLATILE = [
    re.compile(r"\d{4}-\d{2}-\d{2}(?:[T ]\d{2}:\d{2}(?::\d{2})?Z?)?"),  # dates
    re.compile(r"\bv?\d+\.\d+\.\d+\b"),  # versions
    re.compile(r"\b(?=[0-9]*[a-f])(?=[a-f]*[0-9])[0-9a-f]{7,40}\b"),  # commits
    re.compile(r"(?<![\w.])\d+(?:\.\d+)?\s?(?:ms|s|min|h|seconds|minutes|hours)(?![\w/^-]|\s-?\d)"),  # times
]


def settled(text):
    """The text with a mark in place of what is not for a page to promise."""
    for pattern in VOLATILE:
        text = pattern.sub("<varies>", text)
    return text


def word_pattern(word):
    """Of a word of a page, with a group for every number; three dots are any words."""
    return ".*" if word == "..." else f"({NUMBER.pattern})".join(map(re.escape, NUMBER.split(word)))


@dataclass
class Line:
    """A line of expected output, or a gap of any lines."""

    text: str

    @property
    def is_gap(self):
        return self.text.strip() == "..."

    def match(self, printed):
        """The numbers that the printed line has where this one has some; None if its words are others."""
        words = [word_pattern(word) for word in self.text.split()]
        found = re.fullmatch(r"[ \t]*" + r"[ \t]+".join(words) + r"[ \t]*", printed)
        return None if found is None else list(found.groups())

    def numbers(self):
        return [number for word in self.text.split() if word != "..." for number in NUMBER.findall(word)]

    def with_numbers(self, numbers):
        """The line with other numbers; what stands in columns keeps its right edge."""
        parts, end = [], 0
        found = [at for word in re.finditer(r"\S+", self.text) if word[0] != "..."
                 for at in NUMBER.finditer(self.text, word.start(), word.end())]
        for at, number in zip(found, numbers):
            before = self.text[end : at.start()]
            wider = len(number) - len(at[0])
            if before.endswith("  "):
                room = len(before) - len(before.rstrip(" ")) - 2
                before = before[: len(before) - min(wider, room)] if wider > 0 else before + " " * -wider
            parts += [before, number]
            end = at.end()
        return "".join(parts) + self.text[end:]


def fill(expected, printed):
    """The expected block with the numbers that are printed, or None where no lines have its words.

    Of the places where its words stand the one that has most of its numbers, so that what labels a line
    finds it.
    """
    lines, out = [Line(text) for text in expected.splitlines()], printed.splitlines()
    best = {-1: (0, [])}  # the last printed line that is taken: how many numbers agree, and the lines
    anywhere = True
    for line in lines:
        if line.is_gap:
            best = {at: (score, filled + [line.text]) for at, (score, filled) in best.items()}
            anywhere = True
            continue
        matches = [line.match(text) for text in out]
        reached = {}
        for before, (score, filled) in best.items():
            for at in range(before + 1, len(out)) if anywhere else [before + 1]:
                if at >= len(out) or matches[at] is None:
                    continue
                own = sum(a == b for a, b in zip(line.numbers(), matches[at]))
                if at not in reached or score + own > reached[at][0]:
                    reached[at] = (score + own, filled + [line.with_numbers(matches[at])])
        best, anywhere = reached, False
    if not best:
        return None
    return "\n".join(max(best.values(), key=lambda found: found[0])[1]) + "\n"


# What one block of a page sets, the next ones see, as in a reader's shell.
SHELL = """set -a
[ ! -f "$HOME/.environment" ] || . "$HOME/.environment"
trap 'export -p >"$HOME/.environment"' EXIT
"""


def command_of(block):
    if block.language == "python":
        return ["/usr/bin/python3", "-c", block.text]
    return ["bash", "-euo", "pipefail", "-c", SHELL + block.text]


def environment(scratch):
    path = f"{scratch}/build/release/apps:/usr/bin:/bin"
    return os.environ | {"PATH": path, "HOME": str(scratch), "MPLBACKEND": "Agg", "PYTHONDONTWRITEBYTECODE": "1"}


def prepare(scratch, program):
    """A folder that looks like that of the sources, after the build that made the program."""
    shutil.rmtree(scratch, ignore_errors=True)
    (scratch / "build").mkdir(parents=True)
    (scratch / "build/release").symlink_to(program.parents[1])
    for name in NAMED:
        (scratch / name).symlink_to(ROOT / name)


class Failure(Exception):
    """What is wrong with a page, and where."""


class Expectations:
    """What the outputs of a page should be: its own blocks at its own sizes, a file of them at the test's."""

    def __init__(self, page, full, update):
        self.page, self.full, self.update = page, full, update
        self.file = EXPECTED / (page.stem + ".txt")
        self.made = []  # (the command, the block as it is printed)
        kept = self.file.read_text(encoding="utf-8") if self.file.exists() else ""
        self.kept = [part.split("\n", 1) for part in re.split(r"^=== ", kept, flags=re.M)[1:]]
        self.fresh = {}  # line of the page: its block as it is printed

    def check(self, block, command, printed):
        filled = fill(block.text, printed)
        if filled is None:
            raise Failure(f"{self.page}:{block.line}: the page shows\n{block.text}but this was printed:\n{printed}")
        self.made.append((command, filled))
        self.fresh[block.line] = filled
        if self.update:
            return
        expected = block.text if self.full else self.expected_of(len(self.made) - 1, block)
        if settled(expected).split() != settled(filled if self.full else fill(expected, printed) or filled).split():
            where = self.page if self.full else self.file
            raise Failure(f"{self.page}:{block.line}: {where.name} has\n{expected}but these numbers were printed:\n{filled}"
                          f"(run_page.py --update{' --full' if self.full else ''} takes them over)")

    def expected_of(self, position, block):
        if position >= len(self.kept):
            raise Failure(f"{self.page}:{block.line}: {self.file.name} lacks this block (run_page.py --update)")
        expected = self.kept[position][1]
        if NUMBER.sub("#", expected).split() != NUMBER.sub("#", block.text).split():
            raise Failure(f"{self.page}:{block.line}: {self.file.name} has other words:\n{expected}(run_page.py --update)")
        return expected

    def finish(self):
        """After the last block."""
        if not self.update:
            if not self.full and len(self.kept) != len(self.made):
                raise Failure(f"{self.file.name} has {len(self.kept)} blocks, the page {len(self.made)} (run_page.py --update)")
        elif self.full:
            self.rewrite_page()
        elif self.made:
            EXPECTED.mkdir(exist_ok=True)
            parts = [f"=== {command}\n{self.kept_or(position, text)}" for position, (command, text) in enumerate(self.made)]
            words = f"What {self.page.name} prints at the sizes of its test; made by run_page.py --update.\n"
            self.file.write_text(words + "".join(parts), encoding="utf-8")

    def kept_or(self, position, text):
        """What is kept where it says the same, times and dates aside."""
        kept = self.kept[position][1] if position < len(self.kept) else ""
        return kept if settled(kept).split() == settled(text).split() else text

    def rewrite_page(self):
        lines = self.page.read_text(encoding="utf-8").splitlines(keepends=True)
        for line, text in self.fresh.items():  # of a fence, counted from 1: its block begins behind it
            fresh = text.splitlines(keepends=True)
            old = "".join(lines[line : line + len(fresh)])
            # Times and dates stay as they are: each run has its own.
            if settled(old).split() != settled(text).split():
                lines[line : line + len(fresh)] = fresh
        self.page.write_text("".join(lines), encoding="utf-8")


def run_page(page, program, scratch, full, update):
    prepare(scratch, program)
    expectations = Expectations(page, full, update)
    printed, command, ran = "", "", 0
    blocks = blocks_of(page.read_text(encoding="utf-8"), full)
    if update:  # what comes after the last output changes nothing
        blocks = blocks[: max((k + 1 for k, block in enumerate(blocks) if block.note("output") is not None), default=0)]
        if not blocks:
            print("prints nothing that is kept", flush=True)
            return
    for block in blocks:
        if (reason := block.note("skip")) is not None:
            print(f"line {block.line}: left out, {reason}", flush=True)
        elif name := block.note("file"):
            (scratch / name).parent.mkdir(parents=True, exist_ok=True)
            (scratch / name).write_text(block.text, encoding="utf-8")
        elif block.note("output") is not None:
            expectations.check(block, command, printed)
        elif block.language in ("sh", "python"):
            begun = time.monotonic()
            result = subprocess.run(command_of(block), cwd=scratch, env=environment(scratch), text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
            printed, ran = result.stdout.replace(f"{scratch}/", ""), ran + 1  # a reader is elsewhere
            command = next((line for line in reversed(block.text.splitlines()) if line.strip()), "")
            print(f"line {block.line}: {time.monotonic() - begun:.1f} s", flush=True)
            if full:
                print(printed)
            wanted = re.findall(r"\d+", block.note("exit") or "0")
            if str(result.returncode) not in wanted:
                raise Failure(f"{page}:{block.line}: ends with {result.returncode}:\n{block.text}\n{printed}")
    if ran == 0:
        raise Failure(f"{page}: no command to run")
    expectations.finish()
    shutil.rmtree(scratch)


def missing_for(page):
    """What a page needs and this machine lacks."""
    return [need for need in PAGES[page] if shutil.which(need, path="/usr/bin:/bin") is None and find_spec(need) is None]


def run_all(options):
    """Every page, to its end or its failure; the number of failures."""
    failures = 0
    for name in PAGES:
        if missing := missing_for(name):
            print(f"{name}: left out, needs {', '.join(missing)}", flush=True)
            failures += options.full  # before a release nothing is left out
            continue
        begun = time.monotonic()
        print(f"{name}:", flush=True)
        try:
            run_page(ROOT / name, options.program, options.scratch / Path(name).stem, options.full, options.update)
            print(f"{name}: {time.monotonic() - begun:.0f} s", flush=True)
        except Failure as failure:
            print(f"{name}: FAILED\n{failure}", flush=True)
            failures += 1
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--pages", action="store_true")
    parser.add_argument("paths", type=Path, nargs="*")
    options = parser.parse_args()
    if options.pages:
        print(";".join(page for page in PAGES if not missing_for(page)), end="")
        return
    if len(options.paths) != (2 if options.all else 3):
        parser.error("wants [PAGE.md] PROGRAM SCRATCH")
    options.program, options.scratch = options.paths[-2].resolve(), options.paths[-1].resolve()
    if options.all:
        sys.exit(run_all(options) > 0)
    try:
        run_page(options.paths[0].resolve(), options.program, options.scratch, options.full, options.update)
    except Failure as failure:
        sys.exit(str(failure))


if __name__ == "__main__":
    main()
