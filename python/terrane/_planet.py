"""What a run made: stages, and their fields as xarray Datasets."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np
import xarray as xr

from . import _core

if TYPE_CHECKING:
    from ._parameters import Parameters

_FIELDS = {field.name: field for field in _core.fields()}


def fields() -> Dict[str, _core.Field]:
    """The vocabulary: every field that a stage may write, by name, in the order of files."""
    return dict(_FIELDS)


def _attributes(field: _core.Field, dtype: np.dtype, mapped: bool) -> Dict[str, Any]:
    """As in the files."""
    attributes: Dict[str, Any] = {}
    if field.minimum is not None:
        attributes["valid_min"] = dtype.type(field.minimum)
    if field.maximum is not None:
        attributes["valid_max"] = dtype.type(field.maximum)
    if field.flags:
        attributes["flag_values"] = np.array(list(field.flags.values()), dtype)
        attributes["flag_meanings"] = " ".join(field.flags)
    if field.standard_name:
        attributes["standard_name"] = field.standard_name
    attributes["long_name"] = field.long_name
    if not field.flags:
        attributes["units"] = field.units
    attributes["cell_methods"] = field.cell_methods
    attributes["cell_measures"] = "area: cell_area"
    if mapped:
        attributes["grid_mapping"] = "crs"
    return attributes


def _latitudes(dims: Any, values: np.ndarray, word: str) -> Tuple[Any, np.ndarray, Dict[str, str]]:
    unit = {"latitude": "degrees_north", "longitude": "degrees_east"}[word]
    return dims, values, {"standard_name": word, "long_name": f"{word} of cell centres", "units": unit}


def coordinates(grid: _core.Grid) -> Dict[str, Any]:
    """Coordinates of a grid, with the areas of its cells."""
    rows, columns = dimensions(grid)
    found: Dict[str, Any]
    if grid.is_latitude_longitude:
        found = {"lat": _latitudes("lat", grid.latitude, "latitude"),
                 "lon": _latitudes("lon", grid.longitude, "longitude")}
    else:
        words = ("northing", "easting") if grid.is_projected else ("distance northwards from the middle",
                                                                   "distance eastwards from the middle")
        found = {name: (name, values, {"long_name": text, "units": "m"})
                 for name, values, text in (("y", grid.y_m, words[0]), ("x", grid.x_m, words[1]))}
        if grid.is_projected:
            found["y"][2]["standard_name"] = "projection_y_coordinate"
            found["x"][2]["standard_name"] = "projection_x_coordinate"
            found["lat"] = _latitudes((rows, columns), grid.cell_latitude, "latitude")
            found["lon"] = _latitudes((rows, columns), grid.cell_longitude, "longitude")
    # One value a row, seen from each of its cells.
    area = np.broadcast_to(grid.row_area_m2[:, None], grid.shape)
    found["cell_area"] = ((rows, columns), area,
                          {"standard_name": "cell_area", "long_name": "area of the cell", "units": "m2"})
    if grid.is_geographic:
        found["crs"] = ((), 0, _mapping(grid))
    return found


def dimensions(grid: _core.Grid) -> Tuple[str, str]:
    """Names of the rows and the columns."""
    return ("lat", "lon") if grid.is_latitude_longitude else ("y", "x")


def _mapping(grid: _core.Grid) -> Dict[str, Any]:
    mapping: Dict[str, Any] = {"grid_mapping_name": "latitude_longitude"}
    if grid.is_projected:
        latitude, longitude = grid.centre
        mapping = {"grid_mapping_name": "lambert_azimuthal_equal_area",
                   "latitude_of_projection_origin": latitude, "longitude_of_projection_origin": longitude,
                   "false_easting": 0.0, "false_northing": 0.0}
    mapping["longitude_of_prime_meridian"] = 0.0
    if grid.flattening == 0.0:
        mapping["earth_radius"] = grid.radius_m
    else:
        mapping.update(semi_major_axis=grid.radius_m, inverse_flattening=1.0 / grid.flattening)
    return mapping


def dataset_of(arrays: Dict[str, np.ndarray], grid: _core.Grid, **attributes: Any) -> xr.Dataset:
    """Arrays of a grid as a Dataset that shares their memory, with the attributes of files."""
    dims = dimensions(grid)
    variables: Dict[str, Any] = {}
    make: Any = xr.Variable
    for name, values in arrays.items():
        field = _FIELDS[name]
        variable = make(dims, values, _attributes(field, values.dtype, grid.is_geographic))
        variable.encoding["_FillValue"] = np.nan if values.dtype.kind == "f" else values.dtype.type(field.missing)
        variables[name] = variable
    return xr.Dataset(variables, coordinates(grid), {"Conventions": "CF-1.10", **attributes})


class Stage:
    """What one stage of a run made."""

    def __init__(self, name: str, make: Callable[[], xr.Dataset], seconds: float, budget: Dict[str, float],
                 steps: Dict[str, np.ndarray], warnings: List[str], core: Optional[_core.StageInMemory] = None):
        self.name = name
        self.seconds = seconds
        #: Sums that must close: rock, water.
        self.budget = budget
        #: Of a stage that runs through time: a column for each quantity, an entry for each step.
        self.steps = steps
        self.warnings = warnings
        self._make = make
        self._dataset: Optional[xr.Dataset] = None
        self._core = core

    @property
    def dataset(self) -> xr.Dataset:
        """All fields that the stage wrote, with coordinates, areas and CF attributes."""
        if self._dataset is None:
            self._dataset = self._make()
        return self._dataset

    def __getitem__(self, field: str) -> xr.DataArray:
        return self.dataset[field]

    def __repr__(self) -> str:
        return f"<terrane.Stage {self.name}: {', '.join(map(str, self.dataset.data_vars))}>"


class Planet:
    """The stages of a run. ``planet["temperature"]`` is the field as the last stage of the planet left it."""

    def __init__(self, stages: Dict[str, Stage], parameters: "Parameters", folder: Optional[Path] = None):
        #: Stages by name, in their order; islands beside them.
        self.stages = stages
        #: The parameters that it was made with.
        self.parameters = parameters
        #: Where its files are; None for a run in memory.
        self.folder = folder

    def __getitem__(self, field: str) -> xr.DataArray:
        for stage in reversed(self._own()):
            if field in stage.dataset:
                return stage.dataset[field]
        raise KeyError(f"no stage of this planet has {field}")

    def __contains__(self, field: object) -> bool:
        return any(field in stage.dataset for stage in self._own())

    def __iter__(self) -> Iterator[str]:
        return iter(self.stages)

    def _own(self) -> List[Stage]:
        return [stage for name, stage in self.stages.items() if not name.startswith("island")]

    @property
    def dataset(self) -> xr.Dataset:
        """Every field of the planet as the last stage left it."""
        merged = self._own()[0].dataset
        for stage in self._own()[1:]:
            merged = merged.assign({str(name): stage.dataset[name] for name in stage.dataset.data_vars})
        return merged.assign_attrs(terrane_stage=self._own()[-1].name)

    def score(self) -> _core.Scorecard:
        """The planet's figures beside Earth's."""
        if self.folder is not None:
            return _core.score_file(os.fspath(self.folder))
        return _core.score_stages([stage._core for stage in self._own()])

    def __repr__(self) -> str:
        place = f" in {self.folder}" if self.folder else ""
        return f"<terrane.Planet{place}: {', '.join(self.stages)}>"


def planet_of(stages: List[_core.StageInMemory], parameters: "Parameters") -> Planet:
    """Stages of a run in memory."""
    return Planet({stage.name: stage_of(stage) for stage in stages}, parameters)


def stage_of(core: _core.StageInMemory) -> Stage:
    """One of them; its Dataset shares the memory."""
    return Stage(core.name, lambda: dataset_of(core.arrays, core.grid, terrane_stage=core.name), core.seconds,
                 core.budget, core.steps, core.warnings, core)


def open_run(folder: Union[str, os.PathLike]) -> Planet:
    """Opens the folder of a run. Files are read when their fields are asked for."""
    from ._parameters import Parameters

    place = Path(folder)
    try:
        manifest = json.loads((place / "manifest.json").read_text())
    except FileNotFoundError:
        raise _core.FileError(f"{place}: holds no run") from None
    stages = {}
    for record in manifest["stages"]:
        files = [name for name in record["files"] if name.endswith(".nc")]
        stages[record["name"]] = Stage(record["name"], _opener(place / files[0]), record["seconds"],
                                       record.get("budget", {}), _steps(place, record), record.get("warnings", []))
    return Planet(stages, Parameters(config=place / "config.toml"), place)


def _opener(path: Path) -> Callable[[], xr.Dataset]:
    return lambda: xr.open_dataset(path)


def _steps(place: Path, record: Dict[str, Any]) -> Dict[str, np.ndarray]:
    tables = [name for name in record["files"] if name.endswith(f"-{record['name']}.csv")]
    if not tables:
        return {}
    table: Any = np.genfromtxt(place / tables[0], delimiter=",", names=True, deletechars="", ndmin=1)
    return {column: table[column] for column in table.dtype.names}
