"""An island: in place on its planet, and as a block of its own."""

from paraview import simple

from . import colours, pipeline, scene
from .pipeline import LAKE, RIVER, Source, read


def size_of(reader):
    """Width and height of an island's map, m."""
    bounds = read(reader).GetBounds()
    return bounds[1] - bounds[0], bounds[3] - bounds[2]


def place_of(reader):
    """Latitude, longitude and width in m of an island, None where its file does not say."""
    centre = read(reader).GetFieldData().GetArray("projection_centre_deg")
    return None if centre is None else (centre.GetValue(0), centre.GetValue(1), size_of(reader)[0])


def drape(name, reader, scale):
    """Parts of an island where it lies on the globe."""
    source = Source([reader], (), factor=1, draped=True)
    width_m, _ = size_of(reader)
    prefix = f"{name} on globe: "
    return {
        f"{name} island topography": pipeline.topography(source, prefix, scale, skirt_m=2000.0),
        f"{name} rivers": pipeline.rivers(
            source, prefix, scale, (width_m / 30.0, width_m / 500.0, width_m / 4000.0)
        ),
        f"{name} lakes": pipeline.lakes(source, prefix, scale),
    }


class IslandView:
    """An island as a block: topography, sea, lakes and rivers in a view of its own."""

    def __init__(self, name, reader, exaggeration):
        self.name, self.reader = name, reader
        simple.CreateLayout(name)
        self.view = simple.CreateView("RenderView")
        simple.AssignViewToLayout(self.view)
        scene.prepare(self.view)
        width_m, height_m = size_of(reader)
        source = Source([reader], (), factor=1, draped=False)
        lines = (width_m / 30.0, width_m / 380.0, width_m / 4000.0)
        prefix = f"{name}: "
        self.parts = {
            "topography": pipeline.topography(source, prefix, exaggeration, skirt_m=1500.0),
            "sea": pipeline.sea(source, prefix, colours.PAINT_FOR_THE_SEA, exaggeration),
            "lakes": pipeline.lakes(source, prefix, exaggeration),
            "rivers": pipeline.rivers(source, prefix, exaggeration, lines),
        }
        warped = [part for part in self.parts.values() if part.warp]
        self.link = pipeline.link_exaggeration(f"exaggeration of {name}", warped)
        for part_name, part in self.parts.items():
            part.display = simple.Show(part.shown, self.view)
            part.display.SetRepresentationType("Surface")
            scene.lit(part.display)
            if part_name in ("lakes", "rivers"):
                scene.plain(part.display, LAKE if part_name == "lakes" else RIVER)
        self.bar = None
        self.words = scene.caption(self.view, self.parts["topography"].shown, "''", f"{name}: caption")
        self.colour("elevation")
        scene.look_obliquely(
            self.view, [0.0, 0.0, 0.0], [0, 0, 1], [0, 1, 0], max(width_m, height_m), 40.0
        )

    def colour(self, field):
        """Colours the island by a field."""
        topography, sea = self.parts["topography"], self.parts["sea"]
        topography.shown.UpdatePipeline()
        array = topography.shown.PointData.GetArray(field)
        simple.ColorBy(topography.display, ("POINTS", field))
        lut = colours.paint(field, array.GetRange())
        scene.fill_sea(sea.display, colours.look_of(field).sea, field)
        if self.bar:
            self.bar.Visibility = 0
        self.bar = scene.legend(self.view, lut, colours.title_of(field, ""))
        self.words.Expression = repr(f"{self.name}: {colours.words_of(field)}")
        return self

    def exaggerate(self, times):
        """Multiplies the island's heights."""
        for part in self.parts.values():
            if part.warp:
                part.warp.ScaleFactor = times
        return self

    def picture(self, path, size=(1600, 1200)):
        """Saves what the view shows."""
        scene.save(self.view, path, size)
        return self
