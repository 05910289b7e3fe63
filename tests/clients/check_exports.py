#!/usr/bin/python3
"""Opens what `terrane export` writes with the programs that people open it with.

usage: check_exports.py TERRANE STAGE_FILES FOLDER

STAGE_FILES is what make_client_files wrote; exports go to FOLDER. Each client is asked when it is
installed: Pillow (its own PNG reader), GDAL, zarr and xarray for Python, healpy, assimp. Where CI is
set all of them must be: scripts/install-deps --tests installs them. Prints one line per failure and
ends with 1 if there was any.
"""

import importlib
import json
import os
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np

from checking import expect, failures

CLIENTS = {"PIL.Image", "osgeo.gdal", "zarr", "xarray", "healpy", "assimp"}
asked = []


def module(name):
    """A client, or None where it is not installed."""
    try:
        found = importlib.import_module(name)
    except ImportError:
        return None
    asked.append(name)
    return found


def stage_values(path, name):
    """Of a field, rows from the north, NaN where it does not exist."""
    with netCDF4.Dataset(path) as file:
        values = np.ma.asarray(file[name][:], dtype="f8").filled(np.nan)
    return values[::-1]


class Exports:
    def __init__(self, program, stages, folder):
        self.program, self.stages, self.folder = program, stages, folder
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)

    def write(self, stage, output, *options):
        path = self.folder / output.replace("/", "-")
        result = subprocess.run(
            [self.program, "export", str(self.stages / f"{stage}.nc"), "-o", str(path), *options],
            capture_output=True, text=True)
        expect(result.returncode == 0, "export", stage, *options, "->", result.stderr.strip())
        for line in result.stdout.splitlines():
            expect(Path(line).exists(), "export", stage, *options, "names", line)
        return path


def png_samples(path):
    """16-bit samples by Pillow, which reads PNG by itself."""
    from PIL import Image
    Image.MAX_IMAGE_PIXELS = None
    with Image.open(path) as picture:
        return np.asarray(picture).astype("i8")


def read_samples(path, description):
    if path.suffix == ".png":
        return png_samples(path)
    return np.fromfile(path, "<u2").reshape(description["height"], description["width"]).astype("i8")


def check_whole(exports):
    """Every sample is within half a quantum of its cell."""
    for stage in ("sphere", "ellipsoid", "window", "island", "torus"):
        truth = stage_values(exports.stages / f"{stage}.nc", "elevation")
        for format, suffix in (("png16", "png"), ("r16", "r16")):
            path = exports.write(stage, f"{stage}.{suffix}", "--format", format)
            about = json.loads(path.with_suffix(".json").read_text())
            samples = read_samples(path, about)
            expect(samples.shape == truth.shape, path, samples.shape, truth.shape)
            values = about["offset"] + about["scale"] * samples
            gaps = np.isnan(truth)
            expect(np.all(samples[gaps] == 0) and (about["missing"] == 0) == gaps.any(), path, "gaps")
            worst = np.abs(values - truth)[~gaps].max()
            expect(worst <= 0.5 * about["scale"] * (1 + 1e-9), path, "is off by", worst)
            expect(samples[~gaps].max() == 65535, path, "does not use its range")


def check_gdal_png(exports):
    gdal = module("osgeo.gdal")
    if gdal is None:
        return
    gdal.UseExceptions()
    data = gdal.Open(str(exports.folder / "sphere.png"))
    band = data.GetRasterBand(1)
    expect(gdal.GetDataTypeName(band.DataType) == "UInt16", "PNG is", gdal.GetDataTypeName(band.DataType))
    expect(np.array_equal(band.ReadAsArray().astype("i8"), png_samples(exports.folder / "sphere.png")),
           "GDAL and Pillow disagree")


def check_masks(exports):
    path = exports.write("sphere", "masked.png", "--format", "png16", "--masks", "all")
    about = json.loads(path.with_suffix(".json").read_text())
    masks = {mask["name"]: mask for mask in about["masks"]}
    for name, field in (("rivers", "river_intensity"), ("slope", "slope"), ("lakes", "lake_depth"),
                        ("biomes", "biome"), ("wetness", None)):
        samples = png_samples(exports.folder / masks[name]["files"][0])
        expect(samples.max() <= 255 and samples.shape == (90, 180), name, "is no 8-bit layer")
        if field is None:
            continue
        truth = stage_values(exports.stages / "sphere.nc", field)
        there = ~np.isnan(truth)
        if name == "rivers":
            expect(np.abs(samples / 255 - truth)[there].max() <= 0.5 / 255 + 1e-6, name, "differs")
        elif name == "slope":
            expect(np.abs(samples * 90 / 255 - np.degrees(np.arctan(truth)))[there].max() <= 45 / 255 + 1e-4,
                   name, "differs")
        elif name == "lakes":
            expect(np.array_equal(samples[there] == 255, truth[there] > 0), name, "differs")
        else:
            expect(np.array_equal(samples[there], truth[there]), name, "differs")
            expect(np.all(samples[~there] == 255), name, "has no 255 where there is none")
    layers = [name for name in masks if name.startswith("biome-")]
    total = sum(png_samples(exports.folder / masks[name]["files"][0]) for name in layers)
    biome = stage_values(exports.stages / "sphere.nc", "biome")
    expect(np.array_equal(total, np.where(np.isnan(biome), 0, 255)), "layers of biomes do not add up")


def check_seams(what, size, tiles, wraps_east, wraps_north):
    """Each tile ends with the samples with which its neighbours begin."""
    across = 1 + max(x for x, _ in tiles)
    down = 1 + max(y for _, y in tiles)
    expect(len(tiles) == across * down and across > 1 and down > 1, what, "has", len(tiles), "tiles")
    for (x, y), tile in tiles.items():
        expect(tile.shape == (size, size), what, "tile of", tile.shape)
        right = (x + 1, y) if x + 1 < across else (0, y) if wraps_east else None
        below = (x, y + 1) if y + 1 < down else (x, 0) if wraps_north else None
        if right:
            expect(np.array_equal(tile[:, -1], tiles[right][:, 0]), what, "seam east of", x, y)
        if below:
            expect(np.array_equal(tile[-1], tiles[below][0]), what, "seam south of", x, y)


def check_tiles(exports):
    """Neighbours share their samples to the bit, also across the date line."""
    for stage, size in (("sphere", 33), ("island", 22), ("torus", 17)):
        path = exports.write(stage, f"{stage}-tiles.png", "--format", "png16", "--tiles", str(size),
                             "--masks", "biomes")
        about = json.loads(path.with_suffix(".json").read_text())
        places = [(entry["tile"]["x"], entry["tile"]["y"]) for entry in about["files"]]
        layers = {"heights": [entry["file"] for entry in about["files"]],
                  **{mask["name"]: mask["files"] for mask in about["masks"]}}
        expect(len(layers) > 1, stage, "has no masks")
        for name, files in layers.items():
            check_seams(f"{stage}, {name}:", size, {place: png_samples(exports.folder / file)
                                                    for place, file in zip(places, files, strict=True)},
                        wraps_east=stage != "island", wraps_north=stage == "torus")
        tiles = {place: png_samples(exports.folder / entry["file"]) for place, entry in zip(places, about["files"])}
        whole = stage_values(exports.stages / f"{stage}.nc", "elevation")
        if stage == "island":  # 63 x 31 steps are 3 x 21 and 31 -> 2 x 21: columns lie on cells
            values = about["offset"] + about["scale"] * tiles[0, 0][0]
            expect(np.abs(values - whole[0, :size]).max() <= 0.5 * about["scale"] * (1 + 1e-9), "row of cells")


def edges_of(face, entry):
    """Each edge of a face with the positions of its ends."""
    place = {key: (round(entry[key]["latitude"], 9), round(entry[key]["longitude"], 9) % 360)
             for key in ("top_left", "top_right", "bottom_left", "bottom_right")}
    return [(place["top_left"], place["top_right"], face[0]),
            (place["bottom_left"], place["bottom_right"], face[-1]),
            (place["top_left"], place["bottom_left"], face[:, 0]),
            (place["top_right"], place["bottom_right"], face[:, -1])]


def check_cube(exports):
    """All twelve edges of the cube are the same samples on both faces."""
    for options in ((), ("--tiles", "9")):
        path = exports.write("sphere", "cube.r16", "--format", "r16", "--layout", "cube", *options)
        about = json.loads(path.with_suffix(".json").read_text())
        faces = [np.fromfile(exports.folder / entry["file"], "<u2").reshape(about["height"], about["width"])
                 for entry in about["files"]]
        check_cube_edges("cube:", about, faces, whole=not options)
        if module("PIL.Image"):
            path = exports.write("sphere", "masked-cube.png", "--format", "png16", "--layout", "cube", "--masks", "all",
                                 *options)
            about = json.loads(path.with_suffix(".json").read_text())
            for mask in about["masks"]:
                faces = [png_samples(exports.folder / file) for file in mask["files"]]
                check_cube_edges(f"cube, {mask['name']}:", about, faces, whole=not options)
    truth = stage_values(exports.stages / "sphere.nc", "elevation")
    about = json.loads((exports.folder / "cube.json").read_text())
    expect(abs(about["min"] - np.nanmin(truth)) < 1e-3 and abs(about["max"] - np.nanmax(truth)) < 1e-3, "range of cube")


def check_cube_edges(what, about, faces, whole):
    """Each edge is there twice, with the same samples."""
    found = {}
    for entry, face in zip(about["files"], faces, strict=True):
        for start, end, samples in edges_of(face, entry):
            if end < start:
                start, end, samples = end, start, samples[::-1]
            found.setdefault((start, end), []).append(samples)
    if whole:
        expect(len(about["files"]) == 6 and len(found) == 12, what, len(found), "edges")
    for ends, both in found.items():
        expect(len(both) == 2 and np.array_equal(both[0], both[1]), what, "edge", ends, "is not shared")


def check_geotiff(exports):
    gdal = module("osgeo.gdal")
    if gdal is None:
        return
    from osgeo import osr
    try:
        from osgeo_utils.samples import validate_cloud_optimized_geotiff as cloud
    except ImportError:
        cloud = None
    gdal.UseExceptions()
    types = {"elevation": "Float32", "drainage_area": "Float64", "plate_id": "Int16", "lake_id": "Int32",
             "biome": "Byte", "crust_age": "Float32"}
    for stage in ("sphere", "ellipsoid", "window", "exports/large", "exports/projected"):
        for field, kind in types.items():
            path = exports.write(stage, f"{stage}-{field}.tif", "--format", "geotiff", "--field", field)
            data = gdal.Open(str(path))
            band = data.GetRasterBand(1)
            expect(gdal.GetDataTypeName(band.DataType) == kind, path, gdal.GetDataTypeName(band.DataType))
            values = band.ReadAsArray().astype("f8")
            none = band.GetNoDataValue()
            values[np.isnan(values) | (values == none)] = np.nan
            truth = stage_values(exports.stages / f"{stage}.nc", field)
            expect(np.array_equal(values, truth, equal_nan=True), path, "differs from the stage file")
            expect((none is not None), path, "has no nodata")
            colours = gdal.GetColorInterpretationName(band.GetColorInterpretation())
            expect(colours == ("Palette" if field == "biome" else "Gray"), path, "is", colours)
            expect(band.GetDescription() == field, path, "is described as", band.GetDescription())
            levels = 0
            while max(data.RasterXSize, data.RasterYSize) / 2 ** levels > 512:
                levels += 1
            expect(band.GetOverviewCount() == levels, path, "has", band.GetOverviewCount(), "overviews")
            system = osr.SpatialReference(data.GetProjection())
            with netCDF4.Dataset(exports.stages / f"{stage}.nc") as file:
                mapping = file["crs"]
                radius = getattr(mapping, "earth_radius", None) or mapping.semi_major_axis
            expect(abs(system.GetSemiMajor() - radius) < 1e-6, path, "radius", system.GetSemiMajor())
            if stage == "exports/projected":
                expect(system.GetAttrValue("PROJECTION") == "Lambert_Azimuthal_Equal_Area", path, data.GetProjection())
                with netCDF4.Dataset(exports.stages / f"{stage}.nc") as file:
                    west, step, _, north = *data.GetGeoTransform()[:3], data.GetGeoTransform()[3]
                    expect(abs(west + 0.5 * step - file["x"][0]) < 1e-6, path, "lies elsewhere")
            else:
                expect(system.IsGeographic(), path, data.GetProjection())
            if cloud is not None:
                warnings, errors, _ = cloud.validate(str(path), full_check=True)
                expect(not errors, path, "is not cloud-optimised:", errors)


def check_zarr(exports):
    zarr, xarray = module("zarr"), module("xarray")
    for stage in ("sphere", "window", "exports/projected", "torus"):
        path = exports.write(stage, f"{stage}.zarr", "--format", "zarr")
        if zarr is not None:
            for store in (zarr.open(str(path), "r"), zarr.open_consolidated(str(path))):
                with netCDF4.Dataset(exports.stages / f"{stage}.nc") as file:
                    file.set_auto_mask(False)
                    for name, variable in file.variables.items():
                        if variable.dtype is str:
                            continue
                        expect(np.array_equal(store[name][...], variable[...], equal_nan=True), path, name, "differs")
        if xarray is not None and zarr is not None:
            ours = xarray.open_zarr(path)
            theirs = xarray.open_dataset(exports.stages / f"{stage}.nc")
            for name in theirs.variables:
                if theirs[name].dtype == object:
                    continue
                expect(np.array_equal(ours[name].values, theirs[name].values, equal_nan=True), path, name)
                expect(ours[name].attrs.get("units") == theirs[name].attrs.get("units"), path, name, "units")
                expect(ours[name].dims == theirs[name].dims, path, name, ours[name].dims)
    path = exports.write("sphere", "one.zarr", "--format", "zarr", "--field", "slope")
    expect((path / "slope").exists() and not (path / "elevation").exists(), path, "holds other fields")


def check_healpix(exports):
    healpy = module("healpy")
    for stage in ("sphere", "ellipsoid"):
        path = exports.write(stage, f"{stage}-healpix.nc", "--format", "healpix", "--nside", "32")
        with netCDF4.Dataset(path) as file, netCDF4.Dataset(exports.stages / f"{stage}.nc") as source:
            expect(file["crs"].grid_mapping_name == "healpix" and file["crs"].refinement_level == 5, path, "mapping")
            area = np.asarray(source["cell_area"][:], dtype="f8")
            slope = np.asarray(source["slope"][:], dtype="f8")
            pixels = np.asarray(file["slope"][:], dtype="f8")
            expect(pixels.size == 12 * 32 ** 2, path, pixels.size)
            truth = (area * slope).sum() / area.sum()
            expect(abs(pixels.mean() - truth) < 1e-7 * slope.max(), path, "is not conservative:", pixels.mean() - truth)
            if healpy is None:
                continue
            lon, lat = healpy.pix2ang(32, np.arange(pixels.size), nest=True, lonlat=True)
            expect(np.abs(file["lon"][:] - lon).max() < 1e-9, path, "longitudes")
            if stage == "sphere":
                expect(np.abs(file["lat"][:] - lat).max() < 1e-9, path, "latitudes")
                # Cells of 2 degrees split into 32 x 32, each dropped into healpy's pixels with its area.
                edge = np.linspace(-90, 90, 2881)
                fine_lat, weight = 0.5 * (edge[1:] + edge[:-1]), np.diff(np.sin(np.radians(edge)))
                fine_lon = np.linspace(-180, 180, 5761)[:-1] + 0.03125
                row, column = ((fine_lat + 90) / 2).astype(int), ((fine_lon + 180) / 2).astype(int)
                total, count = np.zeros(pixels.size), np.zeros(pixels.size)
                for j in range(fine_lat.size):
                    where = healpy.ang2pix(32, fine_lon, np.full(fine_lon.size, fine_lat[j]), nest=True, lonlat=True)
                    total += weight[j] * np.bincount(where, slope[row[j], column], pixels.size)
                    count += weight[j] * np.bincount(where, minlength=pixels.size)
                worst = np.abs(total / count - pixels).max()
                spread = slope.max() - slope.min()
                expect(worst < 0.005 * spread, path, "differs from healpy's bins by", worst, "of", spread)
        store = exports.write(stage, f"{stage}-healpix.zarr", "--format", "healpix", "--nside", "32")
        xarray = module("xarray")
        if xarray is not None and module("zarr") is not None:
            expect(np.array_equal(xarray.open_zarr(store)["slope"].values, pixels.astype("f4")), store, "differs")


def read_glb(path):
    """A reader of glTF 2.0 binaries by the specification alone: JSON and arrays by name."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    expect(magic == b"glTF" and version == 2 and length == len(data), path, "header")
    size, kind = struct.unpack_from("<I4s", data, 12)
    expect(kind == b"JSON" and size % 4 == 0, path, "first chunk")
    scene = json.loads(data[20:20 + size])
    binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    expect(kind == b"BIN\0" and binary_size % 4 == 0, path, "second chunk")
    binary = data[28 + size:28 + size + binary_size]
    types = {5126: "<f4", 5125: "<u4"}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}

    def array(accessor):
        about = scene["accessors"][accessor]
        view = scene["bufferViews"][about["bufferView"]]
        start = view.get("byteOffset", 0) + about.get("byteOffset", 0)
        count = about["count"] * widths[about["type"]]
        expect(start % 4 == 0 and count * 4 <= view["byteLength"], path, "accessor", accessor)
        values = np.frombuffer(binary, types[about["componentType"]], count, start)
        return values.reshape(about["count"], -1)

    primitive = scene["meshes"][0]["primitives"][0]
    arrays = {name: array(accessor) for name, accessor in primitive["attributes"].items()}
    arrays["indices"] = array(primitive["indices"]).ravel()
    view = scene["bufferViews"][scene["images"][0]["bufferView"]]
    start = view.get("byteOffset", 0)
    arrays["picture"] = binary[start:start + view["byteLength"]]
    return scene, arrays


def check_glb(exports):
    import io
    for stage in ("sphere", "island"):
        path = exports.write(stage, f"{stage}.glb", "--format", "glb", "--exaggeration", "20")
        scene, arrays = read_glb(path)
        position, normal = arrays["POSITION"], arrays["NORMAL"]
        expect(arrays["indices"].max() < len(position), path, "indices")
        lengths = np.linalg.norm(normal, axis=1)
        expect(np.abs(lengths - 1).max() < 1e-5, path, "normals")
        accessor = scene["accessors"][scene["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
        expect(np.allclose(accessor["min"], position.min(0)) and np.allclose(accessor["max"], position.max(0)),
               path, "bounds")
        a, b, c = (position[arrays["indices"][k::3]].astype("f8") for k in range(3))
        face = np.cross(b - a, c - a)
        middle = (a + b + c) / 3
        truth = stage_values(exports.stages / f"{stage}.nc", "elevation")
        if stage == "sphere":
            radius = np.linalg.norm(position, axis=1)
            scale = 20 / 6371000.0
            expect(radius.min() >= 1 + scale * np.nanmin(truth) - 1e-6 and radius.max() <= 1 + scale * np.nanmax(truth) + 1e-6,
                   path, "radii", radius.min(), radius.max())
            solid = (face * middle).sum(1)
            expect(solid.min() > -1e-12, path, "faces look inwards")
            # A surface that closes has the same sum of face vectors as nothing at all.
            expect(np.abs(face.sum(0)).max() < 1e-6, path, "does not close", face.sum(0))
        else:
            expect(face[:, 1].min() > 0, path, "faces look down")
            expect(abs(position[:, 1].max() - np.nanmax(truth)) < 0.05 * (np.nanmax(truth) - np.nanmin(truth)), path, "heights")
        if module("PIL.Image"):
            from PIL import Image
            with Image.open(io.BytesIO(arrays["picture"])) as picture:
                expect(picture.size == truth.shape[::-1] and picture.mode == "RGB", path, picture.size)
        if shutil.which("assimp"):
            asked.append("assimp")
            said = subprocess.run(["assimp", "info", str(path)], capture_output=True, text=True)
            words = " ".join(said.stdout.split())
            expect(said.returncode == 0 and f"Faces: {len(arrays['indices']) // 3}" in words, path, said.stdout)


def main():
    exports = Exports(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
    if module("PIL.Image"):
        check_whole(exports)
        check_gdal_png(exports)
        check_masks(exports)
        check_tiles(exports)
    check_cube(exports)
    check_geotiff(exports)
    check_zarr(exports)
    check_healpix(exports)
    check_glb(exports)
    missing = CLIENTS - set(asked)
    expect(not (missing and os.environ.get("CI")), "CI lacks the clients", *sorted(missing))
    print("asked:", ", ".join(sorted(set(asked))))
    return 1 if failures else 0


sys.exit(main())
