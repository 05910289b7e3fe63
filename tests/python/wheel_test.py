#!/usr/bin/python3
"""Makes a wheel from the checkout without a network, installs it in an environment of its own, and runs it there.

usage: wheel_test.py CHECKOUT BUILD

The module itself comes from the folder BUILD, as TERRANE_BUILD has it.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

PAGES = ("pyproject.toml", "setup.py", "README.md", "CMakeLists.txt", "python")
USES_IT = """
import terrane
assert "site-packages" in terrane.__file__, terrane.__file__
planet = terrane.run("preview", grid=(64, 32), to="isostasy")
assert planet["elevation"].attrs["units"] == "m"
print(f"{float(planet['elevation'].max()):.0f} m")
"""


def say(*command, **more):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stdout}{done.stderr}")
    return done.stdout


def main():
    checkout, build = (Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as scratch:
        # setuptools leaves its own folders beside what it packs.
        copy = Path(scratch) / "checkout"
        copy.mkdir()
        for name in PAGES:
            take = shutil.copytree if (checkout / name).is_dir() else shutil.copy
            take(checkout / name, copy / name)
        say(sys.executable, "-m", "pip", "wheel", "--no-index", "--no-build-isolation", "--no-deps",
            "--wheel-dir", scratch, copy, env={**os.environ, "TERRANE_BUILD": str(build)})
        (wheel,) = Path(scratch).glob("terrane-*.whl")
        held = zipfile.ZipFile(wheel).namelist()
        for name in ("terrane/__init__.py", "terrane/_core.pyi", "terrane/py.typed"):
            assert name in held, f"{wheel.name} lacks {name}"
        assert any(name.startswith("terrane/_core.") and name.endswith(".so") for name in held), held
        home = Path(scratch) / "home"
        # Without Debian's python3-venv there is no pip in it: that of the system installs there.
        say(sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", home)
        (there,) = home.glob("lib/python*/site-packages")
        say(sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--target", there, wheel)
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        print(wheel.name, say(home / "bin" / "python", "-c", USES_IT, cwd=scratch, env=environment).strip())


main()
