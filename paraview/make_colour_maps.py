#!/usr/bin/env python3
"""Writes colour_maps/terrane.json, ParaView's presets, from the colour maps of the program.

usage: make_colour_maps.py [--check]

data/colour_maps/*.csv are what the PNG maps are painted with. With --check nothing is written: ends
with 1 when the presets are not those of the tables.
"""

import csv
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TABLES = HERE.parent / "data" / "colour_maps"
PRESETS = HERE / "colour_maps" / "terrane.json"

CATEGORIES = ("biome", "boundary_type", "koppen_class", "rock_type")
CONTINUOUS = (
    "crust_age",
    "crust_thickness",
    "net_primary_productivity",
    "precipitation",
    "settlement_suitability",
    "temperature",
    "wind_speed",
)
UNITS_PER_TABLE_UNIT = {"crust_thickness": 1000.0}
MOST_PLATES = 100
UNKNOWN = [0.5, 0.5, 0.5]


def table(name):
    """Rows of a colour map: value, colour, name of a category."""
    with open(TABLES / f"{name}.csv", newline="", encoding="utf-8") as file:
        return [
            (float(row["value"]), components(row["colour"]), row["name"])
            for row in csv.DictReader(file)
        ]


def components(colour):
    """Red, green and blue, 0 to 1, of "#rrggbb"."""
    return [round(int(colour[i : i + 2], 16) / 255.0, 4) for i in (1, 3, 5)]


def continuous(name, rows, scale=1.0):
    """A preset that runs through the colours of a table."""
    points = [number for value, colour, _ in rows for number in (value * scale, *colour)]
    return {
        "Name": f"terrane {name}",
        "ColorSpace": "RGB",
        "NanColor": UNKNOWN,
        "RGBPoints": points,
    }


def categorical(name, rows):
    """A preset with a colour and a name for each class."""
    return {
        "Name": f"terrane {name}",
        "Annotations": [text for value, _, words in rows for text in (str(int(value)), words)],
        "IndexedColors": [number for _, colour, _ in rows for number in colour],
        "NanColor": UNKNOWN,
    }


def elevation():
    """Depths below and heights above the sea, with a break of colour at its level."""
    sea, land = table("sea_depth"), table("land_elevation")
    just_below = (-1e-3, *sea[-1][1:])
    return continuous("elevation", sea[:-1] + [just_below] + land)


def plates():
    """The maps' colours of plates over and over."""
    rows = table("plates")
    return categorical(
        "plate_id",
        [(i, rows[i % len(rows)][1], f"plate {i}") for i in range(MOST_PLATES)],
    )


def presets():
    """All presets, as ParaView imports them."""
    made = [elevation(), plates()]
    made += [continuous(n, table(n), UNITS_PER_TABLE_UNIT.get(n, 1.0)) for n in CONTINUOUS]
    made += [categorical(n, table(n)) for n in CATEGORIES]
    return sorted(made, key=lambda preset: preset["Name"])


def main():
    """Writes or checks the presets."""
    text = json.dumps(presets(), indent=1) + "\n"
    if sys.argv[1:] == ["--check"]:
        if not PRESETS.exists() or PRESETS.read_text(encoding="utf-8") != text:
            sys.exit(f"{PRESETS} is stale: run paraview/make_colour_maps.py")
        return
    PRESETS.parent.mkdir(exist_ok=True)
    PRESETS.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
