#!/usr/bin/python3
"""Opens every stage file of a folder with the programs people use, and compares what they see.

usage: check_files.py FOLDER

netCDF4 for Python is the reference; xarray, CDO, NCO, GDAL, ncdump and udunits2 are asked when
they are installed. Also checks the CF-1.10 conventions that stage files use (it is no complete
CF checker). Prints one line per failure and ends with 1 if there was any.
"""

import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np

from checking import expect, failures

# Of the CF standard name table: the names that terrane's fields and coordinates may bear.
STANDARD_NAMES = {
    "latitude": "degrees_north",
    "longitude": "degrees_east",
    "cell_area": "m2",
    "height_above_mean_sea_level": "m",
    "air_temperature": "K",
    "lwe_precipitation_rate": "m s-1",
    "eastward_wind": "m s-1",
    "northward_wind": "m s-1",
    "water_volume_transport_in_river_channel": "m3 s-1",
    "land_ice_thickness": "m",
    "sea_ice_area_fraction": "1",
    "eastward_sea_water_velocity": "m s-1",
    "northward_sea_water_velocity": "m s-1",
    "projection_x_coordinate": "m",
    "projection_y_coordinate": "m",
}

asked = set()


def close(a, b, tolerance=1e-6):
    a, b = float(a), float(b)
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    return abs(a - b) <= tolerance * max(1.0, abs(a), abs(b))


def call(program, *arguments):
    """Output of a program, None when it is not installed; its failure is ours."""
    if shutil.which(program) is None:
        return None
    asked.add(program)
    result = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    expect(result.returncode == 0, program, *arguments, "->", result.stderr.strip()[:300])
    # Frames keep what a run goes on from in a group of its own, for nobody else; a plane without a
    # map projection has neither latitudes nor map coordinates.
    known = ("groups not supported", "is not a Longitude/X dimension", "is not a Latitude/Y dimension")
    for line in result.stderr.splitlines():
        expect("arning" not in line or any(words in line for words in known), program, *arguments, "->", line)
    expect("# unit 1, design" not in result.stdout, program, *arguments, "prints the configuration")
    return result.stdout if result.returncode == 0 else None


def attribute(variable, name, default=None):
    return variable.getncattr(name) if name in variable.ncattrs() else default


class Reference:
    """What netCDF4 sees of one file."""

    def __init__(self, path):
        self.path = path
        self.dataset = netCDF4.Dataset(path)
        self.area = np.asarray(self.dataset["cell_area"][:], dtype="f8")
        self.fields = [
            name for name, v in self.dataset.variables.items()
            if attribute(v, "cell_measures") is not None
        ]

    def values(self, name):
        """Of a field on rows and columns, also where it is the only one of its time."""
        values = np.ma.masked_invalid(np.ma.asarray(self.dataset[name][:], dtype="f8"))
        return values.reshape(self.area.shape)

    def summary(self, name):
        values = self.values(name)
        mean = np.ma.average(values, weights=self.area)
        return float(values.min()), float(mean), float(values.max()), int(values.mask.sum())

    @property
    def is_latitude_longitude(self):
        return "lat" in self.dataset.dimensions

    @property
    def is_frame(self):
        """One time of many of the same planet."""
        return "drift_time" in self.dataset.dimensions

    @property
    def is_projected(self):
        """An island: a map of a part of a planet, with the latitude and longitude of every cell."""
        return "crs" in self.dataset.variables and not self.is_latitude_longitude


def converts(have, want):
    """Whether UDUNITS converts one unit to the other."""
    output = subprocess.run(["udunits2", "-H", have, "-W", want], capture_output=True, text=True)
    return output.returncode == 0 and not output.stderr.strip()


def check_conventions(reference):
    """The CF-1.10 rules that bear on stage files."""
    dataset, file = reference.dataset, reference.path.name
    expect(attribute(dataset, "Conventions") == "CF-1.10", file, "Conventions must be CF-1.10")
    for name in ("title", "source", "history", "terrane_config_digest", "terrane_seed", "terrane_version"):
        expect(attribute(dataset, name) not in (None, ""), file, "global attribute", name, "missing")
    expect(len(reference.fields) > 0, file, "holds no field")
    for holder in (dataset, *dataset.variables.values()):
        for name in holder.ncattrs():
            expect(len(str(holder.getncattr(name))) < 2000, file, name, "fills what clients print")

    for name, variable in dataset.variables.items():
        where = f"{file}: {name}:"
        expect(re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name), where, "name is not CF's")
        standard_name = attribute(variable, "standard_name")
        if standard_name is not None:
            expect(standard_name in STANDARD_NAMES, where, "unknown standard_name", standard_name)
        expect(attribute(variable, "axis") is None or reference.is_latitude_longitude, where,
               "axis attribute on projected coordinates")
        bounds = attribute(variable, "bounds")
        if bounds is not None:
            check_bounds(where, variable, dataset.variables.get(bounds))
        if shutil.which("udunits2"):
            asked.add("udunits2")
            units = attribute(variable, "units")
            if units is not None:
                expect(converts(units, units), where, "UDUNITS cannot read units", repr(units))
                if standard_name in STANDARD_NAMES:
                    expect(converts(units, STANDARD_NAMES[standard_name]), where, "units", units,
                           "do not fit standard_name", standard_name)

    for name in reference.fields:
        check_field(f"{file}: {name}:", reference, dataset[name])


def check_bounds(where, variable, bounds):
    if bounds is None:
        return expect(False, where, "bounds variable is missing")
    edges, centres = np.asarray(bounds[:]), np.asarray(variable[:])
    if centres.ndim == 2:
        return check_corners(where, variable, edges, centres)
    expect(edges.shape == (*centres.shape, 2), where, "bounds have another shape")
    expect(np.all(edges[:, 0] < centres) and np.all(centres < edges[:, 1]), where,
           "lies outside its bounds")
    expect(np.array_equal(edges[1:, 0], edges[:-1, 1]), where, "bounds have gaps")
    expect(np.all(np.diff(centres) > 0), where, "does not ascend")
    return None


def check_corners(where, variable, corners, centres):
    """CF-1.10 7.1: vertices of two-dimensional coordinates, anticlockwise, shared by neighbours."""
    expect(corners.shape == (*centres.shape, 4), where, "corners have another shape")
    turn = 360.0 if variable.getncattr("units") == "degrees_east" else np.inf
    same = lambda a, b: np.array_equal(np.remainder(a, turn), np.remainder(b, turn))
    expect(same(corners[:, 1:, 0], corners[:, :-1, 1]) and same(corners[:, 1:, 3], corners[:, :-1, 2])
           and same(corners[1:, :, 0], corners[:-1, :, 3])
           and same(corners[1:, :, 1], corners[:-1, :, 2]), where, "cells do not share their corners")
    expect(np.all(np.abs(corners - centres[..., None]) <= 180.0), where, "corners are on the far side")
    # The middle of the corners is the centre, to a small part of a cell; not where meridians meet.
    size = np.ptp(corners, axis=-1)
    plain = size < 10 * np.median(size)
    off = np.abs(corners.mean(axis=-1) - centres)
    expect(plain.mean() > 0.9 and np.all(off[plain] <= 0.05 * size[plain]), where,
           "lies off the middle of its corners")


def check_anticlockwise(reference):
    """Corners of an island's cells, as seen from above, go round to the left."""
    if not reference.is_projected:
        return
    lat, lon = (np.radians(np.asarray(reference.dataset[name][:])) for name in ("lat_bnds", "lon_bnds"))
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    to_next, to_last = points[..., 1, :] - points[..., 0, :], points[..., 3, :] - points[..., 0, :]
    upward = (np.cross(to_next, to_last) * points[..., 0, :]).sum(axis=-1)
    expect(np.all(upward > 0), reference.path.name, "corners of cells do not go round anticlockwise")
    # Half the cross product is a triangle: its double is the cell.
    crs = reference.dataset["crs"]
    radius = float(attribute(crs, "earth_radius") or attribute(crs, "semi_major_axis"))
    expect(np.allclose(upward * radius**2, reference.area, rtol=0.05), reference.path.name,
           "corners do not enclose the cells' areas")


def check_field(where, reference, variable):
    dataset = reference.dataset
    rows, columns = ("lat", "lon") if reference.is_latitude_longitude else ("y", "x")
    wanted = ("drift_time", rows, columns) if reference.is_frame else (rows, columns)
    expect(variable.dimensions == wanted, where, "dimensions are", variable.dimensions)
    expect(attribute(variable, "long_name"), where, "long_name is missing")
    expect(attribute(variable, "cell_methods"), where, "cell_methods is missing")
    expect(attribute(variable, "cell_measures") == "area: cell_area", where, "cell_measures")
    fill = attribute(variable, "_FillValue")
    expect(fill is not None and np.asarray(fill).dtype == variable.dtype, where,
           "_FillValue is missing or of another type")
    variable.set_auto_mask(False)
    values = variable[:]
    variable.set_auto_mask(True)
    for name, outside in (("valid_min", np.less), ("valid_max", np.greater)):
        bound = attribute(variable, name)
        if bound is None:
            continue
        expect(np.asarray(bound).dtype == variable.dtype, where, name, "is of another type")
        beyond = np.count_nonzero(outside(values, bound) & (values != fill))
        expect(beyond == 0, where, beyond, "values beyond", name, bound)
    mapping = attribute(variable, "grid_mapping")
    on_planet = reference.is_latitude_longitude or reference.is_projected
    expect((mapping is not None) == on_planet, where, "grid_mapping is", mapping)
    if mapping is not None:
        crs = dataset[mapping]
        wanted = "lambert_azimuthal_equal_area" if reference.is_projected else "latitude_longitude"
        expect(attribute(crs, "grid_mapping_name") == wanted, where, "grid_mapping_name")
        expect(attribute(crs, "earth_radius") or attribute(crs, "inverse_flattening"), where,
               "grid mapping says no size")
    for coordinate in attribute(variable, "coordinates", "").split():
        expect(coordinate in dataset.variables, where, "coordinates names absent", coordinate)

    flags = attribute(variable, "flag_values")
    if flags is None:
        expect(attribute(variable, "units"), where, "units are missing")
        return
    meanings = attribute(variable, "flag_meanings", "").split()
    expect(np.asarray(flags).dtype == variable.dtype, where, "flag_values are of another type")
    expect(len(meanings) == np.size(flags), where, np.size(flags), "flags,", len(meanings), "meanings")
    expect(len(set(meanings)) == len(meanings), where, "flag_meanings repeat")
    expect(attribute(variable, "units") is None, where, "flags have no units")
    stray = set(np.unique(np.ma.compressed(variable[:]))) - set(np.atleast_1d(flags))
    expect(not stray, where, "values without a flag:", sorted(stray)[:5])


def check_areas(reference):
    dataset = reference.dataset
    if dataset.getncattr("terrane_grid") != "sphere" or "earth_radius" not in dataset["crs"].ncattrs():
        return
    radius = float(dataset["crs"].getncattr("earth_radius"))
    expect(close(reference.area.sum() / (4 * math.pi * radius**2), 1.0, 1e-12), reference.path.name,
           "cell areas do not add up to the sphere")


def check_projection(reference):
    """An island's latitudes and longitudes are those that PROJ makes of its coordinates and CRS."""
    if not reference.is_projected:
        return
    dataset, file = reference.dataset, reference.path.name
    expect(np.ptp(reference.area) <= 1e-9 * reference.area.max(), file, "cells are not of equal area")
    crs = dataset["crs"]
    wkt = attribute(crs, "crs_wkt")
    expect(wkt is not None, file, "crs_wkt is missing")
    if wkt is None or shutil.which("gdaltransform") is None:
        return
    asked.add("gdaltransform")
    x, y, lat, lon = (np.asarray(dataset[name][:]) for name in ("x", "y", "lat", "lon"))
    cells = [(j, i) for j in (0, len(y) // 3, len(y) - 1) for i in (0, len(x) // 2, len(x) - 1)]
    flattening = attribute(crs, "inverse_flattening")
    axis = attribute(crs, "semi_major_axis")
    figure = f"+a={axis} +rf={flattening}" if flattening else f"+R={attribute(crs, 'earth_radius')}"
    result = subprocess.run(
        ["gdaltransform", "-s_srs", wkt, "-t_srs", f"+proj=longlat {figure} +no_defs"],
        input="\n".join(f"{x[i]} {y[j]}" for j, i in cells), capture_output=True, text=True)
    expect(result.returncode == 0, file, "gdaltransform ->", result.stderr.strip()[:300])
    for (j, i), line in zip(cells, result.stdout.splitlines()):
        east, north = (float(word) for word in line.split()[:2])
        expect(abs(north - lat[j, i]) < 1e-7 and abs((east - lon[j, i] + 180) % 360 - 180) < 1e-7, file,
               "PROJ puts", (x[i], y[j]), "at", (north, east), "not", (lat[j, i], lon[j, i]))


def check_xarray(reference):
    try:
        import xarray
    except ImportError:
        return
    asked.add("xarray")
    with xarray.open_dataset(reference.path) as dataset:
        if reference.is_frame:
            expect(float(dataset["drift_time"][0]) == float(reference.dataset["drift_time"][0]),
                   reference.path.name, "xarray sees time", dataset["drift_time"].values)
        for name in reference.fields:
            where = f"{reference.path.name}: {name}: xarray"
            low, mean, high, missing = reference.summary(name)
            values = dataset[name].astype("f8")
            expect(close(values.min(), low), where, "min", float(values.min()), "not", low)
            expect(close(values.max(), high), where, "max", float(values.max()), "not", high)
            weighted = values.weighted(dataset["cell_area"]).mean()
            expect(close(weighted, mean), where, "mean", float(weighted), "not", mean)
            expect(int(values.isnull().sum()) == missing, where, "missing cells")
            expect(values.attrs.get("units") == attribute(reference.dataset[name], "units"), where,
                   "units", values.attrs.get("units"))
            wanted = {"lat", "lon"} if "lat" in reference.dataset.variables else {"x", "y"}
            wanted |= {"drift_time"} if reference.is_frame else set()
            expect(wanted <= set(values.coords), where, "coordinates are", sorted(values.coords))


def numbers_of(text):
    return [float(word) for word in text.split()]


def check_cdo(reference):
    names = reference.fields
    for operator, position in (("fldmin", 0), ("fldmean", 1), ("fldmax", 2)):
        output = call("cdo", "-s", "-L", "outputf,%.17g,1", f"-{operator}",
                      f"-selname,{','.join(names)}", reference.path)
        if output is None:
            return
        seen = numbers_of(output)
        expect(len(seen) == len(names), reference.path.name, "cdo sees", len(seen), "of", len(names))
        for name, value in zip(names, seen):
            expected = reference.summary(name)[position]
            expect(close(value, expected, 2e-5), f"{reference.path.name}: {name}: cdo", operator, value,
                   "not", expected)
    for name in names:
        units = attribute(reference.dataset[name], "units") or ""  # flags have none
        seen = call("cdo", "-s", "showunit", f"-selname,{name}", reference.path)
        expect(seen is not None and seen.strip() == units, f"{reference.path.name}: {name}:",
               "cdo sees units", seen)
    if reference.is_projected:
        remapped = reference.path.with_suffix(".remapped.nc")
        if call("cdo", "-s", "-O", "remapcon,r36x18", f"-selname,{names[0]}", reference.path,
                remapped) is not None:
            check_remapped(reference, names[0], remapped)
    description = call("cdo", "-s", "griddes", f"-selname,{names[0]}", reference.path) or ""
    kind = re.search(r"gridtype\s*=\s*(\w+)", description)
    plane = {"curvilinear"} if "lat" in reference.dataset.variables else {"generic", "projection"}
    if reference.is_frame:
        level = numbers_of(call("cdo", "-s", "showlevel", f"-selname,{names[0]}", reference.path) or "")
        expect(level == [float(reference.dataset["drift_time"][0])], reference.path.name, "cdo sees time", level)
    expect(kind and kind[1] in ({"lonlat"} if reference.is_latitude_longitude else plane),
           reference.path.name, "cdo sees a grid of type", kind and kind[1])


def check_remapped(reference, name, path):
    """A conservative remapping keeps the values' range."""
    low, _, high, _ = reference.summary(name)
    with netCDF4.Dataset(path) as dataset:
        values = np.ma.masked_invalid(dataset[name][:])
        expect(values.count() > 0, path.name, "nothing was remapped")
        if values.count():
            slack = 1e-5 * (high - low)
            expect(low - slack <= values.min() and values.max() <= high + slack, path.name, name,
                   "leaves its range by conservative remapping")
    path.unlink()


def check_nco(reference):
    if shutil.which("ncwa") is None:
        return
    output = reference.path.with_suffix(".nco.nc")
    for operation, position in (("min", 0), ("avg", 1), ("max", 2)):
        # CF variables that fields point to are left out, or they would be averaged as well.
        weights = ["-w", "cell_area"] if operation == "avg" else []
        if call("ncwa", "-O", "-C", "-h", "-y", operation, *weights, "-v",
                ",".join(reference.fields + ["cell_area"]), reference.path, output) is None:
            return
        with netCDF4.Dataset(output) as dataset:
            for name in reference.fields:
                # NCO averages integers as integers.
                if operation == "avg" and reference.dataset[name].dtype.kind != "f":
                    continue
                # NCO does not know NaN for a missing value in its extremes.
                if np.ma.is_masked(reference.values(name)) and reference.dataset[name].dtype.kind == "f":
                    continue
                expected = reference.summary(name)[position]
                seen = float(np.ma.filled(dataset[name][...], np.nan))
                expect(close(seen, expected, 2e-5), f"{reference.path.name}: {name}: ncwa", operation,
                       seen, "not", expected)
    output.unlink()
    call("ncks", "-m", reference.path)


def check_gdal(reference):
    import json
    # One field of each type, with and without gaps: GDAL opens the file anew for each.
    kinds = {}
    for name in reference.fields:
        gaps = bool(np.ma.is_masked(reference.values(name)))
        kinds.setdefault((reference.dataset[name].dtype, gaps), name)
    for name in kinds.values():
        where = f"{reference.path.name}: {name}: gdalinfo"
        output = call("gdalinfo", "-json", "-stats", "--config", "GDAL_PAM_ENABLED", "NO",
                      f'NETCDF:"{reference.path}":{name}')
        if output is None:
            return
        info = json.loads(re.sub(r"\bnan\b", "NaN", output))
        band = info["bands"][0]
        low, _, high, _ = reference.summary(name)
        expect(info["size"] == list(reversed(reference.area.shape)), where, "size", info["size"])
        expect(close(band["minimum"], low, 1e-3), where, "minimum", band["minimum"], "not", low)
        expect(close(band["maximum"], high, 1e-3), where, "maximum", band["maximum"], "not", high)
        # Row 0 lies in the south; GDAL turns it to the bottom and so the step southwards.
        if not reference.is_latitude_longitude:
            continue  # GDAL gives steps to map projections and latitude-longitude grids alone
        step = info["geoTransform"]
        expect(close(step[1], np.diff(reference.dataset["lon"][:2])[0]), where, "column step", step)
        expect(close(step[5], -np.diff(reference.dataset["lat"][:2])[0]), where, "row step", step)


def check_series(paths):
    """Frames put one behind another are a series along their time."""
    try:
        import xarray
    except ImportError:
        return
    frames = [path for path in paths if path.name.startswith("frame-")]
    if not frames:
        return
    with xarray.concat([xarray.open_dataset(path) for path in frames], "drift_time", data_vars="minimal",
                       coords="minimal", compat="override", combine_attrs="override") as series:
        expect(list(series["drift_time"].values) == [0.0, 250.0], "xarray: frames give the times",
               series["drift_time"].values)
        expect(series["crust_age"].dims == ("drift_time", "lat", "lon"), "xarray: frames give",
               series["crust_age"].dims)


def check_ncdump(reference):
    output = call("ncdump", "-h", reference.path)
    if output is None:
        return
    # Not through netCDF4, whose HDF5 keeps the file of texts beyond its end.
    text = subprocess.run(["ncdump", "-v", "terrane_config", reference.path], capture_output=True, text=True).stdout
    expect(" = " in text.rpartition("terrane_config =")[2], reference.path.name,
           "terrane_config is not the configuration")
    for name in reference.fields:
        expect(re.search(rf"\b{name}\((drift_time, )?\w+, \w+\)", output), f"{reference.path.name}: {name}: ncdump",
               "does not list it")


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--series":
        check_series(sorted(Path(sys.argv[2]).glob("frame-*.nc")))
        sys.exit(1 if failures else 0)
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    files = sorted(Path(sys.argv[1]).glob("*.nc"))
    if not files:
        sys.exit(f"{sys.argv[1]}: no NetCDF files")
    for path in files:
        reference = Reference(path)
        for check in (check_conventions, check_areas, check_anticlockwise, check_projection, check_xarray,
                      check_cdo, check_nco, check_gdal, check_ncdump):
            check(reference)
    # In a process of its own: HDF5 1.10 goes back to files of texts that are closed, and would crash here.
    series = subprocess.run([sys.executable, __file__, "--series", sys.argv[1]])
    expect(series.returncode == 0, "frames are no series")
    print(f"{len(files)} files, {len(failures)} failures; asked netCDF4, {', '.join(sorted(asked))}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
