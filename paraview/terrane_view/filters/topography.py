"""The solid surface with all fields, and the water on it."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkCleanPolyData, vtkClipPolyData

from .mesh import (
    HEIGHTS,
    Blocks,
    Tile,
    add_array,
    add_up,
    cell_array,
    cells_of,
    field,
    field_names,
    images_of,
    islands_of,
    latest,
    layout_of,
    polar_caps,
    quads,
    set_points,
    used_only,
)

POLES = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
OLDEST_FLOOR_MYR = 250.0
EDGES = (np.s_[0, :], np.s_[-1, :], np.s_[:, 0], np.s_[:, -1])


def heights_of(images, layout):
    """Elevation of the newest stage, 0 where no stage has made any."""
    heights = latest(images, HEIGHTS)
    return np.zeros((layout.ny, layout.nx), np.float32) if heights is None else heights


def pole_values(values):
    """What the points at the poles show: the mean of the ring around, of classes one of it."""
    rings = values[0], values[-1]
    if values.dtype.kind in "iu":
        return [ring[0] for ring in rings]
    return [ring.mean() for ring in rings]


def with_poles(values):
    """Values of all points of a closed surface."""
    return np.concatenate([values.ravel(), np.asarray(pole_values(values), values.dtype)])


def shown_fields(images):
    """Fields of all stages, each as the newest stage left it, and the age of ocean floor alone.

    Older crust at sea is stretched continent: subduction leaves no older floor.
    """
    fields = {}
    for image in images:
        for name in field_names(image):
            fields[name] = field(image, name)
    age, continent = fields.get("crust_age"), fields.get("continental_fraction")
    if age is not None and continent is not None:
        floor = (continent < 0.5) & (age <= OLDEST_FLOOR_MYR)
        fields["ocean_floor_age"] = np.where(floor, age, np.float32(np.nan))
    return fields


def make_topography(algorithm, stages=(), factor=1, draped=False, skirt_m=0.0):
    """Fills the output of a programmable filter with the solid surface.

    `topography` is the height to warp by, m. `skirt_m` draws the edges of a map down, as the sides of
    a block. What the inputs beyond `stages` cover, islands, is left out.
    """
    output = algorithm.GetOutput()
    images = images_of(algorithm, stages)
    layout = layout_of(images[0], draped)
    blocks = Blocks(layout, factor)
    fields = {name: blocks.thin(name, v) for name, v in shown_fields(images).items()}
    fields["topography"] = blocks.thin("elevation", heights_of(images, layout)).astype(np.float32)
    columns, rows = np.meshgrid(blocks.columns, blocks.rows)
    columns, rows, shape = columns.ravel(), rows.ravel(), blocks.shape
    if layout.wraps:
        base, up = layout.base(columns, rows), layout.up(columns, rows)
        base, up = np.concatenate([base, layout.radius_m * POLES]), np.concatenate([up, POLES])
        fields = {name: with_poles(values) for name, values in fields.items()}
        output.SetPolys(cells_of(quads(shape, True), polar_caps(shape)))
    else:
        if skirt_m > 0.0:
            columns, rows, fields, shape = with_skirt(blocks, fields, skirt_m)
        base, up = layout.base(columns, rows), layout.up(columns, rows)
        fields = {name: values.ravel() for name, values in fields.items()}
        output.SetPolys(cells_of(quads(shape, False)))
    set_points(output, base)
    for name, values in fields.items():
        add_array(output, name, values)
    add_up(output, up)
    output.GetPointData().SetActiveScalars("topography")
    for island in islands_of(algorithm, stages):
        cut_out(output, layout_of(island, draped=True))


def with_skirt(blocks, fields, depth_m):
    """The edge once more, lower."""
    columns, rows = np.meshgrid(np.pad(blocks.columns, 1, "edge"), np.pad(blocks.rows, 1, "edge"))
    fields = {name: np.pad(values, 1, "edge") for name, values in fields.items()}
    topography = fields["topography"]
    floor = topography[1:-1, 1:-1].min() - depth_m
    for edge in EDGES:
        topography[edge] = floor
    return columns.ravel(), rows.ravel(), fields, columns.shape


def cut_out(output, island):
    """Removes what an island covers. An island of unknown place covers nothing."""
    if not isinstance(island, Tile):
        return
    data = output.GetPointData()
    outside = island.distance_outside(vtk_to_numpy(data.GetNormals())).astype(np.float32)
    polys = output.GetPolys()
    corners = vtk_to_numpy(polys.GetConnectivityArray())
    starts = vtk_to_numpy(polys.GetOffsetsArray())[:-1]
    sizes = np.diff(vtk_to_numpy(polys.GetOffsetsArray()))
    least = np.minimum.reduceat(outside[corners], starts)
    most = np.maximum.reduceat(outside[corners], starts)

    def chosen(faces):
        kept = np.repeat(faces, sizes)
        return cell_array(np.append(0, np.cumsum(sizes[faces])), corners[kept])

    edge = vtkPolyData()
    edge.ShallowCopy(output)
    edge.SetPolys(chosen((least < 0.0) & (most > 0.0)))
    output.SetPolys(chosen(least >= 0.0))
    add_array(edge, "outside", outside)
    edge.GetPointData().SetActiveScalars("outside")
    few = vtkCleanPolyData()
    few.PointMergingOff()
    few.SetInputData(edge)
    clip = vtkClipPolyData()
    clip.SetInputConnection(few.GetOutputPort())
    clip.SetValue(0.0)
    both = vtkAppendPolyData()
    both.AddInputData(output)
    both.AddInputConnection(clip.GetOutputPort())
    both.Update()
    output.ShallowCopy(both.GetOutput())
    output.GetPointData().SetActiveScalars("topography")


def make_sea(algorithm, stages=(), factor=1, draped=False, names=(), sides=False):
    """Fills the output with the surface of the sea, wherever the ground is below 0.

    It has the fields of `names` that there are. With `sides` it reaches down to the ground along
    the edges of a map.
    """
    output = algorithm.GetOutput()
    images = images_of(algorithm, stages)
    layout = layout_of(images[0], draped)
    blocks = Blocks(layout, factor)
    ground = blocks.thin("elevation", heights_of(images, layout))
    known = shown_fields(images)
    fields = {name: blocks.thin(name, known[name]) for name in names if name in known}
    fields["topography"] = np.zeros(blocks.shape, np.float32)
    columns, rows, shape = blocks.columns, blocks.rows, blocks.shape
    if sides:
        columns, rows = np.pad(columns, 1, "edge"), np.pad(rows, 1, "edge")
        ground = np.pad(ground, 1, "edge")
        fields = {name: np.pad(values, 1, "edge") for name, values in fields.items()}
        for edge in EDGES:
            fields["topography"][edge] = np.minimum(ground[edge], 0.0)
        shape = ground.shape
    columns, rows = (axis.ravel() for axis in np.meshgrid(columns, rows))
    base, up = layout.base(columns, rows), layout.up(columns, rows)
    groups = [quads(shape, layout.wraps)]
    if layout.wraps:
        base, up = np.concatenate([base, layout.radius_m * POLES]), np.concatenate([up, POLES])
        ground = with_poles(ground)
        fields = {name: with_poles(values) for name, values in fields.items()}
        groups.append(polar_caps(shape))
    wet = ground.ravel() < 0.0
    set_points(output, base)
    output.SetPolys(cells_of(*(faces[wet[faces].any(axis=1)] for faces in groups)))
    for name, values in fields.items():
        add_array(output, name, values.ravel())
    add_up(output, up)
    output.GetPointData().SetActiveScalars("topography")


def make_lakes(algorithm, stages=(), factor=1, draped=False):
    """Fills the output with the surfaces of lakes, each level to its shore."""
    output = algorithm.GetOutput()
    images = images_of(algorithm, stages)
    lake_depth = latest(images, ["lake_depth"])
    if lake_depth is None:
        return
    layout = layout_of(images[0], draped)
    ground = heights_of(images, layout)
    wet = (lake_depth > 0.0) & (ground + lake_depth >= 0.0)
    level = np.where(wet, ground + lake_depth, -np.inf).ravel()
    faces = quads(wet.shape, layout.wraps)
    faces = faces[wet.ravel()[faces].any(axis=1)]
    if not len(faces):
        return
    # The shore takes the level of the lake: the land hides what reaches below it.
    shore = np.full(level.size, -np.inf)
    np.maximum.at(shore, faces.ravel(), np.repeat(level[faces].max(axis=1), 4))
    level = np.where(np.isfinite(level), level, shore)
    used, faces = used_only(faces)
    rows, columns = used // layout.nx, used % layout.nx
    topography = level[used]
    blocks = Blocks(layout, factor)
    if factor > 1:
        topography = np.maximum(topography, blocks.at(blocks.thin("elevation", ground), columns, rows))
    set_points(output, layout.base(columns, rows))
    output.SetPolys(cells_of(faces))
    add_array(output, "topography", topography.astype(np.float32))
    add_array(output, "lake_depth", lake_depth.ravel()[used])
    add_up(output, layout.up(columns, rows))
