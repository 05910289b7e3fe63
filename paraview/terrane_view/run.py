"""What the folder of a run holds for ParaView."""

import json
import re
from pathlib import Path


class RunError(Exception):
    """The folder cannot be shown; the text says why and what helps."""


class Run:
    """The VTK files of a run: `stages` and `islands` by name, `frames` the collection of drift."""

    def __init__(self, folder):
        self.folder = Path(folder).expanduser().resolve()
        if not self.folder.is_dir():
            raise RunError(f"{folder}: no such folder")
        files = {p.stem[3:]: p for p in sorted(self.folder.glob("[0-9][0-9]-*.vti"))}
        self.islands = {n: p for n, p in files.items() if re.fullmatch(r"island(-\d+)?", n)}
        self.stages = {n: p for n, p in files.items() if n not in self.islands}
        frames = self.folder / "plates.pvd"
        self.frames = frames if frames.exists() else None
        if not self.stages:
            raise RunError(
                f"{self.folder}: no VTK files of a run; terrane run --resume "
                f"--set output.vtk=true -o {self.folder} writes them"
            )
        self.manifest = self.read_manifest()

    def read_manifest(self):
        """manifest.json, empty when there is none."""
        path = self.folder / "manifest.json"
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}

    @property
    def seed(self):
        """Seed of the run, or None."""
        return self.manifest.get("seed")

    def units(self, field):
        """Units of a field as the manifest has them; empty for classes and pure numbers."""
        for stage in self.manifest.get("stages", []):
            if field in stage.get("fields", {}):
                units = stage["fields"][field].get("units", "")
                return "" if units == "1" else units
        return ""

    def number(self, stage):
        """Number of a stage of the planet, with which its file's name begins."""
        return int(self.stages[stage].name[:2])


def run_folder_of(path):
    """The folder of a run that holds `path` or is it, or None."""
    here = Path(path)
    for folder in (here, *here.parents):
        if (folder / "manifest.json").exists() or (folder / "planet.pvd").exists():
            return folder
    return None
