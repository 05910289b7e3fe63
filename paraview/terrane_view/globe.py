"""The globe of a run: its parts, and what can be changed about them."""

import math
from pathlib import Path

from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from . import colours, pipeline, scene
from .island import IslandView, drape, place_of
from .pipeline import INK, LAKE, RIVER, Source, read
from .run import Run, RunError

EARTH_RADIUS_M = 6371000.0
CELLS_SHOWN = 800_000
ARROWS = {
    "plates": (("plate_velocity_east", "plate_velocity_north"), 0.13 / 100.0),
    "wind": (("wind_east", "wind_north"), 0.15 / 10.0),
}
PARTS = ("topography", "sea", "lakes", "rivers", "boundaries", "plates", "wind", "island")
SHOWN_FIRST = ("topography", "sea", "lakes", "rivers", "island")


class Globe:
    """The globe of the run in `folder`, in the active view.

    With `drift` the time is millions of years and the globe shows the frames of drifting plates;
    else the time is the number of a stage, and ParaView's player switches stages. A planet of more
    than `cells` cells is shown by means over blocks of cells.
    """

    def __init__(self, folder, drift=False, cells=CELLS_SHOWN, exaggeration=15.0, view=None):
        self.run, self.drift = Run(folder), drift
        self.view = view or simple.GetActiveViewOrCreate("RenderView")
        scene.clear(self.view)
        scene.prepare(self.view)
        self.scale = exaggeration
        self.island_views = {}
        source = self.frames(cells) if drift else self.stages(cells)
        self.source = source
        self.parts = self.make_parts(source)
        warped = [part for part in self.parts.values() if part.warp]
        self.go_to(self.times[-1])
        self.link = pipeline.link_exaggeration(f"exaggeration of {self.run.folder.name}", warped)
        self.field, self.bars = None, []
        self.words = scene.caption(self.view, self.parts["topography"].shown, self.caption(), "caption")
        self.show_all()
        self.colour("elevation")
        self.look()
        simple.SetActiveSource(self.parts["topography"].shown)

    # Sources -----------------------------------------------------------------------------------

    def stages(self, cells):
        """Readers of all stages and islands."""
        readers = [open_image(name, path) for name, path in self.run.stages.items()]
        self.islands = {name: open_image(name, path) for name, path in self.run.islands.items()}
        numbers = tuple(self.run.number(name) for name in self.run.stages)
        factor = self.choose_factor(readers[0], cells)
        islands = tuple(self.islands.values())
        return Source(readers, numbers, factor, islands=islands, times=numbers)

    def frames(self, cells):
        """A reader of the frames of drift."""
        if self.run.frames is None:
            raise RunError(
                f"{self.run.folder}: no frames of drifting plates; run with --preset sphere "
                "--set plates.sphere.frames_myr=10"
            )
        self.islands = {}
        reader = simple.PVDReader(registrationName="drift", FileName=str(self.run.frames))
        return Source([reader], (), self.choose_factor(reader, cells))

    def choose_factor(self, reader, cells):
        """How many cells a side are shown as one; notes the size of grid and planet."""
        image = read(reader)
        noted = image.GetFieldData().GetArray("planet_radius_m")
        self.radius_m = noted.GetValue(0) if noted else EARTH_RADIUS_M
        self.columns, self.rows = (points - 1 for points in image.GetDimensions()[:2])
        return max(1, math.ceil(math.sqrt(self.columns * self.rows / cells) - 1e-9))

    # Parts -------------------------------------------------------------------------------------

    def make_parts(self, source):
        """Everything that can be shown on the globe."""
        scale, radius_m = self.scale, self.radius_m
        detail = radius_m / 1000.0
        parts = {
            "topography": pipeline.topography(source, "", scale),
            "sea": pipeline.sea(source, "", colours.PAINT_FOR_THE_SEA),
        }
        parts["boundaries"] = pipeline.boundaries(source, "", scale, 3.2 * detail)
        names, per_unit = ARROWS["plates"]
        per_unit *= radius_m
        parts["plates"] = pipeline.arrows(source, "plate ", scale, names, radius_m, per_unit)
        if self.drift:
            return parts
        parts["lakes"] = pipeline.lakes(source, "", scale)
        lines = (23.5 * detail, 4.5 * detail, 1.2 * detail)
        parts["rivers"] = pipeline.rivers(source, "", scale, lines)
        names, per_unit = ARROWS["wind"]
        per_unit *= radius_m
        parts["wind"] = pipeline.arrows(source, "wind ", scale, names, radius_m, per_unit)
        for name, reader in self.islands.items():
            parts.update(drape(name, reader, scale))
        return parts

    def show_all(self):
        """Shows what a globe begins with."""
        colours_of = {"lakes": LAKE, "rivers": RIVER, "plates": INK, "wind": INK}
        for name, part in self.parts.items():
            part.display = simple.Show(part.shown, self.view)
            part.display.SetRepresentationType("Surface")
            scene.lit(part.display)
            kind = name.split(" ")[-1]
            if kind in colours_of:
                scene.plain(part.display, colours_of[kind])
            visible = kind in SHOWN_FIRST or name.startswith("island")
            part.display.Visibility = int(visible)
        self.parts["boundaries"].display.Ambient = 0.5
        self.colour_boundaries()

    def colour_boundaries(self):
        """Boundaries by their type."""
        display = self.parts["boundaries"].display
        simple.ColorBy(display, ("POINTS", "boundary_type"))
        colours.paint("boundary_type", (0, 3))

    def explain_boundaries(self):
        """A key of the boundaries' colours while they are shown."""
        if self.field == "boundary_type":
            return
        lut = simple.GetColorTransferFunction("boundary_type")
        bar = scene.small_legend(self.view, lut, "Plate boundaries")
        bar.Visibility = int(self.parts["boundaries"].display.Visibility)

    def caption(self):
        """Says which stage or which time is shown, and of which field."""
        who = f"seed {self.run.seed}" if self.run.seed is not None else self.run.folder.name
        what = colours.words_of(self.field) if self.field else "bare"
        if self.drift:
            return f"'{who}, {what} after %g Myr' % time_value"
        # ParaView keeps braces for itself.
        names = [(self.run.number(name), f"{who}, {what} after {name}") for name in self.run.stages]
        return f"dict({names!r}).get(int(time_value + 0.5), '')"

    # What can be changed -----------------------------------------------------------------------

    def fields(self):
        """Names of the fields that can be shown at the present stage."""
        self.parts["topography"].shown.UpdatePipeline(self.time)
        data = self.parts["topography"].shown.PointData
        return sorted(a for a in data.keys() if a not in ("topography", "Normals", "outside"))

    def colour(self, field):
        """Colours the globe and its islands by a field."""
        known = self.fields()
        if field == "elevation" and field not in known:
            # Before there is topography there may be that of the plates' history, or plates alone.
            field = "crust_elevation" if "crust_elevation" in known else "plate_id"
        if field not in known:
            raise RunError(f"{field}: no field of this stage; there are {', '.join(known)}")
        topography = self.parts["topography"]
        array = topography.shown.PointData.GetArray(field)
        for name, part in self.parts.items():
            if name == "topography" or name.endswith("island topography"):
                here = part.shown.PointData.GetArray(field) is not None or part is topography
                self.show_field(part, field if here else "elevation")
        self.field = field
        lut = colours.paint(field, array.GetRange() if array else (0.0, 1.0))
        if field == "plate_id":
            colours.paint_plates(lut, self.plates_of_cells())
        scene.fill_sea(self.parts["sea"].display, colours.look_of(field).sea, field)
        for other in self.bars:
            other.Visibility = 0
        title = colours.title_of(field, self.run.units(field))
        self.bars = [scene.legend(self.view, lut, title)]
        self.words.Expression = self.caption()
        self.explain_boundaries()
        return self

    def plates_of_cells(self):
        """Plate of each cell, row by row, at the present time."""
        image = read(self.source.inputs[0], self.time)
        return vtk_to_numpy(image.GetCellData().GetArray("plate_id")).reshape(self.rows, -1)

    @staticmethod
    def show_field(part, field):
        """Colours one surface."""
        simple.ColorBy(part.display, ("POINTS", field))
        part.display.SetScalarBarVisibility(simple.GetActiveView(), False)

    def exaggerate(self, times):
        """Multiplies heights on the globe."""
        self.scale = times
        for part in self.parts.values():
            if part.warp:
                part.warp.ScaleFactor = times
        return self

    @property
    def time(self):
        """Number of the stage, or millions of years."""
        return simple.GetAnimationScene().AnimationTime

    @property
    def times(self):
        """All times that there are."""
        known = self.source.inputs[0].TimestepValues if self.drift else self.source.times
        return [float(time) for time in (known if hasattr(known, "__len__") else [known])]

    def go_to(self, time):
        """Shows a time: the number of a stage, or millions of years."""
        scene_of_time = simple.GetAnimationScene()
        scene_of_time.UpdateAnimationUsingDataTimeSteps()
        scene_of_time.AnimationTime = time
        self.view.ViewTime = time
        return self

    def stage(self, name):
        """Shows the planet after a stage."""
        if name not in self.run.stages:
            raise RunError(f"{name}: no stage of this run; there are {', '.join(self.run.stages)}")
        self.go_to(self.run.number(name))
        if self.field not in self.fields():
            self.colour("elevation")
        return self

    def show(self, *names, visible=True):
        """Shows parts: topography, sea, lakes, rivers, boundaries, plates or wind (arrows), island."""
        for name in names:
            found = [p for n, p in self.parts.items() if n == name or n.startswith(f"{name} ")]
            if not found:
                raise RunError(f"{name}: no part of this globe; there are {', '.join(PARTS)}")
            for part in found:
                part.display.Visibility = int(visible)
        self.explain_boundaries()
        return self

    def hide(self, *names):
        """Hides parts."""
        return self.show(*names, visible=False)

    def look(self, latitude=20.0, longitude=0.0, nearness=1.0):
        """Turns the globe, north up."""
        scene.look_at_globe(self.view, latitude, longitude, self.radius_m, nearness)
        return self

    def look_at_island(self, name="island", tilt=50.0):
        """Looks at an island where it lies on the globe, from the south, `tilt` degrees steep."""
        place = place_of(self.reader_of(name))
        if place is None:
            raise RunError(f"{name}: its files do not say where it lies; make the run again")
        latitude, longitude, width_m = place
        # The planet's rivers are as wide as its largest islands: here the island has its own.
        self.parts["rivers"].display.Visibility = 0
        scene.look_at_place(self.view, latitude, longitude, self.radius_m, width_m, tilt)
        return self

    def reader_of(self, name):
        """The reader of an island."""
        if name not in self.islands:
            known = ", ".join(self.islands) or "none"
            raise RunError(f"{name}: no island of this run; there are: {known}")
        return self.islands[name]

    def island_view(self, name="island", exaggeration=6.0):
        """The island as a block of its own, in a new view."""
        self.island_views[name] = IslandView(name, self.reader_of(name), exaggeration)
        return self.island_views[name]

    def status(self):
        """What is shown, in words."""
        shown = f"{self.columns} x {self.rows} cells"
        if self.source.factor > 1:
            n = self.source.factor
            shown += (
                f", shown as {self.columns // n} x {self.rows // n} means over {n} x {n} cells "
                "(rivers and boundaries are traced on all; cells=N shows more)"
            )
        times = "Myr of drift" if self.drift else "stages"
        return (
            f"{self.run.folder}: {shown}; heights x {self.scale:g}; "
            f"times are {times}: {', '.join(f'{t:g}' for t in self.times)}"
        )

    # Files -------------------------------------------------------------------------------------

    def picture(self, path, size=(1600, 1200)):
        """Saves what the view shows."""
        scene.save(self.view, path, size)
        return self

    def movie(self, folder, size=(1280, 960)):
        """Saves a picture of every time: frame-000.png and so on."""
        Path(folder).mkdir(parents=True, exist_ok=True)
        for number, time in enumerate(self.times):
            self.go_to(time)
            self.picture(Path(folder) / f"frame-{number:03d}.png", size)
        return self

    def save_state(self, path):
        """Saves a state file for ParaView."""
        simple.SaveState(str(path))
        return self


def open_image(name, path):
    """A reader of one stage."""
    return simple.XMLImageDataReader(registrationName=name, FileName=[str(path)])
