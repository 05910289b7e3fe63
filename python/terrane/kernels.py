"""Single kernels on numpy arrays.

Every array has the shape (ny, nx) of a ``terrane.Grid``; row 0 is the southernmost. Kernels change none of their
arguments, run on as many threads as OpenMP takes, and let other Python threads work meanwhile.

>>> grid = terrane.Grid.plane(512, 512, dx_m=100.0, dy_m=100.0)
>>> flow = kernels.route(grid, elevation)
>>> area = kernels.accumulate(grid, flow.filled, flow.receiver)
>>> lower = kernels.incise(grid, elevation, flow.receiver, area, erodibility=2e-6, dt_yr=1e5)
"""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Optional, Union

import numpy as np
import xarray as xr

from . import _core

Array = np.ndarray


class Flow(NamedTuple):
    """Water routed to outlets over the spill points of all depressions."""

    receiver: Array  #: flat index of the cell that takes each cell's water; itself at an outlet
    order: Array  #: flat indices, every cell after all its donors
    filled: Array  #: elevation, raised to the spill level in depressions, m


def route(grid: _core.Grid, elevation: Array, outlets: Optional[Array] = None, sea_level_m: float = 0.0) -> Flow:
    """Steepest descent (D8), and out of each pit over its lowest pass (Cordonnier et al. 2019).

    ``outlets`` is non-zero where water leaves; by default below the sea level and at open edges, on a closed world
    without a sea at its lowest cell. Cost: linear.
    """
    return Flow(*_core.route(grid, elevation, outlets, sea_level_m))


def fill(grid: _core.Grid, elevation: Array, outlets: Optional[Array] = None, sea_level_m: float = 0.0) -> Array:
    """Raises every cell to the level at which its water can reach an outlet (Barnes et al. 2014), m."""
    return _core.fill(grid, elevation, outlets, sea_level_m)


def accumulate(grid: _core.Grid, surface: Array, receiver: Array, source: Optional[Array] = None,
               method: str = "steepest", exponent: float = 1.1) -> Array:
    """What arrives in each cell of what all supply, their own included; without ``source`` the drainage area, m2.

    ``surface`` and ``receiver`` are those of ``route``. ``method`` is ``"steepest"``, ``"multiple"`` (Freeman 1991;
    shares go as slope to the ``exponent``) or ``"d_infinity"`` (Tarboton 1997).
    """
    return _core.accumulate(grid, surface, receiver, source, method, exponent)


def incise(grid: _core.Grid, elevation: Array, receiver: Array, area: Array, erodibility: Union[float, Array],
           dt_yr: float, area_exponent: float = 0.5, slope_exponent: float = 1.0,
           sea_level_m: float = -np.inf) -> Array:
    """One implicit step of river incision, dz/dt = -K A^m S^n (Braun & Willett 2013), m.

    ``area``: drainage area, m2; ``erodibility``: K, m^(1-2m) yr-1, one value or one per cell. Stable for any step.
    """
    factor = np.atleast_1d(np.asarray(erodibility, np.float32))
    return _core.incise(grid, elevation, receiver, area, factor, dt_yr, area_exponent, slope_exponent, sea_level_m)


def diffuse(grid: _core.Grid, field: Array, diffusivity_m2_yr: float, dt_yr: float, fixed: Optional[Array] = None,
            excluded: Optional[Array] = None, positive: bool = False) -> Array:
    """Linear diffusion over ``dt_yr``, implicit, on the true metric of the grid.

    Cells where ``fixed`` is non-zero keep their value; no flux enters or leaves those that are ``excluded``. With
    ``positive`` no value leaves the range of the field, at first order in time.
    """
    return _core.diffuse(grid, field, diffusivity_m2_yr, dt_yr, fixed, excluded, positive)


def climate(elevation: Union[Array, xr.DataArray], preset: str = "",
            parameters: Mapping[str, Any] = {}) -> xr.Dataset:
    """Temperature, precipitation and wind of a whole planet from its elevation, m: the stage ``climate``."""
    from ._running import run

    return run(preset, elevation=elevation, parameters=parameters, from_stage="climate",
               to="climate").stages["climate"].dataset
