"""Lets pip build the extension with CMake; everything else is in pyproject.toml."""

import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """Configures and builds the target `terrane_python` and puts it where setuptools wants it. With TERRANE_BUILD the
    module comes from that folder, which CMake has configured for this Python."""

    def build_extension(self, extension: Extension) -> None:
        target = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        given = os.environ.get("TERRANE_BUILD")
        build = Path(given) if given else ROOT / "build" / f"wheel-{sys.implementation.cache_tag}"
        if not given:
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DTERRANE_TESTS=OFF", "-DTERRANE_PYTHON_MODULE=ON",
                            f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "terrane_python"], check=True)
        target.mkdir(parents=True, exist_ok=True)
        for library in (build / "python" / "terrane").glob("_core*.so"):
            self.copy_file(str(library), str(target / library.name))


version = re.search(r"project\(terrane VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
setup(version=version, ext_modules=[Extension("terrane._core", [])], cmdclass={"build_ext": CMakeBuild})
