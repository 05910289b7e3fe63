"""Loads stage files into ParaView and compares what it sees with the files.

usage: xvfb-run -a -s '-screen 0 1280x1024x24' pvbatch paraview_check.py FOLDER

Every .vti, .pvd and .nc of the folder is opened through ParaView's own readers; field names,
ranges, cell counts and extents must be those of the file of the same name. NetCDF files are read
by netCDF4 for Python where it is installed, else by ParaView alone. Ends with 1 on any failure.
"""

import os
import sys
from pathlib import Path

import numpy as np
from netCDF4 import Dataset
from paraview import simple

failures = []


def expect(good, *words):
    if not good:
        failures.append(" ".join(str(word) for word in words))
        print("FAIL", failures[-1], flush=True)


def close(a, b, tolerance=1e-5):
    return abs(a - b) <= tolerance * max(1.0, abs(a), abs(b))


def ranges_of(path):
    """Least and greatest value of each field, and the number of cells."""
    with Dataset(path) as dataset:
        fields = {}
        for name, variable in dataset.variables.items():
            if "cell_measures" in variable.ncattrs():
                values = np.ma.masked_invalid(np.ma.asarray(variable[:], dtype="f8"))
                # ParaView knows missing values as NaN alone; integers keep theirs.
                if variable.dtype.kind == "i":
                    values = np.asarray(values.data)
                fields[name] = (float(values.min()), float(values.max()))
        return fields, int(np.prod(dataset["cell_area"].shape)), "lat" in dataset.dimensions


def compare(path, source, fields, cells):
    source.UpdatePipeline()
    information = source.GetDataInformation()
    expect(information.GetNumberOfCells() == cells, path.name, "has", information.GetNumberOfCells(),
           "cells, not", cells)
    arrays = source.GetCellDataInformation()
    for name, (low, high) in fields.items():
        array = arrays.GetArray(name)
        if array is None:
            expect(False, path.name, "lacks", name)
            continue
        seen = array.GetRange(0)
        expect(close(seen[0], low) and close(seen[1], high), path.name, name, "ranges over", seen,
               "not", (low, high))
    return information.GetBounds()


def check_image(path, reference):
    fields, cells, degrees = ranges_of(reference)
    image = simple.XMLImageDataReader(FileName=[str(path)])
    bounds = compare(path, image, fields, cells)
    if path.stem in ("sphere", "ellipsoid"):
        expect(np.allclose(bounds[:4], [-180, 180, -90, 90]), path.name, "lies at", bounds)
    simple.Delete(image)


def check_netcdf(path):
    fields, cells, degrees = ranges_of(path)
    reader = simple.NetCDFReader(FileName=[str(path)])
    rows, columns = ("lat", "lon") if degrees else ("y", "x")
    reader.Dimensions = f"({rows}, {columns})"
    reader.ReplaceFillValueWithNan = 1
    # Integers: ParaView would turn them into floats to put NaN in.
    with_gaps = {name: limits for name, limits in fields.items() if limits[0] >= 0 or "_" not in name}
    bounds = compare(path, reader, {**fields, **with_gaps}, cells)
    radius = max(abs(b) for b in bounds)
    if not degrees:
        expect(bounds[4] == bounds[5], path.name, "is no plane in ParaView:", bounds)
        expect(radius > 100.0, path.name, "is wrapped onto a sphere:", bounds)
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
        check_image(path, path.with_suffix(".nc"))
    for path in sorted(folder.glob("*.pvd")):
        check_collection(path)
    print(f"ParaView: {len(failures)} failures", flush=True)
    # pvbatch hangs now and then in its own clean-up.
    os._exit(1 if failures else 0)


main()
