"""Rivers, plate boundaries and arrows: what is drawn over the topography."""

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkStripper

from .mesh import (
    Blocks,
    add_array,
    add_up,
    cell_array,
    images_of,
    latest,
    layout_of,
    set_points,
)
from .topography import heights_of

ICE_DEG_C = -15.0
LEAST_WIDTH = 0.22
SOURCE_CELLS = 9


def draped_heights(images, layout, factor, columns, rows):
    """Heights of the shown surface, at sea and on lakes that of the water."""
    blocks = Blocks(layout, factor)
    ground = heights_of(images, layout)
    lakes = latest(images, ["lake_depth"])
    if lakes is not None:
        ground = ground + np.maximum(lakes, 0.0)
    shown = blocks.at(blocks.thin("elevation", ground), columns, rows)
    return np.maximum(shown, 0.0).astype(np.float32)


def chosen_rivers(images, layout, spacing_m):
    """Cells that are drawn as rivers: about one line every `spacing_m` of land.

    Ranked by (Q^2 A)^(1/3), as on the maps: by discharge alone wet lands would have all the lines,
    by area alone deserts as many. Ice sheets have none. The paths of a few cells on a plain, side
    by side, are no rivers.
    """
    discharge, area = latest(images, ["discharge"]), latest(images, ["drainage_area"])
    receiver = latest(images, ["flow_receiver"]).ravel()
    rank = np.cbrt(discharge.astype(float) ** 2 * area).ravel()
    rank[area.ravel() < SOURCE_CELLS * layout.cell_m() ** 2] = 0.0
    land = heights_of(images, layout).ravel() >= 0.0
    rank[~land | (receiver == np.arange(rank.size)) | (receiver < 0)] = 0.0
    temperature = latest(images, ["temperature"])
    if temperature is not None:
        rank[temperature.ravel() < ICE_DEG_C] = 0.0
    if not layout.wraps:
        # Along the edges of a map water follows the edge.
        cells = rank.reshape(layout.ny, layout.nx)
        for edge in (np.s_[:2, :], np.s_[-2:, :], np.s_[:, :2], np.s_[:, -2:]):
            cells[edge] = 0.0
    lakes = latest(images, ["lake_depth"])
    if lakes is not None:
        wet = lakes.ravel() > 0.0
        rank[wet & wet[np.maximum(receiver, 0)]] = 0.0
    width = np.ones(layout.ny)
    if layout.wraps:
        width = np.cos(np.radians(layout.place(0.0, np.arange(layout.ny))[1]))
    land_cells = float((land.reshape(layout.ny, -1).sum(axis=1) * width).sum())
    wanted = int(land_cells * layout.cell_m() / spacing_m)
    order = np.argsort(-rank, kind="stable")[:wanted]
    return order[rank[order] > 0.0]


def trace(chosen, receiver, nx, wraps):
    """Follows the chosen cells downstream: columns, rows, cells, first points, junctions.

    A line ends where it meets one that is there already; junctions are pairs of points, the end of
    a line and what it ends on. Columns run on beyond the date line; lines are cut at a pole.
    """
    is_chosen = np.zeros(receiver.size, bool)
    is_chosen[chosen] = True
    has_donor = np.zeros(receiver.size, bool)
    has_donor[receiver[chosen]] = True
    columns, cells, starts, junctions, point_of = [], [], [], [], {}
    for source in chosen[~has_donor[chosen]].tolist():
        starts.append(len(cells))
        here, column = source, source % nx
        while True:
            columns.append(column)
            cells.append(here)
            if here in point_of:
                junctions.append((len(cells) - 1, point_of[here]))
                break
            point_of[here] = len(cells) - 1
            if not is_chosen[here]:
                break
            there = int(receiver[here])
            step = there % nx - here % nx
            if wraps:
                step = (step + nx // 2) % nx - nx // 2
            if abs(step) > 1:
                break
            here, column = there, column + step
    return np.array(columns, float), np.array(cells, int), np.array(starts, int), junctions


def smooth(points, starts, junctions, passes=3):
    """Takes the stairs out of lines; sources and mouths stay where they are."""
    inside = np.ones(len(points), bool)
    inside[starts] = False
    inside[np.append(starts[1:], len(points)) - 1] = False
    inside = inside[1:-1, None]
    for _ in range(passes):
        middle = 0.25 * points[:-2] + 0.5 * points[1:-1] + 0.25 * points[2:]
        points[1:-1] = np.where(inside, middle, points[1:-1])
    for end, on in junctions:
        if abs(points[end, 0] - points[on, 0]) < 3.0:
            points[end] = points[on]


def make_rivers(algorithm, stages=(), factor=1, draped=False, lines=(1.0, 1.0, 1.0)):
    """Fills the output of a programmable filter with rivers as lines.

    `lines` are the spacing of rivers, the radius of the largest, and the lift above the ground, m.
    `radius` grows with the square root of the discharge, as widths of rivers do (Leopold & Maddock
    1953).
    """
    output = algorithm.GetOutput()
    images = images_of(algorithm, stages)
    if any(latest(images, [name]) is None for name in ("discharge", "flow_receiver")):
        return
    layout = layout_of(images[0], draped)
    spacing_m, widest_m, lift_m = lines
    chosen = chosen_rivers(images, layout, spacing_m)
    if not len(chosen):
        return
    receiver = latest(images, ["flow_receiver"]).ravel()
    columns, cells, starts, junctions = trace(chosen, receiver, layout.nx, layout.wraps)
    points = np.stack([columns, (cells // layout.nx).astype(float)], axis=-1)
    smooth(points, starts, junctions)
    columns, rows = points.T
    discharge = latest(images, ["discharge"]).ravel()[cells].astype(float)
    # A mouth at sea has the river's flow, not the sea's.
    ends = np.append(starts[1:], len(cells)) - 1
    discharge[ends] = np.maximum(discharge[ends], discharge[np.maximum(ends - 1, 0)])
    share = np.sqrt(np.maximum(discharge, 0.0) / discharge.max())
    up = layout.up(columns, rows)
    set_points(output, layout.base(columns, rows) + lift_m * up)
    output.SetLines(cell_array(np.append(starts, len(cells)), np.arange(len(cells))))
    add_array(output, "topography", draped_heights(images, layout, factor, columns, rows))
    add_array(output, "discharge", discharge.astype(np.float32))
    add_array(output, "radius", (widest_m * np.maximum(share, LEAST_WIDTH)).astype(np.float32))
    add_up(output, up)
    output.GetPointData().SetActiveScalars("radius")


def boundary_edges(plate, kind, strength):
    """Sides of cells between two plates: their corners, and what the plates do there.

    Corner (column, row) is the lower left one of a cell; its number is row * nx + column. Where the
    two sides differ the stronger one counts.
    """
    ny, nx = plate.shape
    corners, kinds = [], []
    for shift, axis in ((1, 1), (1, 0)):
        other = np.roll(plate, shift, axis)
        differs = plate != other
        if axis == 0:
            differs[0, :] = False
        rows, columns = np.nonzero(differs)
        first = rows * nx + columns
        second = first + nx if axis == 1 else rows * nx + (columns + 1) % nx
        corners.append(np.stack([first, second], axis=-1))
        a, b = kind[differs], np.roll(kind, shift, axis)[differs]
        stronger = strength[differs] >= np.roll(strength, shift, axis)[differs]
        kinds.append(np.where(a == 0, b, np.where((b == 0) | stronger, a, b)))
    return np.concatenate(corners), np.concatenate(kinds)


def smooth_network(places, edges, passes=4):
    """Takes the stairs out of a network of lines on the unit sphere."""
    count = np.bincount(edges.ravel(), minlength=len(places))[:, None]
    for _ in range(passes):
        total = np.zeros_like(places)
        np.add.at(total, edges[:, 0], places[edges[:, 1]])
        np.add.at(total, edges[:, 1], places[edges[:, 0]])
        places = 0.5 * places + 0.5 * total / np.maximum(count, 1)
        places /= np.linalg.norm(places, axis=1)[:, None]
    return places


def joined(points, edges):
    """Short lines joined to long ones."""
    lines = vtkPolyData()
    used, numbers = np.unique(edges, return_inverse=True)
    set_points(lines, points[used])
    lines.SetLines(cell_array(2 * np.arange(len(edges) + 1), numbers.ravel()))
    stripper = vtkStripper()
    stripper.SetInputData(lines)
    stripper.SetMaximumLength(100000)
    stripper.Update()
    return stripper.GetOutput(), used


def make_boundaries(algorithm, stages=(), factor=1, lift_m=0.0):
    """Fills the output with plate boundaries as lines that know their type."""
    output = algorithm.GetOutput()
    images = images_of(algorithm, stages)
    names = ("plate_id", "boundary_type", "boundary_strength")
    plate, kind, strength = (latest(images, [name]) for name in names)
    layout = layout_of(images[0], draped=True)
    if plate is None or kind is None or not layout.wraps:
        return
    if strength is None:
        strength = np.zeros(plate.shape)
    edges, kinds = boundary_edges(plate, kind, strength)
    if not len(edges):
        return
    used, numbers = np.unique(edges, return_inverse=True)
    edges = numbers.reshape(edges.shape)
    rows = used // layout.nx
    up = smooth_network(layout.up(used % layout.nx - 0.5, rows - 0.5), edges)
    longitude = np.degrees(np.arctan2(up[:, 1], up[:, 0]))
    latitude = np.degrees(np.arcsin(np.clip(up[:, 2], -1.0, 1.0)))
    columns = ((longitude - layout.west) % 360.0) / layout.dx - 0.5
    heights = draped_heights(images, layout, factor, columns, (latitude - layout.south) / layout.dy)
    append = vtkAppendPolyData()
    for value in np.unique(kinds):
        lines, kept = joined((layout.radius_m + lift_m) * up, edges[kinds == value])
        add_array(lines, "topography", heights[kept])
        add_array(lines, "boundary_type", np.full(len(kept), value, np.int8))
        add_up(lines, up[kept])
        append.AddInputData(lines)
    append.Update()
    output.ShallowCopy(append.GetOutput())
    output.GetPointData().SetActiveScalars("topography")


def even_places(count):
    """Longitudes and latitudes of points of a Fibonacci lattice on the sphere."""
    i = np.arange(count)
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    longitude = (360.0 * i / golden) % 360.0 - 180.0
    return longitude, np.degrees(np.arcsin((2.0 * i + 1.0) / count - 1.0))


def make_arrows(algorithm, stages=(), factor=1, lift_m=0.0, names=(), count=450):
    """Fills the output with points spread evenly that know the vector there."""
    output = algorithm.GetOutput()
    images = images_of(algorithm, stages)
    east, north = (latest(images, [name]) for name in names)
    layout = layout_of(images[0], draped=True)
    if east is None or north is None or not layout.wraps:
        return
    longitude, latitude = even_places(count)
    columns, rows = layout.nearest(longitude, latitude)
    up = layout.up(columns, rows)
    eastward = np.stack([-up[:, 1], up[:, 0], np.zeros(count)], axis=-1)
    eastward /= np.linalg.norm(eastward, axis=1)[:, None]
    northward = np.cross(up, eastward)
    vectors = east[rows, columns][:, None] * eastward + north[rows, columns][:, None] * northward
    set_points(output, (layout.radius_m + lift_m) * up)
    points = np.arange(count)
    output.SetVerts(cell_array(np.arange(count + 1), points))
    add_array(output, "topography", draped_heights(images, layout, factor, columns, rows))
    add_array(output, "vector", vectors.astype(np.float32))
    add_up(output, up)
    output.GetPointData().SetActiveScalars("topography")
