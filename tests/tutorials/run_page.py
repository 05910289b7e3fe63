#!/usr/bin/python3
"""Runs the commands of a page as a reader would, in a scratch folder: run_page.py [--full] PAGE.md PROGRAM SCRATCH

Blocks fenced as sh, python, and those named as files are done in their order; the first that fails ends
the run with its output. Comments above a block, which no reader sees, say how:

  <!-- test: file NAME -->             the block is the content of file NAME
  <!-- test: output -->                the block is what the block before it prints
  <!-- test: exit 0 or 5 -->           exit codes that are as they should be
  <!-- test: skip, REASON -->          the block is not run
  <!-- test: replace `A` by `B` -->    in every block from here on; the test's planets are small

In expected output a number stands for any number, as planets of the test are small and models improve,
three dots for any words of a line, and a line of three dots for any lines; all else must be there as it
stands, spaces aside. --full leaves sizes as the page has them and shows what is printed.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
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


def pattern_of_word(word):
    return ".*" if word == "..." else NUMBER.pattern.join(map(re.escape, NUMBER.split(word)))


def pattern_of(expected):
    parts = []
    for line in expected.splitlines():
        if line.strip() == "...":
            parts.append(r"(?:.*\n)*?")
        else:
            parts.append(r"[ \t]*" + r"[ \t]+".join(map(pattern_of_word, line.split())) + r"[ \t]*\n")
    return re.compile("".join(parts))


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


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--full", action="store_true")
    parser.add_argument("page", type=Path)
    parser.add_argument("program", type=Path)
    parser.add_argument("scratch", type=Path)
    options = parser.parse_args()
    page, scratch = options.page, options.scratch.resolve()
    prepare(scratch, options.program.resolve())
    printed, ran = None, 0

    def fail(block, words):
        sys.exit(f"{page}:{block.line}: {words}")

    for block in blocks_of(page.read_text(encoding="utf-8"), options.full):
        if (reason := block.note("skip")) is not None:
            print(f"line {block.line}: left out, {reason}", flush=True)
        elif name := block.note("file"):
            (scratch / name).parent.mkdir(parents=True, exist_ok=True)
            (scratch / name).write_text(block.text, encoding="utf-8")
        elif block.note("output") is not None:
            if printed is None or not pattern_of(block.text).search(printed + "\n"):
                fail(block, f"the page shows\n{block.text}but this was printed:\n{printed}")
        elif block.language in ("sh", "python"):
            begun = time.monotonic()
            result = subprocess.run(command_of(block), cwd=scratch, env=environment(scratch), text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
            printed, ran = result.stdout, ran + 1
            print(f"line {block.line}: {time.monotonic() - begun:.1f} s", flush=True)
            if options.full:
                print(printed)
            wanted = re.findall(r"\d+", block.note("exit") or "0")
            if str(result.returncode) not in wanted:
                fail(block, f"ends with {result.returncode}:\n{block.text}\n{printed}")
    if ran == 0:
        sys.exit(f"{page}: no command to run")
    shutil.rmtree(scratch)


main()
