"""Shows a run of terrane as a globe in ParaView.

The same file works three ways:

* as a macro of ParaView's window, after `pvbatch terrane_globe.py --install-macro`: shows the run
  whose file is open, or that of TERRANE_RUN, or that of the working folder;
* in View > Python Shell > Run Script, of a ParaView that was started in terrane's folder (or with
  TERRANE_PARAVIEW, the folder of this file): the same, and the shell has it as `globe`;
* without a window: `pvbatch terrane_globe.py FOLDER --picture globe.png`, with the options below.
"""

import argparse
import os
import sys
from pathlib import Path

INSTALLED = ""  # the folder of terrane_view, written here when the file becomes a macro


def folder_of_package():
    """Where terrane_view lies. ParaView's window does not tell a script where its file is."""
    places = [INSTALLED, os.environ.get("TERRANE_PARAVIEW", "")]
    if "__file__" in globals():
        places.append(Path(__file__).resolve().parent)
    places += [Path.cwd(), Path.cwd() / "paraview"]
    places += [Path(f"{prefix}/share/terrane/paraview") for prefix in ("/usr/local", "/usr")]
    for place in places:
        if place and (Path(place) / "terrane_view").is_dir():
            return str(place)
    raise RuntimeError("terrane_view not found: set TERRANE_PARAVIEW to terrane's folder paraview")


sys.path.insert(0, folder_of_package())

from paraview import simple  # noqa: E402
from terrane_view import Globe, RunError  # noqa: E402
from terrane_view.run import run_folder_of  # noqa: E402

MACROS = Path("~/.config/ParaView/Macros").expanduser()


def read_options(given):
    """The options of the command line."""
    parser = argparse.ArgumentParser(prog="pvbatch terrane_globe.py", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    add = parser.add_argument
    add("folder", nargs="?", help="folder of a run")
    add("--field", help="field that colours the globe (elevation)")
    add("--stage", help="stage to show (the last)")
    add("--drift", action="store_true", help="drifting plates, frame by frame")
    add("--time", type=float, help="time of the frame to show, Myr (the last)")
    add("--exaggeration", type=float, help="multiplies heights (15, at an island 5)")
    add("--cells", type=int, default=None, help="cells that are shown at most (800000)")
    add("--centre", default="20,0", help="LAT,LON in the middle (20,0)")
    add("--nearness", type=float, default=1.0, help="2 is twice as near (1)")
    add("--show", default="", help="more parts: boundaries,plates,wind")
    add("--hide", default="", help="parts to leave out: sea,lakes,rivers,island")
    add("--island", nargs="?", const="island", help="the island as a block (or island-2 ...)")
    add("--at-island", nargs="?", const="island", help="the island where it lies on the globe")
    add("--picture", help="PNG to write")
    add("--movie", help="folder for a PNG of every time")
    add("--size", default="1600x1200", help="pixels of pictures (1600x1200)")
    add("--state", help="ParaView state file (.pvsm) to write")
    add("--install-macro", action="store_true", help="make this a macro of ParaView, and end")
    words = list(given)
    # A latitude may begin with a minus, as options do.
    for i in [i for i, word in enumerate(words[:-1]) if word == "--centre"]:
        words[i : i + 2] = [f"--centre={words[i + 1]}", ""]
    return parser.parse_args([word for word in words if word])


def install_macro():
    """Copies this file among ParaView's macros with the way back to terrane_view."""
    MACROS.mkdir(parents=True, exist_ok=True)
    text = Path(__file__).read_text(encoding="utf-8")
    line = f"INSTALLED = {folder_of_package()!r}"
    target = MACROS / "terrane_globe.py"
    target.write_text(text.replace('INSTALLED = ""', line, 1), encoding="utf-8")
    print(f"ParaView's menu Macros has terrane_globe now ({target})")


def words(text):
    """Words between commas."""
    return [word for word in text.split(",") if word]


def find_folder():
    """The run that is meant where nobody names one."""
    named = [simple.GetActiveSource(), *reversed(list(simple.GetSources().values()))]
    files = [source.GetProperty("FileName") for source in named if source is not None]
    places = [file.GetData() for file in files if file is not None]
    for path in [*places, os.environ.get("TERRANE_RUN"), os.getcwd()]:
        path = path[0] if isinstance(path, (list, tuple)) and path else path
        folder = run_folder_of(path) if isinstance(path, str) and path else None
        if folder:
            return folder
    raise RunError("which run? open its planet.pvd first, or set TERRANE_RUN to its folder")


def make(options):
    """The globe that the options describe."""
    more = {} if options.cells is None else {"cells": options.cells}
    folder = options.folder or find_folder()
    times = options.exaggeration or (5.0 if options.at_island else 15.0)
    made = Globe(folder, options.drift, exaggeration=times, **more)
    if options.drift:
        made.show("boundaries")
    if options.stage:
        made.stage(options.stage)
    else:
        made.go_to(made.times[-1] if options.time is None else options.time)
    if options.field:
        made.colour(options.field)
    made.show(*words(options.show)).hide(*words(options.hide))
    latitude, longitude = (float(word) for word in options.centre.split(","))
    made.look(latitude, longitude, options.nearness)
    if options.at_island:
        made.look_at_island(options.at_island)
    return made


def write(made, options):
    """The files that the options ask for."""
    size = tuple(int(word) for word in options.size.split("x"))
    shown = made.island_view(options.island) if options.island else made
    if options.island and options.field:
        shown.colour(options.field)
    if options.picture:
        shown.picture(options.picture, size)
    if options.movie:
        made.movie(options.movie, size)
    if options.state:
        made.save_state(options.state)


def main(arguments):
    """Makes a globe and its files; says what is shown."""
    options = read_options(arguments)
    if options.install_macro:
        install_macro()
        return None
    made = make(options)
    write(made, options)
    print(made.status(), flush=True)
    return made


def is_batch():
    """Whether this runs without a window."""
    return bool(sys.argv) and Path(sys.argv[0]).name == "terrane_globe.py"


if is_batch():
    try:
        main(sys.argv[1:])
    except RunError as error:
        print(f"terrane_globe: {error}", file=sys.stderr, flush=True)
        os._exit(2)
    # pvbatch hangs now and then in its own clean-up.
    os._exit(0)
else:
    globe = main([])
    simple.Render()
