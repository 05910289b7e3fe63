"""Loads stage files into ParaView and compares what it sees with the files.

usage: xvfb-run -a -s '-screen 0 1280x1024x24' pvbatch paraview_check.py FOLDER

Every .vti, .pvd and .nc of the folder is opened through ParaView's own readers; field names,
ranges, counts and extents must be what netCDF4 for Python sees in the NetCDF file of the same
name. Ends with 1 on any failure.
"""

import os
import sys
from pathlib import Path

import numpy as np
from netCDF4 import Dataset
from paraview import simple

sys.path.insert(0, str(Path(__file__).resolve().parent))
from checking import close, expect, failures  # noqa: E402


class Reference:
    """What netCDF4 sees of one file."""

    def __init__(self, path):
        with Dataset(path) as dataset:
            dataset.set_auto_mask(False)
            self.is_latitude_longitude = "lat" in dataset.dimensions
            # The corners of cells that have them: ParaView shows those as cells, others as points.
            self.corners = None
            if "lat_bnds" in dataset.variables and not self.is_latitude_longitude:
                self.corners = [np.asarray(dataset[name][:]) for name in ("lon_bnds", "lat_bnds")]
            self.cells = int(np.prod(dataset["cell_area"].shape))
            self.values = {
                name: np.asarray(variable[:])
                for name, variable in dataset.variables.items()
                if "cell_measures" in variable.ncattrs()
            }


def compare(path, source, reference, of_points, bytes_are_unsigned):
    """Names and ranges of all fields; returns the extent."""
    source.UpdatePipeline()
    information = source.GetDataInformation()
    count = information.GetNumberOfPoints() if of_points else information.GetNumberOfCells()
    expect(count == reference.cells, path.name, "has", count, "values, not", reference.cells)
    arrays = source.GetPointDataInformation() if of_points else source.GetCellDataInformation()
    for name, values in reference.values.items():
        array = arrays.GetArray(name)
        if array is None:
            expect(False, path.name, "lacks", name)
            continue
        if bytes_are_unsigned and values.dtype == np.int8:
            values = values.view(np.uint8)
        seen, low, high = array.GetRange(0), np.nanmin(values), np.nanmax(values)
        expect(close(seen[0], low) and close(seen[1], high), path.name, name, "ranges over", seen,
               "not", (low, high))
    return information.GetBounds()


def check_image(path):
    reference = Reference(path.with_suffix(".nc"))
    image = simple.XMLImageDataReader(FileName=[str(path)])
    bounds = compare(path, image, reference, of_points=False, bytes_are_unsigned=False)
    if path.stem in ("sphere", "ellipsoid"):
        expect(np.allclose(bounds[:4], [-180, 180, -90, 90]), path.name, "lies at", bounds)
    simple.Delete(image)


def check_netcdf(path):
    reference = Reference(path)
    degrees = reference.is_latitude_longitude
    reader = simple.NetCDFReader(FileName=[str(path)])
    reader.Dimensions = "(lat, lon)" if degrees else "(y, x)"
    # Cells that know their latitude and longitude would be shown on a globe.
    reader.SphericalCoordinates = int(degrees)
    # ParaView puts values without bounds on points, and reads bytes without their sign.
    on_points = not degrees and reference.corners is None
    bounds = compare(path, reader, reference, of_points=on_points, bytes_are_unsigned=True)
    if reference.corners:
        # VTK 9.1 gathers the last row's outer corners in one point: the last row says nothing.
        rows = [axis[:-1] for axis in reference.corners]
        expected = [f(axis) for axis in rows for f in (np.min, np.max)]
        cell = [abs(np.diff(axis, axis=0)).max() for axis in rows]
        near = [abs(a - b) <= size for a, b, size in zip(bounds, expected, np.repeat(cell, 2))]
        expect(all(near), path.name, "lies at", bounds, "not", expected)
    elif not degrees:
        expect(bounds[4] == bounds[5], path.name, "is no plane in ParaView:", bounds)
        expect(bounds[1] - bounds[0] > 1000.0, path.name, "is not in metres:", bounds)
    simple.Delete(reader)


def check_collection(path):
    collection = simple.PVDReader(FileName=str(path))
    collection.UpdatePipelineInformation()
    steps = collection.TimestepValues
    expect(len(list(steps) if hasattr(steps, "__len__") else [steps]) >= 1, path.name, "has no steps")
    collection.UpdatePipeline()
    expect(collection.GetDataInformation().GetNumberOfCells() > 0, path.name, "is empty")
    simple.Delete(collection)


def main():
    folder = Path(sys.argv[1])
    for path in sorted(folder.glob("*.nc")):
        check_netcdf(path)
    for path in sorted(folder.glob("*.vti")):
        check_image(path)
    for path in sorted(folder.glob("*.pvd")):
        check_collection(path)
    print(f"ParaView: {len(failures)} failures", flush=True)
    # pvbatch hangs now and then in its own clean-up.
    os._exit(1 if failures else 0)


main()
