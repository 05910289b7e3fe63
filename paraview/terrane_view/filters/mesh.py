"""Grids as surfaces: where cells lie in space, how they are thinned out, how faces join them.

A surface has a point at each cell's centre, so that values stay as they are in the files. Round a
planet the last column joins the first and a point at each pole closes the surface.
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

EARTH_RADIUS_M = 6371000.0
HEIGHTS = ("elevation", "crust_elevation")
LARGEST_COUNTS = ("drainage_area", "discharge", "river_intensity", "stream_order")


def unit_vectors(longitude, latitude):
    """Directions from the planet's centre; degrees."""
    longitude, latitude = np.radians(longitude), np.radians(latitude)
    across = np.cos(latitude)
    return np.stack(
        [across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1
    )


class Globe:
    """Rows are parallels, columns meridians. Columns and rows count cell centres."""

    def __init__(self, image, radius_m):
        (self.nx, self.ny), (self.west, self.south), (self.dx, self.dy) = extent_of(image)
        self.radius_m = radius_m
        self.wraps = abs(self.nx * self.dx - 360.0) < 1e-6
        self.size_m = 2.0 * radius_m

    def place(self, column, row):
        """Longitude and latitude, degrees."""
        return self.west + (column + 0.5) * self.dx, self.south + (row + 0.5) * self.dy

    def up(self, column, row):
        """Unit vectors away from the planet's centre."""
        return unit_vectors(*self.place(column, row))

    def base(self, column, row):
        """Positions at sea level, m."""
        return self.radius_m * self.up(column, row)

    def cell_m(self):
        """Length of a cell along a meridian."""
        return np.radians(self.dy) * self.radius_m

    def nearest(self, longitude, latitude):
        """Column and row of the cell at a place."""
        column = np.floor((longitude - self.west) / self.dx).astype(int) % self.nx
        row = np.floor((latitude - self.south) / self.dy).astype(int)
        return column, np.clip(row, 0, self.ny - 1)


class Plane:
    """A flat map in metres."""

    wraps = False

    def __init__(self, image):
        (self.nx, self.ny), (self.west, self.south), (self.dx, self.dy) = extent_of(image)
        self.size_m = self.nx * self.dx

    def up(self, column, _row):
        """Upwards is the third axis."""
        return np.tile([0.0, 0.0, 1.0], (len(column), 1))

    def base(self, column, row):
        """Positions at sea level, m."""
        x, y = self.west + (column + 0.5) * self.dx, self.south + (row + 0.5) * self.dy
        return np.stack([x, y, np.zeros_like(x)], axis=-1)

    def cell_m(self):
        """Length of a cell."""
        return self.dy


class Tile(Plane):
    """A map in Lambert's azimuthal equal-area projection, laid back on its planet.

    Snyder (1987), Map Projections: A Working Manual, eqs 20-14 to 20-18 and 24-2 to 24-4.
    """

    def __init__(self, image, radius_m, centre_deg):
        super().__init__(image)
        self.radius_m = radius_m
        self.set_centre(*centre_deg)

    def set_centre(self, latitude, longitude):
        """Turns the map's axes towards its centre, degrees."""
        self.out = unit_vectors(longitude, latitude)
        self.east = unit_vectors(longitude + 90.0, 0.0)
        self.north = np.cross(self.out, self.east)

    def up(self, column, row):
        """Unit vectors away from the planet's centre."""
        x, y, _ = (super().base(column, row) / self.radius_m).T
        squared = x * x + y * y
        side = np.sqrt(1.0 - 0.25 * squared)
        return (
            np.multiply.outer(1.0 - 0.5 * squared, self.out)
            + np.multiply.outer(side * x, self.east)
            + np.multiply.outer(side * y, self.north)
        )

    def base(self, column, row):
        """Positions at sea level, m."""
        return self.radius_m * self.up(column, row)

    def distance_outside(self, up):
        """Metres beyond the nearest edge of the map, negative on it."""
        towards = up @ self.out
        scale = self.radius_m * np.sqrt(2.0 / np.maximum(1.0 + towards, 1e-6))
        x = np.abs(scale * (up @ self.east)) - 0.5 * self.nx * self.dx
        y = np.abs(scale * (up @ self.north)) - 0.5 * self.ny * self.dy
        return np.where(towards > 0.0, np.maximum(x, y), self.radius_m)


def extent_of(image):
    """Cells, lower left corner and spacing of an image."""
    counts = [n - 1 for n in image.GetDimensions()[:2]]
    return counts, image.GetOrigin()[:2], image.GetSpacing()[:2]


def note_of(image, name):
    """Numbers that the file says about itself, or None."""
    array = image.GetFieldData().GetArray(name)
    return None if array is None else vtk_to_numpy(array).astype(float)


def layout_of(image, draped):
    """Where the cells of an image lie: on a globe, on a plane, or draped on a globe."""
    noted = note_of(image, "planet_radius_m")
    radius_m = EARTH_RADIUS_M if noted is None else noted[0]
    centre = note_of(image, "projection_centre_deg")
    if centre is not None:
        return Tile(image, radius_m, centre) if draped else Plane(image)
    (nx, ny), _, (dx, dy) = extent_of(image)
    return Globe(image, radius_m) if nx * dx <= 360.001 and ny * dy <= 180.001 else Plane(image)


def field(image, name):
    """Values of a field, row by row from the south, or None."""
    array = image.GetCellData().GetArray(name)
    if array is None:
        return None
    nx, ny = extent_of(image)[0]
    return vtk_to_numpy(array).reshape(ny, nx)


def field_names(image):
    """Names of all fields of an image."""
    data = image.GetCellData()
    return [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]


def latest(images, names):
    """Values of the first of `names` in the last image that has it, or None."""
    for image in reversed(images):
        for name in names:
            values = field(image, name)
            if values is not None:
                return values
    return None


class Blocks:
    """Blocks of `factor` by `factor` cells, which are shown as one point."""

    def __init__(self, layout, factor):
        self.layout, self.factor = layout, factor
        self.row_starts, self.rows = self.cut(layout.ny)
        self.column_starts, self.columns = self.cut(layout.nx)
        self.shape = len(self.rows), len(self.columns)

    def cut(self, count):
        """First cell and centre of each block of a row or column."""
        blocks = max(count // self.factor, 1)
        ends = np.arange(blocks + 1) * count // blocks
        return ends[:-1], 0.5 * (ends[:-1] + ends[1:] - 1)

    def reduce(self, function, values):
        """A ufunc over the cells of each block."""
        if self.is_even():  # cell by cell of all blocks, many times as fast
            shifts = range(self.factor)
            cells = [values[j :: self.factor, i :: self.factor] for j in shifts for i in shifts]
            total = cells[0].copy()
            for cell in cells[1:]:
                function(total, cell, out=total)
            return total
        return function.reduceat(
            function.reduceat(values, self.row_starts, axis=0), self.column_starts, axis=1
        )

    def is_even(self):
        """Whether all blocks have as many cells."""
        return self.layout.ny % self.factor == 0 and self.layout.nx % self.factor == 0

    def thin(self, name, values):
        """One value a block: of classes the middle one, of rivers the largest, else the mean."""
        if self.factor == 1:
            return values
        if values.dtype.kind in "iu":
            rows = self.row_starts + self.factor // 2
            return values[np.ix_(rows, self.column_starts + self.factor // 2)]
        if name in LARGEST_COUNTS:
            return self.reduce(np.maximum, values)
        if np.isfinite(values.sum()):
            count = (
                self.factor**2 if self.is_even() else self.reduce(np.add, np.ones_like(values))
            )
            return (self.reduce(np.add, values) / count).astype(values.dtype)
        known = np.isfinite(values)
        count = self.reduce(np.add, known.astype(np.int32))
        total = self.reduce(np.add, np.where(known, values, 0.0))
        with np.errstate(invalid="ignore", divide="ignore"):
            return (total / count).astype(values.dtype)

    def at(self, values, column, row):
        """Heights of the shown surface between its points.

        Faces of four points are drawn as two triangles, split along either diagonal: the higher.
        """
        x = np.interp(column, self.columns, np.arange(self.shape[1]))
        if self.layout.wraps:
            x = (np.asarray(column) + 0.5) * self.shape[1] / self.layout.nx - 0.5
        y = np.interp(row, self.rows, np.arange(self.shape[0]))
        left, below = np.floor(x).astype(int), np.floor(y).astype(int)
        s, t = x - left, y - below
        above = np.minimum(below + 1, self.shape[0] - 1)
        right = left + 1
        if self.layout.wraps:
            left, right = left % self.shape[1], right % self.shape[1]
        else:
            right = np.minimum(right, self.shape[1] - 1)
        a, b = values[below, left], values[below, right]
        c, d = values[above, right], values[above, left]
        rising = np.where(s > t, a + s * (b - a) + t * (c - b), a + t * (d - a) + s * (c - d))
        falling = np.where(
            s + t < 1.0,
            a + s * (b - a) + t * (d - a),
            c + (1.0 - s) * (d - c) + (1.0 - t) * (b - c),
        )
        return np.maximum(rising, falling)


def quads(shape, wraps):
    """Faces of four neighbouring points each, counter-clockwise from above."""
    ny, nx = shape
    columns = np.arange(nx if wraps else nx - 1)
    row = np.arange(ny - 1)[:, None] * nx
    left, right = row + columns, row + (columns + 1) % nx
    return np.stack([left, right, right + nx, left + nx], axis=-1).reshape(-1, 4)


def polar_caps(shape):
    """Triangles between the outermost rows and the points at the poles, which come last."""
    ny, nx = shape
    here = np.arange(nx)
    after = (here + 1) % nx
    south, north = np.full(nx, ny * nx), np.full(nx, ny * nx + 1)
    top = (ny - 1) * nx
    return np.concatenate(
        [np.stack([south, after, here], axis=-1), np.stack([north, here + top, after + top], -1)]
    )


def cell_array(offsets, corners):
    """A VTK cell array: cell i has the points corners[offsets[i]:offsets[i + 1]]."""
    cells = vtkCellArray()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.asarray(offsets, np.int64), deep=1),
        numpy_to_vtkIdTypeArray(np.asarray(corners, np.int64), deep=1),
    )
    return cells


def cells_of(*faces):
    """A VTK cell array of faces, each argument with as many corners a face as it has columns."""
    sizes = np.concatenate([np.full(len(f), f.shape[1]) for f in faces])
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    return cell_array(offsets, np.concatenate([f.ravel() for f in faces]))


def set_points(output, positions):
    """Gives a poly data set its points."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, dtype=np.float32), deep=1))
    output.SetPoints(points)


def add_array(output, name, values):
    """Adds values of points."""
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
    array.SetName(name)
    output.GetPointData().AddArray(array)


def add_up(output, up):
    """Adds the directions along which ParaView warps."""
    array = numpy_to_vtk(np.ascontiguousarray(up, dtype=np.float32), deep=1)
    array.SetName("Normals")
    output.GetPointData().SetNormals(array)


def used_only(faces):
    """The points that faces use, and the faces in their numbers."""
    used, numbers = np.unique(faces, return_inverse=True)
    return used, numbers.reshape(faces.shape)


def images_of(algorithm, stages):
    """The inputs whose stage is not after the time that is asked for, in order of stages.

    Without `stages` all inputs: frames choose themselves by time.
    """
    count = algorithm.GetNumberOfInputConnections(0)
    images = [algorithm.GetInputDataObject(0, i) for i in range(count)]
    if not stages:
        return images
    information = algorithm.GetOutputInformation(0)
    key = vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()
    time = information.Get(key) if information.Has(key) else max(stages)
    chosen = [image for image, stage in zip(images, stages) if stage <= time + 1e-6]
    return chosen or images[:1]


def islands_of(algorithm, stages):
    """Inputs beyond those of the planet's stages."""
    count = algorithm.GetNumberOfInputConnections(0)
    return [algorithm.GetInputDataObject(0, i) for i in range(len(stages), count)] if stages else []
