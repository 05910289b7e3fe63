"""Shows a run as a globe with paraview/terrane_view and looks at what comes out.

usage: xvfb-run -a -s '-screen 0 1280x1024x24' pvbatch paraview_globe_check.py FOLDER SCRATCH PART

PART is one of surfaces, stages, state (after stages), thinning, drift; pictures go to SCRATCH.

The ranges of all fields on the globe must be those that netCDF4 for Python sees in the files; no
picture may be blank or of one colour; the closed surfaces of `output.globe` must have no open edge;
a saved state must show the same picture again. Ends with 1 on any failure.
"""

import os
import sys
from pathlib import Path

import numpy as np
from netCDF4 import Dataset
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkIOImage import vtkPNGReader

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "paraview")]
from checking import close, expect, failures  # noqa: E402
from terrane_view import Globe  # noqa: E402

SIZE = (640, 480)


def pixels(path):
    """Red, green and blue of a picture."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return values.reshape(-1, values.shape[-1])[:, :3]


def check_picture(path):
    """A picture shows something, in more than one colour, on paper."""
    values = pixels(path)
    drawn = np.any(values < 250, axis=1)
    share = drawn.mean()
    expect(share > 0.15, path.name, "is drawn on a share of", share)
    colours = np.unique(values[drawn] // 16, axis=0) if drawn.any() else []
    expect(len(colours) > 24, path.name, "has only", len(colours), "colours")
    expect(values[drawn].std() > 8.0, path.name, "has no contrast")
    return values


def take(shown, folder, name):
    """A picture, looked at."""
    path = folder / f"{name}.png"
    shown.picture(path, SIZE)
    return check_picture(path)


def ranges_of_files(globe):
    """Lowest and highest value of each field, of the last stage that wrote it."""
    ranges = {}
    for path in globe.run.stages.values():
        with Dataset(path.with_suffix(".nc")) as dataset:
            dataset.set_auto_mask(False)
            for name, variable in dataset.variables.items():
                if "cell_measures" in variable.ncattrs():
                    values = np.asarray(variable[:])
                    ranges[name] = float(np.nanmin(values)), float(np.nanmax(values))
    return ranges


def check_ranges(globe):
    """Every field of every file is on the globe with its range, or within it on a large planet, of
    which the globe shows every second, third... cell."""
    is_small = globe.columns * globe.rows < 500_000
    expect(not is_small or globe.source.factor == 1, "a small planet is thinned out by",
           globe.source.factor)
    surface = globe.parts["topography"].warp.Input
    surface.UpdatePipeline(globe.time)
    for name, (low, high) in ranges_of_files(globe).items():
        array = surface.PointData.GetArray(name)
        if array is None:
            expect(False, "the globe lacks", name)
            continue
        seen = array.GetRange()
        # Where an island is cut out of the globe, its values are not there.
        inside = seen[0] >= low - 1e-5 * abs(low) and seen[1] <= high + 1e-5 * abs(high)
        same = close(seen[0], low) and close(seen[1], high)
        in_part = globe.islands or globe.source.factor > 1
        expect(inside if in_part else same, name, "ranges over", seen, "not", (low, high))


def open_edges(source):
    """Edges of a surface that have not two faces."""
    source.UpdatePipeline()
    edges = vtkFeatureEdges()
    edges.SetInputData(source.GetClientSideObject().GetOutput())
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.BoundaryEdgesOn()
    edges.NonManifoldEdgesOn()
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def check_surfaces(folder, _pictures):
    """The files of output.globe are closed and hold what the NetCDF files hold."""
    for path in sorted(folder.glob("[0-9][0-9]-*.vtp")):
        reader = simple.XMLPolyDataReader(FileName=[str(path)])
        expect(open_edges(reader) == 0, path.name, "has", open_edges(reader), "open edges")
        with Dataset(path.with_suffix(".nc")) as dataset:
            dataset.set_auto_mask(False)
            for name, variable in dataset.variables.items():
                if "cell_measures" not in variable.ncattrs():
                    continue
                values, array = np.asarray(variable[:]), reader.CellData.GetArray(name)
                if array is None:
                    expect(False, path.name, "lacks", name)
                    continue
                seen, known = array.GetRange(), (np.nanmin(values), np.nanmax(values))
                expect(
                    close(seen[0], known[0]) and close(seen[1], known[1]),
                    path.name,
                    name,
                    "ranges over",
                    seen,
                    "not",
                    known,
                )
        simple.Delete(reader)


def check_stages(folder, pictures):
    """A planet with its stages."""
    globe = Globe(folder)
    globe.go_to(globe.times[-1])
    if not globe.islands:
        expect(open_edges(globe.parts["topography"].warp.Input) == 0, "the globe is not closed")
    check_ranges(globe)
    before = take(globe, pictures, "elevation" if "elevation" in globe.fields() else "bare")
    for field in ("biome", "koppen_class", "temperature", "plate_id", "discharge"):
        if field in globe.fields():
            after = take(globe.colour(field), pictures, field)
            expect(np.abs(after.astype(int) - before).mean() > 2.0, field, "looks like the topography")
    if "boundary_type" in globe.fields():
        take(globe.show("boundaries", "plates"), pictures, "boundaries")
        globe.hide("boundaries", "plates")
    for stage in globe.run.stages:
        globe.go_to(globe.times[-1]).colour("elevation").stage(stage)
        take(globe, pictures, f"stage-{stage}")
        words = str(globe.words.Expression)
        expect(f"after {stage}" in words and globe.field.replace("_", " ") in words, "the caption says", words)
    flat = take(globe.exaggerate(1.0), pictures, "flat")
    steep = take(globe.exaggerate(60.0), pictures, "steep")
    expect(np.abs(flat.astype(int) - steep).mean() > 1.0, "exaggeration changes nothing")
    globe.exaggerate(15.0).colour("elevation")
    take(globe, pictures, "before-state")
    globe.save_state(pictures / "globe.pvsm")
    for name in globe.islands:
        take(globe.exaggerate(5.0).look_at_island(name), pictures, f"{name}-on-globe")
        take(globe.island_view(name), pictures, name)


def check_state(_folder, pictures):
    """The state that check_stages has left shows the same, without terrane_view."""
    simple.LoadState(str(pictures / "globe.pvsm"))
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [1200, 900]
    path = pictures / "from-state.png"
    simple.SaveScreenshot(str(path), view, ImageResolution=list(SIZE))
    saved = pixels(pictures / "before-state.png")
    difference = np.abs(check_picture(path).astype(int) - saved).mean()
    expect(difference < 3.0, "the state file shows something else: mean difference", difference)


def check_thinning(folder, _pictures):
    """A planet too large to be shown whole is thinned out, and the status says so."""
    globe = Globe(folder, cells=5000)
    expect(globe.source.factor > 1, "5000 cells were asked for")
    expect("means" in globe.status(), "the status keeps silent on thinning:", globe.status())
    points = globe.parts["topography"].warp.Input.GetDataInformation().GetNumberOfPoints()
    expect(1000 < points < 5500, "5000 cells were asked for, there are", points)


def check_drift(folder, pictures):
    """Frames of drifting plates, one picture each."""
    globe = Globe(folder, drift=True)
    frames = len(list((folder / "frames").glob("*.vti")))
    expect(len(globe.times) == frames, len(globe.times), "times of", frames, "frames")
    globe.show("boundaries").movie(pictures / "movie", SIZE)
    made = sorted((pictures / "movie").glob("frame-*.png"))
    expect(len(made) == frames, len(made), "pictures of", frames, "frames")
    first, last = check_picture(made[0]), check_picture(made[-1])
    expect(np.abs(first.astype(int) - last).mean() > 2.0, "plates do not drift")


PARTS = {
    "surfaces": check_surfaces,
    "stages": check_stages,
    "state": check_state,
    "thinning": check_thinning,
    "drift": check_drift,
}


def main():
    """Checks one part of a run."""
    folder, pictures, part = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    pictures.mkdir(parents=True, exist_ok=True)
    PARTS[part](folder, pictures)
    print(f"globe in ParaView, {part}: {len(failures)} failures", flush=True)
    # pvbatch hangs now and then in its own clean-up.
    os._exit(1 if failures else 0)


if __name__ == "__main__":
    # Programmable filters leave numpy's max, take and others behind in the main module.
    import paraview_globe_check

    paraview_globe_check.main()
