"""Light, legend, words and camera of a view."""

import numpy as np
from paraview import simple

from . import colours

PAPER = [1.0, 1.0, 1.0]
INK = [0.13, 0.14, 0.17]
CLEAR_WATER, PALE_WATER = [0.55, 0.74, 0.87], [0.83, 0.89, 0.92]
ASIDE = 0.28
MOST_LABEL_POINTS = 330
TOWARDS_LIGHT = [-0.7, 0.7, 1.2]


def clear(view):
    """Hides what a view shows so far."""
    simple.HideAll(view)
    for shown in list(view.Representations):
        if shown.GetXMLName() == "ScalarBarWidgetRepresentation":
            shown.Visibility = 0


def prepare(view):
    """White paper and light from the upper left, as on maps."""
    # The window would move the camera again with its first picture.
    simple._DisableFirstRenderCameraReset()
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = PAPER
    view.OrientationAxesVisibility = 0
    view.UseLight = 0
    light = simple.CreateLight()
    light.Coords, light.Type = "Camera", "Directional"
    light.Position = TOWARDS_LIGHT
    light.FocalPoint = [0.0, 0.0, 0.0]
    view.AdditionalLights = [light]
    # A coarser surface while the view turns.
    view.LODThreshold = 8.0
    view.LODResolution = 0.7


def lit(display, ambient=0.42, diffuse=0.68):
    """Matt, with the shade never black."""
    display.Ambient = ambient
    display.Diffuse = diffuse
    display.Specular = 0.0


def plain(display, colour, opacity=1.0):
    """One colour all over."""
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour
    display.Opacity = opacity


def fill_sea(display, how, field):
    """The surface of the sea as a field wants it: one of the words in `colours`."""
    display.Visibility = int(how != colours.DRY)
    if how == colours.PAINTED:
        display.Opacity = 1.0
        simple.ColorBy(display, ("POINTS", field))
    elif how == colours.CLEAR:
        plain(display, CLEAR_WATER, 0.45)
    else:
        plain(display, PALE_WATER)


def legend(view, lut, title):
    """The legend of a field at the right edge."""
    bar = simple.GetScalarBar(lut, view)
    bar.Title, bar.ComponentTitle = title, ""
    for text in ("TitleColor", "LabelColor"):
        setattr(bar, text, INK)
    bar.TitleFontSize, bar.LabelFontSize = 16, 14
    bar.TextPosition = "Ticks left/bottom, annotations right/top"
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.5, 14
    bar.WindowLocation = "Any Location"
    bar.Position = [0.86, 0.32]
    bar.Orientation = "Vertical"
    bar.HorizontalTitle = 1
    bar.DrawNanAnnotation = 0
    # Where the planet fills the view the legend lies on paper of its own.
    bar.DrawBackground, bar.BackgroundColor, bar.BackgroundPadding = 1, [*PAPER, 0.85], 8
    bar.Enabled = bar.Visibility = 1
    if lut.InterpretValuesAsCategories:
        bar.ScalarBarLength, bar.Position = 0.74, [0.77, 0.22]
        classes = len(lut.Annotations) // 2
        bar.LabelFontSize = int(np.clip(MOST_LABEL_POINTS / classes, 5, 13))
    else:
        bar.AutomaticLabelFormat = 0
        bar.LabelFormat = bar.RangeLabelFormat = "%g"
        bar.AddRangeLabels = 0
    return bar


def small_legend(view, lut, title):
    """A second legend at the lower right, for lines."""
    bar = legend(view, lut, title)
    bar.ScalarBarLength, bar.Position, bar.LabelFontSize = 0.13, [0.77, 0.04], 12
    return bar


def caption(view, source, expression, name):
    """Words in the lower left corner that follow the time; `expression` is Python."""
    words = simple.PythonAnnotation(registrationName=name, Input=source)
    words.ArrayAssociation = "Point Data"
    words.Expression = expression
    display = simple.Show(words, view)
    display.WindowLocation = "Lower Left Corner"
    display.Color = INK
    display.FontSize = 14
    return words


def look_at_globe(view, latitude, longitude, radius_m, nearness=1.0):
    """North up, the place in the middle."""
    phi, lam = np.radians(latitude), np.radians(longitude)
    out = np.array([np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)])
    north = np.array([-np.sin(phi) * np.cos(lam), -np.sin(phi) * np.sin(lam), np.cos(phi)])
    # The globe stands left of the middle: the legend is at the right.
    aside = ASIDE / nearness * radius_m * np.array([-np.sin(lam), np.cos(lam), 0.0])
    view.CenterOfRotation = [0.0, 0.0, 0.0]
    view.CameraFocalPoint = list(aside)
    view.CameraViewAngle = 20.0
    view.CameraPosition = list(out * radius_m * (1.0 + 5.5 / nearness) + aside)
    view.CameraViewUp = list(north)


def look_at_place(view, latitude, longitude, radius_m, width_m, tilt_deg=50.0):
    """A place on the globe from the south, from as far as shows `width_m`."""
    phi, lam = np.radians(latitude), np.radians(longitude)
    out = np.array([np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)])
    north = np.array([-np.sin(phi) * np.cos(lam), -np.sin(phi) * np.sin(lam), np.cos(phi)])
    look_obliquely(view, out * radius_m, out, north, width_m, tilt_deg)


def look_obliquely(view, target, out, north, width_m, tilt_deg):
    """Down on a target from the south, `tilt_deg` above the horizon."""
    tilt, distance = np.radians(tilt_deg), 2.25 * width_m
    towards = np.sin(tilt) * np.asarray(out) - np.cos(tilt) * np.asarray(north)
    # The target stands left of the middle, beside the legend.
    focus = np.asarray(target) + 0.17 * width_m * np.cross(north, out)
    view.CenterOfRotation, view.CameraFocalPoint = list(target), list(focus)
    view.CameraViewAngle = 30.0
    view.CameraPosition = list(focus + distance * towards)
    view.CameraViewUp = list(out)


def save(view, path, size):
    """A picture of a view, its words as large for any size."""
    width, height = size
    view.ViewSize = [round(900 * width / height), 900]
    simple.SaveScreenshot(str(path), view, ImageResolution=[width, height])
