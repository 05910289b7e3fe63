"""Texts of programmable filters, put together from the modules in `filters`.

A state file keeps the text, so that it opens where this folder is not.
"""

import ast
from pathlib import Path

MODULES = ("mesh", "topography", "lines")


def without_own_imports(text):
    """A module's text without imports of its neighbours, which stand above it."""
    lines = text.splitlines()
    for node in ast.parse(text).body:
        if isinstance(node, ast.ImportFrom) and node.level > 0:
            lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
    return "\n".join(lines)


def filter_script(function, **settings):
    """The text of a programmable filter that calls one of the functions in `filters`."""
    folder = Path(__file__).resolve().parent / "filters"
    texts = [without_own_imports((folder / f"{m}.py").read_text(encoding="utf-8")) for m in MODULES]
    words = ", ".join(f"{name}={value!r}" for name, value in settings.items())
    # ParaView puts numpy's max, min, sum and others in front of Python's own.
    own = "from builtins import abs, all, any, max, min, round, sum"
    return "\n\n".join([own, *texts, f"{function}(self, {words})"]) + "\n"


def times_script(times):
    """The text by which a programmable filter says which times it knows."""
    times = [float(time) for time in times]
    return (
        "from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as keys\n"
        "about = self.GetOutputInformation(0)\n"
        f"about.Set(keys.TIME_STEPS(), {times!r}, {len(times)})\n"
        f"about.Set(keys.TIME_RANGE(), {[times[0], times[-1]]!r}, 2)\n"
    )


WHOLE_INPUTS = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as keys
for i in range(self.GetNumberOfInputConnections(0)):
    asked = self.GetInputInformation(0, i)
    if asked.Has(keys.WHOLE_EXTENT()):
        asked.Set(keys.UPDATE_EXTENT(), asked.Get(keys.WHOLE_EXTENT()), 6)
"""
"""Asks each input for all of it: images of several sizes come together."""
