"""Chains of ParaView filters: one programmable filter that makes a shape, then stock ones.

Heights come in with the stock filter Warp By Scalar, so that anyone can change the exaggeration in
ParaView's own panel.
"""

from dataclasses import dataclass

from paraview import servermanager, simple

from .scripts import WHOLE_INPUTS, filter_script, times_script

RIVER = [0.16, 0.39, 0.62]
LAKE = [0.36, 0.58, 0.76]
INK = [0.13, 0.14, 0.17]


def read(reader, time=None):
    """The data set that a reader has read, without a look at the ranges of all its fields."""
    reader.UpdatePipeline(*([] if time is None else [time]))
    return reader.GetClientSideObject().GetOutputDataObject(0)


@dataclass
class Part:
    """One visible thing: what is shown, what its heights are multiplied by, and how it is shown."""

    shown: object
    warp: object = None
    display: object = None


@dataclass
class Source:
    """What the parts of one surface are made from: readers and how they are read."""

    inputs: list
    stages: tuple
    factor: int
    draped: bool = True
    islands: tuple = ()
    times: tuple = ()

    def shape(self, name, function, with_islands=False, **settings):
        """A programmable filter on the readers."""
        inputs = self.inputs + (list(self.islands) if with_islands else [])
        made = simple.ProgrammableFilter(registrationName=name, Input=inputs)
        made.OutputDataSetType = "vtkPolyData"
        if self.times:
            made.RequestInformationScript = times_script(self.times)
        made.RequestUpdateExtentScript = WHOLE_INPUTS
        made.Script = filter_script(
            function, stages=tuple(self.stages), factor=self.factor, **settings
        )
        return made

    def surface(self, name, function, **settings):
        """The same of a surface, which may lie on a plane."""
        return self.shape(name, function, draped=self.draped, **settings)


def raised(name, shape, scale):
    """The shape with its heights."""
    warp = simple.WarpByScalar(registrationName=name, Input=shape)
    warp.Scalars = ["POINTS", "topography"]
    warp.ScaleFactor = scale
    return warp


def smoothly_lit(name, surface):
    """A surface that light falls on without facets."""
    make = getattr(simple, "GenerateSurfaceNormals", None) or simple.SurfaceNormals
    normals = make(registrationName=name, Input=surface)
    normals.Splitting = 0
    normals.FeatureAngle = 180.0
    # Faces are counter-clockwise from above as they are made: to make sure would take seconds.
    normals.Consistency = 0
    return normals


def topography(source, prefix, scale, skirt_m=0.0):
    """The solid surface."""
    shape = source.surface(
        f"{prefix}surface", "make_topography", with_islands=bool(source.islands), skirt_m=skirt_m
    )
    warp = raised(f"{prefix}exaggeration", shape, scale)
    return Part(smoothly_lit(f"{prefix}topography", warp), warp)


def sea(source, prefix, fields, scale=None):
    """The sea at its level, with the fields that colour it too.

    With a `scale` it has sides down to the ground along its edges.
    """
    if scale is None:
        return Part(source.surface(f"{prefix}sea", "make_sea", names=fields))
    shape = source.surface(f"{prefix}water", "make_sea", names=fields, sides=True)
    warp = raised(f"{prefix}sea", shape, scale)
    return Part(warp, warp)


def lakes(source, prefix, scale):
    """Lakes at theirs."""
    warp = raised(f"{prefix}lakes", source.surface(f"{prefix}lake surfaces", "make_lakes"), scale)
    return Part(warp, warp)


def tube(name, line, radius_m, by_array=None):
    """Lines as thick as can be seen."""
    made = simple.Tube(registrationName=name, Input=line)
    made.NumberofSides = 6
    made.Capping = 1
    made.Radius = radius_m
    if by_array:
        made.Scalars = ["POINTS", by_array]
        made.VaryRadius = "By Absolute Scalar"
    return made


def rivers(source, prefix, scale, lines):
    """Rivers as wide as the root of their discharge; `lines` as in make_rivers."""
    shape = source.surface(f"{prefix}river lines", "make_rivers", lines=lines)
    warp = raised(f"{prefix}rivers on topography", shape, scale)
    return Part(tube(f"{prefix}rivers", warp, lines[1], "radius"), warp)


def boundaries(source, prefix, scale, radius_m):
    """Plate boundaries, coloured by type."""
    shape = source.shape(f"{prefix}boundary lines", "make_boundaries", lift_m=0.4 * radius_m)
    warp = raised(f"{prefix}boundaries on topography", shape, scale)
    return Part(tube(f"{prefix}boundaries", warp, radius_m), warp)


def arrows(source, prefix, scale, names, radius_m, per_unit_m):
    """Arrows along vectors, `per_unit_m` long for each unit."""
    shape = source.shape(
        f"{prefix}places of arrows", "make_arrows", lift_m=0.006 * radius_m, names=tuple(names)
    )
    warp = raised(f"{prefix}arrows on topography", shape, scale)
    glyph = simple.Glyph(registrationName=f"{prefix}arrows", Input=warp, GlyphType="Arrow")
    glyph.GlyphMode = "All Points"
    glyph.OrientationArray = ["POINTS", "vector"]
    glyph.ScaleArray = ["POINTS", "vector"]
    glyph.VectorScaleMode = "Scale by Magnitude"
    glyph.ScaleFactor = per_unit_m
    glyph.GlyphType.TipRadius = 0.14
    glyph.GlyphType.TipLength = 0.4
    glyph.GlyphType.ShaftRadius = 0.035
    return Part(glyph, warp)


def link_exaggeration(name, parts):
    """Makes the scale of all warps one: a change of any, also in ParaView's panel, changes all."""
    both = [servermanager.vtkSMLink.INPUT, servermanager.vtkSMLink.OUTPUT]
    link = servermanager.vtkSMPropertyLink()
    for part in parts:
        for direction in both:
            link.AddLinkedProperty(part.warp.SMProxy, "ScaleFactor", direction)
    servermanager.ProxyManager().RegisterLink(name, link)
    return link
