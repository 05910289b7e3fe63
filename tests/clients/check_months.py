#!/usr/bin/env python3
"""Whether other programs read the months of a climate as what they are: a CF climatology.

    check_months.py TERRANE

Runs a small planet with TERRANE and opens 04-climate.nc in netCDF4, xarray and CDO where they are installed.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import netCDF4
import numpy as np

NAMES = ("temperature_monthly", "precipitation_monthly", "wind_east_monthly", "wind_north_monthly")


def check_file(path):
    with netCDF4.Dataset(path) as file:
        month = file["month"]
        assert month.climatology == "climatology_bounds" and len(month) == 12
        bounds = file["climatology_bounds"][:]
        assert np.allclose(bounds[:, 0] + 365 / 12, bounds[:, 1]) and np.allclose(bounds.mean(1), month[:])
        for name in NAMES:
            assert file[name].dimensions == ("month", "lat", "lon"), name
            assert "month: mean over years" in file[name].cell_methods, name
            assert np.isfinite(file[name][:]).all(), name
        assert file["precipitation_monthly"].units == "mm month-1"
        rain = file["precipitation_monthly"][:].sum(0)
        assert np.allclose(rain, file["precipitation"][:], rtol=1e-4, atol=0.01)
        assert np.allclose(file["temperature_monthly"][:].mean(0), file["temperature"][:], atol=1e-3)


def check_xarray(path):
    try:
        import xarray
    except ImportError:
        return
    with xarray.open_dataset(path) as dataset:
        july = dataset["temperature_monthly"].isel(month=6)
        assert july.dims == ("lat", "lon")
        north = float(july.where(july.lat > 30).mean()) - float(dataset["temperature"].where(july.lat > 30).mean())
        assert north > 1, "July is warm in the north"


def check_cdo(path):
    if shutil.which("cdo") is None:
        return
    count = subprocess.run(["cdo", "-s", "ntime", "-selname,precipitation_monthly", path], check=True,
                           capture_output=True, text=True).stdout
    assert count.split() == ["12"], count


def main():
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        subprocess.run([sys.argv[1], "run", "--preset", "preview", "--grid", "96x48", "--to", "climate", "--no-vtk",
                        "--no-maps", "--quiet", "--set", "output.monthly=true", "-o", out], check=True)
        path = out / "04-climate.nc"
        check_file(path)
        check_xarray(path)
        check_cdo(path)


if __name__ == "__main__":
    main()
