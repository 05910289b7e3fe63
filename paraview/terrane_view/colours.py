"""Colours of fields: which map each has, its title, and whether the sea hides the ground."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from paraview import simple

PRESETS = Path(__file__).resolve().parent.parent / "colour_maps" / "terrane.json"

CLEAR, DRY, PAINTED, PALE = "clear", "dry", "painted", "pale"
"""The sea over a field: seen through, left out, painted with the field, or pale blue."""


@dataclass(frozen=True)
class Look:
    """How a field is shown. Without a map of its own it has a perceptual one over its range."""

    title: str = ""
    preset: str = ""
    sea: str = DRY
    signed: bool = False
    logarithmic: bool = False


LOOKS = {
    "elevation": Look("Elevation, m", "elevation", CLEAR),
    "crust_elevation": Look("Elevation of the crust, m", "elevation", CLEAR),
    "plate_id": Look("Plates", "plate_id"),
    "boundary_type": Look("Plate boundaries", "boundary_type"),
    "rock_type": Look("Rock", "rock_type"),
    "biome": Look("Biomes", "biome", PALE),
    "koppen_class": Look("Köppen class", "koppen_class", PALE),
    "crust_age": Look("Age of the crust, Myr", "crust_age"),
    "ocean_floor_age": Look("Age of the ocean floor, Myr", "crust_age"),
    "crust_thickness": Look("Thickness of the crust, m", "crust_thickness"),
    "temperature": Look("Temperature, °C", "temperature", PAINTED),
    "temperature_range": Look("Warmest minus coldest month, K", sea=PAINTED),
    "precipitation": Look("Precipitation, mm/yr", "precipitation", PAINTED),
    "precipitation_seasonality": Look("Seasonality of precipitation", sea=PAINTED, signed=True),
    "potential_evapotranspiration": Look("Potential evapotranspiration, mm/yr", sea=PAINTED),
    "wind_east": Look("Eastward wind, m/s", sea=PAINTED, signed=True),
    "wind_north": Look("Northward wind, m/s", sea=PAINTED, signed=True),
    "distance_to_coast": Look("Distance to the coast, m", sea=PAINTED),
    "net_primary_productivity": Look(
        "Net primary productivity, g/m²/yr", "net_primary_productivity", PALE
    ),
    "settlement_suitability": Look("Suitability for settlement", "settlement_suitability", PALE),
    "plate_velocity_east": Look("Eastward plate velocity, mm/yr", signed=True),
    "plate_velocity_north": Look("Northward plate velocity, mm/yr", signed=True),
    "fold_direction_east": Look(signed=True),
    "fold_direction_north": Look(signed=True),
    "ridge_direction_east": Look(signed=True),
    "ridge_direction_north": Look(signed=True),
    "drainage_area": Look("Drainage area, m²", sea=PALE, logarithmic=True),
    "discharge": Look("Discharge, m³/s", sea=PALE, logarithmic=True),
    "erosion_rate": Look("Erosion, m/yr", sea=PALE),
    "uplift_rate": Look("Uplift, m/yr", sea=PALE),
    "sediment_thickness": Look("Sediment, m"),
    "ice_thickness": Look("Ice, m"),
    "glacial_erosion": Look("Taken by ice, m"),
    "deposition_rate": Look("Deposition, m/yr"),
    "sediment_flux": Look("Sediment carried, m³/yr", sea=PALE, logarithmic=True),
    "slope": Look("Slope, m/m", sea=PALE),
    "river_intensity": Look("Prominence of rivers", sea=PALE),
    "stream_order": Look("Strahler order of rivers", sea=PALE),
    "lake_depth": Look("Depth of lakes, m", sea=PALE),
    "basin_id": Look("Drainage basins", sea=PALE),
    "lake_id": Look("Lakes", sea=PALE),
}
PAINT_FOR_THE_SEA = tuple(name for name, look in LOOKS.items() if look.sea == PAINTED)
PLATE_COLOURS = 10
CONTINENT = [0.945, 0.935, 0.905]


def look_of(field):
    """How a field is shown."""
    return LOOKS.get(field, Look())


def words_of(field):
    """The name of a field as a caption has it."""
    return field.replace("_", " ")


def title_of(field, units):
    """Title of a legend with its units."""
    title = look_of(field).title
    if title:
        return title
    words = field.replace("_", " ").capitalize()
    return f"{words}, {units}" if units else words


def presets():
    """Presets of terrane by name."""
    made = json.loads(PRESETS.read_text(encoding="utf-8"))
    return {preset["Name"].removeprefix("terrane "): preset for preset in made}


def paint(field, value_range):
    """Gives the colours of a field to every surface that shows it."""
    look, lut = look_of(field), simple.GetColorTransferFunction(field)
    lut.AutomaticRescaleRangeMode = "Never"
    if look.preset:
        preset = presets()[look.preset]
        if "IndexedColors" in preset:
            paint_classes(lut, preset)
        else:
            paint_values(lut, preset)
            if field == "ocean_floor_age":
                lut.NanColor = CONTINENT
        return lut
    low, high = value_range
    if not high > low:
        high = low + 1.0
    if look.signed:
        low, high = -max(abs(low), abs(high)), max(abs(low), abs(high))
    if look.logarithmic:
        low = max(low, 1e-4 * high)
        paint_values(lut, along_logarithm(presets()["precipitation"], low, high))
        return lut
    lut.ApplyPreset("Cool to Warm" if look.signed else "Viridis (matplotlib)", True)
    lut.RescaleTransferFunction(low, high)
    return lut


def along_logarithm(preset, low, high):
    """The colours of a preset, evenly over powers of ten."""
    colours = [preset["RGBPoints"][i : i + 4][1:] for i in range(0, len(preset["RGBPoints"]), 4)]
    ratio, last = high / low, len(colours) - 1
    points = [x for i, c in enumerate(colours) for x in (low * ratio ** (i / last), *c)]
    return {**preset, "RGBPoints": points, "UseLogScale": 1}


def paint_plates(lut, plates):
    """Colours for the plates that there are, none like its neighbours'."""
    present, sizes = np.unique(plates, return_counts=True)
    pairs = set()
    for shift, axis in ((1, 1), (1, 0)):
        other = np.roll(plates, shift, axis)
        differs = plates != other
        if axis == 0:
            differs[0] = False
        both = np.stack([plates[differs], other[differs]], axis=-1)
        pairs.update(map(tuple, np.unique(both, axis=0).tolist()))
    neighbours = {plate: set() for plate in present.tolist()}
    for a, b in pairs:
        neighbours[a].add(b)
        neighbours[b].add(a)
    palette = presets()["plate_id"]["IndexedColors"][: 3 * PLATE_COLOURS]
    chosen, used = {}, [0] * PLATE_COLOURS
    for plate in present[np.argsort(-sizes, kind="stable")].tolist():
        taken = [chosen[n] for n in neighbours[plate] if n in chosen]
        best = min(range(PLATE_COLOURS), key=lambda i: (taken.count(i), used[i], i))
        chosen[plate] = best
        used[best] += 1
    lut.Annotations = [text for p in sorted(chosen) for text in (str(p), f"plate {p}")]
    lut.IndexedColors = [x for p in sorted(chosen) for x in palette[3 * chosen[p] :][:3]]
    lut.IndexedOpacities = [1.0 for _ in chosen]


def paint_values(lut, preset):
    """Colours that run through values."""
    lut.InterpretValuesAsCategories = 0
    lut.ColorSpace = preset["ColorSpace"]
    lut.RGBPoints = preset["RGBPoints"]
    lut.UseLogScale = preset.get("UseLogScale", 0)
    lut.NanColor = preset["NanColor"]


def paint_classes(lut, preset):
    """A colour and a name for each class."""
    lut.InterpretValuesAsCategories = 1
    lut.AnnotationsInitialized = 1
    lut.Annotations = preset["Annotations"]
    lut.IndexedColors = preset["IndexedColors"]
    lut.IndexedOpacities = [1.0 for _ in preset["Annotations"][::2]]
