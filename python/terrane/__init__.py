"""A whole planet's surface from physics.

>>> import terrane
>>> planet = terrane.run(preset="preview", seed=3)
>>> planet["elevation"]                       # an xarray DataArray, nothing copied
>>> planet.stages["climate"].dataset          # all that a stage wrote
>>> planet.score()

A run in memory writes no file; with ``folder="out"`` it writes what the program ``terrane run``
writes, and ``terrane.open_run("out")`` reads it back. Units are those of the files.
"""

import os as _os

# Threads that wait should sleep, so that other work on the machine goes on. Read once, by OpenMP.
_os.environ.setdefault("OMP_WAIT_POLICY", "passive")

from . import kernels
from ._core import (Calibration, ConfigurationError, Curve, Error, Field, Figure, FileError, FittedParameter, Grid,
                    InputError, ParameterInfo, Scorecard, SeedMisfit, __commit__, __version__)
from ._parameters import Parameters, Section, presets
from ._planet import Planet, Stage, fields, open_run
from ._running import calibrate, island, run, score

__all__ = [
    "Calibration", "ConfigurationError", "Curve", "Error", "Field", "Figure", "FileError", "FittedParameter", "Grid",
    "InputError", "ParameterInfo", "Parameters", "Planet", "Scorecard", "Section", "SeedMisfit", "Stage",
    "calibrate", "fields", "island", "kernels", "open_run", "presets", "run", "score",
]
