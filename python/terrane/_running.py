"""Runs, islands, scores and calibrations."""

from __future__ import annotations

import os
import sys
import tempfile
import warnings
from typing import Any, Callable, Dict, Mapping, Optional, Tuple, Union

import numpy as np
import xarray as xr

from . import _core
from ._parameters import Parameters, Value
from ._planet import Planet, Stage, open_run, planet_of, stage_of

#: Called with the name of the stage and the fraction of it that is done.
Progress = Callable[[str, float], None]
Path = Union[str, "os.PathLike[str]"]


class _Teller:
    """Hands what a run tells on: progress to whom it concerns, warnings to ``warnings``."""

    def __init__(self, progress: Union[bool, Progress, None]):
        self._progress = _print_progress if progress is True else progress or None
        self._stage = ""

    def __call__(self, kind: str, text: str, number: float) -> None:
        if kind == "warning":
            warnings.warn(text, stacklevel=4)
        elif kind == "begin":
            self._stage = text
            self._tell(0.0)
        elif kind == "progress":
            self._tell(number)
        elif kind == "end":
            self._stage = text
            self._tell(1.0)
        elif kind == "iteration":
            self._stage = f"iteration {text}"
            self._tell(number)

    def _tell(self, fraction: float) -> None:
        if self._progress:
            self._progress(self._stage, fraction)


def _print_progress(stage: str, number: float) -> None:
    if stage.startswith("iteration "):
        print(f"{stage:<12} {number:.0f} m from the target", file=sys.stderr, flush=True)
        return
    print(f"\r{stage:<12}{100 * number:4.0f} %", end="\n" if number == 1.0 else "", file=sys.stderr, flush=True)


def _parameters(preset: str, config: Path, parameters: Union[Parameters, Mapping[str, Value], None],
                dem: Path = "") -> Parameters:
    """A copy of what was given, so that a run changes nothing of it."""
    if isinstance(parameters, Parameters):
        if preset or config:
            raise _core.ConfigurationError("give Parameters, or a preset and a file, not both")
        made = parameters.copy()
        if dem:
            made["dem.file"] = os.fspath(dem)
        return made
    return Parameters(preset, config, dem, parameters or {})


def _grid_text(grid: Union[str, Tuple[int, int]]) -> str:
    return grid if isinstance(grid, str) else f"{grid[0]}x{grid[1]}"


def run(preset: str = "", *, seed: Optional[int] = None, grid: Union[str, Tuple[int, int], None] = None,
        parameters: Union[Parameters, Mapping[str, Value], None] = None, config: Path = "", dem: Path = "",
        elevation: Union[xr.DataArray, np.ndarray, None] = None, from_stage: str = "", to: str = "",
        folder: Path = "", overwrite: bool = False, resume: bool = False, allow_other_build: bool = False,
        threads: int = 0,
        progress: Union[bool, Progress] = False) -> Planet:
    """Runs the pipeline, or a part of it.

    preset, config, parameters
        Where values come from: a built-in configuration, then a TOML file, then ``{"section.key": value}``; or
        ``Parameters`` alone.
    seed, grid
        ``run.seed``, and columns and rows, such as ``(1024, 512)``.
    dem
        A file of elevations, ``FILE[:VARIABLE]``, in place of plates and isostasy.
    elevation
        The same from memory, metres: rows from south to north, columns from -180 degrees; a DataArray with ``lat``
        ascending, or an array. Give ``from_stage`` to say where to begin (default: erosion). ``run.turn`` lays it
        out with another pole.
    from_stage, to
        First and last stage.
    folder
        Writes what the program ``terrane run -o FOLDER`` writes; without it nothing is written. ``resume``,
        ``overwrite`` and ``allow_other_build`` are those of the program.
    threads
        0: as many as OpenMP takes.
    progress
        True prints; a function gets the stage and the fraction that is done.

    Ctrl-C raises ``KeyboardInterrupt`` between two steps of a stage.
    """
    made = _parameters(preset, config, parameters, dem)
    if seed is not None:
        made["run.seed"] = seed
    if grid is not None:
        made["run.grid"] = _grid_text(grid)
    tell = _Teller(progress)
    if folder:
        if elevation is not None:
            raise _core.ConfigurationError("elevation: a run in a folder reads it from a file: give dem")
        _core.run_to_folder(made._configuration, os.fspath(folder), from_stage, to, resume, overwrite,
                            allow_other_build, threads, tell)
        return open_run(folder)
    place: Any = None
    given: Dict[str, Any] = {}
    if elevation is not None:
        place, given = _given_elevation(made, elevation)
        from_stage = from_stage or "erosion"
    stages = _core.run(made._configuration, from_stage, to, place, given, threads, tell)
    return planet_of(stages, made)


def _given_elevation(made: Parameters, elevation: Union[xr.DataArray, np.ndarray]) -> Tuple[_core.Grid, Dict[str, Any]]:
    """The planet's own grid under an elevation in memory."""
    if isinstance(elevation, xr.DataArray):
        rows = elevation[elevation.dims[0]].values if elevation.dims[0] in elevation.coords else None
        if rows is not None and len(rows) > 1 and rows[0] > rows[-1]:
            raise _core.InputError("elevation: its rows run southwards: sort them by latitude, ascending")
    values = np.asarray(elevation, dtype=np.float32)
    if values.ndim != 2:
        raise _core.InputError(f"elevation: has {values.ndim} dimensions: must be 2, latitude and longitude")
    if not np.isfinite(values).all():
        raise _core.InputError("elevation: holds values that are not finite")
    ny, nx = values.shape
    made["run.grid"] = f"{nx}x{ny}"
    grid = _core.Grid.sphere(nx, ny, 1e3 * float(made["planet.radius_km"]), float(made["planet.flattening"]))
    return grid, {"elevation": values}


def island(planet: Union[Planet, Path], *, center: Optional[Tuple[float, float]] = None,
           size: Optional[Tuple[int, int]] = None, cell_m: Optional[float] = None,
           parameters: Mapping[str, Value] = {}, allow_other_build: bool = False, threads: int = 0,
           progress: Union[bool, Progress] = False) -> Stage:
    """Crops and refines one more island from a finished planet.

    Of a planet in memory the island is in memory too. Of one in a folder it is written beside the others, as
    ``terrane island`` writes it. ``center`` is latitude and longitude, degrees.
    """
    whole = planet if isinstance(planet, Planet) else open_run(planet)
    made = whole.parameters.copy()
    if center is not None:
        made["island.center"] = f"{center[0]},{center[1]}"
    if size is not None:
        made["island.nx"], made["island.ny"] = size
    if cell_m is not None:
        made["island.cell_m"] = cell_m
    for name, value in parameters.items():
        made[name] = value
    tell = _Teller(progress)
    if whole.folder is not None:
        name = _core.island_to_folder(made._configuration, os.fspath(whole.folder), allow_other_build, threads,
                                      tell)
        return open_run(whole.folder).stages[name]
    return stage_of(_core.island(made._configuration, [stage._core for stage in whole._own()], threads, tell))


def score(planet: Union[Planet, Path]) -> _core.Scorecard:
    """Measures a planet, the folder of a run, a stage file or an elevation file ``FILE[:VARIABLE]``."""
    return planet.score() if isinstance(planet, Planet) else _core.score_file(os.fspath(planet))


def calibrate(target: Path, preset: str = "", *, parameters: Union[Parameters, Mapping[str, Value], None] = None,
              config: Path = "", folder: Path = "", overwrite: bool = False, resume: bool = False, allow_other_build: bool = False,
              progress: Union[bool, Callable[[str, float], None]] = False) -> _core.Calibration:
    """Fits parameters so that planets have the hypsometry of a target.

    target
        ``"earth"``, ``"earth-statistical"``, a CSV file of quantiles or bins, or a DEM in NetCDF.
    parameters
        As for ``run``; the section ``calibration`` says what is fitted and how.
    folder
        Where report and fitted configuration go; without it they are thrown away.
    progress
        Gets ``"iteration N"`` and the distance from the target, m.

    The result says by ``failure`` why the target was not reached, if it was not.
    """
    made = _parameters(preset, config, parameters)
    name = f"preset {preset}" if preset else os.fspath(config) or "defaults"
    with tempfile.TemporaryDirectory() as scratch:
        place = os.fspath(folder) or os.path.join(scratch, "calibration")
        return _core.calibrate(made._configuration, os.fspath(target), place, name, resume, overwrite, allow_other_build,
                               _Teller(progress))
