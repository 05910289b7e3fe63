#!/usr/bin/python3
"""Reads what `terrane export --format gplates` writes as GPlates would, and lets crust drift by it.

usage: check_gplates.py TERRANE FOLDER [RUN]

Drifts a small planet into FOLDER, or takes the folder RUN of a drift, exports it and reads the files
with a reader of its own, which follows GPlates' documents and nothing of terrane:

- A rotation file has lines of moving plate, time (Ma), latitude, longitude, angle, fixed plate and
  !comment. Consecutive lines of one pair of plates are a sequence. A finite rotation takes a place of
  today to where it was, relative to the fixed plate; between two times of a sequence it is
  interpolated along the great circle of quaternions. Circuits lead to plate 000.
- GeoJSON features have the attributes PLATEID1, FROMAGE, TOAGE, NAME, TYPE and GPGIM_TYPE, and
  places of today.
- GPML has the same with latitudes first.

Then the continents of each frame are carried to the next one: where the rotations are right they lie
where the next frame has them. Prints the figures, one line per failure, and ends with 1 if there was
any. Needs numpy alone.
"""

import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from checking import expect, failures

SAMPLES, RADIUS_KM = 20000, 6371.0
GML, GPML = "{http://www.opengis.net/gml}", "{http://www.gplates.org/gplates}"
LAYERS = {"plates": "gpml:ClosedPlateBoundary", "continents": "gpml:ContinentalCrust",
          "coastlines": "gpml:Coastline", "isochrons": "gpml:Isochron", "boundaries": None}


# Rotations, by Hamilton's quaternions: scalar first.


def product(a, b):
    w, v = a[0] * b[0] - a[1:] @ b[1:], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.concatenate([[w], v])


def inverse(q):
    return q * [1, -1, -1, -1]


def quaternion(latitude, longitude, angle):
    la, lo, half = np.radians([latitude, longitude, 0.5 * angle])
    pole = np.array([np.cos(la) * np.cos(lo), np.cos(la) * np.sin(lo), np.sin(la)])
    return np.concatenate([[np.cos(half)], np.sin(half) * pole])


def slerp(a, b, share):
    cosine = a @ b
    if cosine < 0.0:
        b, cosine = -b, -cosine
    angle = np.arccos(min(1.0, cosine))
    if angle < 1e-12:
        return a
    return (np.sin((1 - share) * angle) * a + np.sin(share * angle) * b) / np.sin(angle)


def turned(q, places):
    w, v = q[0], q[1:]
    return places + 2.0 * np.cross(v, np.cross(v, places) + w * places)


class Rotations:
    """A rotation file."""

    def __init__(self, path, factor=1.0):
        self.sequences, last = [], None
        for line in Path(path).read_text().splitlines():
            words = line.split("!")[0].split()
            moving, fixed = int(words[0]), int(words[5])
            time, latitude, longitude, angle = map(float, words[1:5])
            expect(len(words) == 6 and abs(latitude) <= 90 and abs(longitude) <= 180, "line", line)
            sample = (time, quaternion(latitude, longitude, factor * angle))
            if last and last["pair"] == (moving, fixed) and last["samples"][-1][0] < time:
                last["samples"].append(sample)
            else:
                last = {"pair": (moving, fixed), "samples": [sample]}
                self.sequences.append(last)

    def all_at(self, plate, time):
        """By each sequence that covers the time: two at a crossover."""
        if plate == 0:
            return [np.array([1.0, 0, 0, 0])]
        found = []
        for sequence in self.sequences:
            moving, fixed = sequence["pair"]
            samples = sequence["samples"]
            if moving != plate or not samples[0][0] <= time <= samples[-1][0]:
                continue
            times = [sample[0] for sample in samples]
            k = min(max(1, int(np.searchsorted(times, time))), len(times) - 1)
            if len(times) == 1:
                own = samples[0][1]
            else:
                own = slerp(samples[k - 1][1], samples[k][1],
                            (time - times[k - 1]) / (times[k] - times[k - 1]))
            found += [product(whole, own) for whole in self.all_at(fixed, time)[:1]]
        return found

    def at(self, plate, time):
        found = self.all_at(plate, time)
        return found[0] if found else None

    def plates(self):
        return sorted({sequence["pair"][0] for sequence in self.sequences})


# Features.


def unit(longitude_latitude):
    lo, la = np.radians(np.asarray(longitude_latitude, dtype="f8")).T
    return np.stack([np.cos(la) * np.cos(lo), np.cos(la) * np.sin(lo), np.sin(la)], axis=1)


def geojson(path):
    features = []
    for feature in json.loads(Path(path).read_text())["features"]:
        kind, parts = feature["geometry"]["type"], feature["geometry"]["coordinates"]
        parts = parts if kind.startswith("Multi") else [parts]
        lines = [ring for part in parts for ring in part] if kind.endswith("Polygon") else parts
        features.append({**feature["properties"], "lines": [unit(line) for line in lines],
                         "is_polygon": kind.endswith("Polygon")})
    return features


def gpml(path):
    features = []
    for member in ET.parse(path).getroot().findall(GML + "featureMember"):
        node = member[0]
        lines = [unit(np.array(positions.text.split(), dtype="f8").reshape(-1, 2)[:, ::-1])
                 for positions in node.iter(GML + "posList")]
        times = [float(t.text) for t in node.iter(GML + "timePosition")]
        plate = node.find(f"{GPML}reconstructionPlateId/{GPML}ConstantValue/{GPML}value")
        polarity = node.find(f"{GPML}subductionPolarity/{GPML}ConstantValue/{GPML}value")
        features.append({"PLATEID1": int(plate.text), "FROMAGE": times[0], "TOAGE": times[1],
                         "NAME": node.find(GML + "name").text,
                         "GPGIM_TYPE": node.tag.replace(GPML, "gpml:"),
                         "POLARITY": None if polarity is None else polarity.text, "lines": lines})
    return features


def area_to_the_left(ring):
    """Solid angle, by Girard's theorem: the sum of the angles on the left of a closed line."""
    ring = ring[:-1]
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    back, on = np.cross(ring, np.cross(before, ring)), np.cross(ring, np.cross(after, ring))
    angle = np.arctan2(np.einsum("ij,ij->i", ring, np.cross(on, back)),
                       np.einsum("ij,ij->i", on, back)) % (2 * np.pi)
    return np.sum(angle) - (len(ring) - 2) * np.pi


def beside(ring):
    """A place just outside the region to the left of a line."""
    middle = ring[0] + ring[1]
    left = np.cross(middle, ring[1] - ring[0])
    place = middle / np.linalg.norm(middle) - 0.005 * left / np.linalg.norm(left)
    return place / np.linalg.norm(place)


def turns_seen(places, rings):
    """How often rings go round each place, less how often they go round its antipode, times 2 pi."""
    whole = np.zeros(len(places))
    for ring in rings:
        for part in np.array_split(np.arange(len(places)), max(1, len(places) // 200)):
            at = places[part, None, :]
            flat = ring[None] - np.sum(at * ring[None], axis=2, keepdims=True) * at
            a, b = flat[:, :-1], flat[:, 1:]
            whole[part] += np.sum(
                np.arctan2(np.sum(at * np.cross(a, b), axis=2), np.sum(a * b, axis=2)), axis=1)
    return whole


def turns_on_map(places, rings):
    """How often rings go round each place on a map on which a place outside them is infinitely far, times 2 pi."""
    far = beside(rings[0])
    first = np.cross(far, [0.0, 0.0, 1.0] if abs(far[2]) < 0.9 else [1.0, 0.0, 0.0])
    first /= np.linalg.norm(first)
    second = np.cross(first, far)

    def on_map(positions):
        return np.stack([positions @ first, positions @ second], 1) / np.maximum(1.0 - positions @ far, 1e-12)[:, None]

    whole = np.zeros(len(places))
    for line in map(on_map, rings):
        for k, at in enumerate(on_map(places)):
            a, b = line[:-1] - at, line[1:] - at
            whole[k] += np.sum(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.sum(a * b, axis=1)))
    return whole


def is_inside(places, rings):
    """Whether rings with their region to the left go once round each place. Where they hold its antipode as well, which
    they seem to go round the other way, a map tells."""
    turns = turns_seen(places, rings)
    inside = turns > np.pi
    unclear = np.abs(turns) < np.pi
    inside[unclear] = turns_on_map(places[unclear], rings) > np.pi
    return inside


def nearest_km(places, others):
    found = np.empty(len(places))
    for part in np.array_split(np.arange(len(places)), max(1, len(places) // 200)):
        chord = np.sqrt(np.maximum(0.0, 2.0 - 2.0 * places[part] @ others.T).min(axis=1))
        found[part] = 2.0 * RADIUS_KM * np.arcsin(np.minimum(1.0, 0.5 * chord))
    return found


# Checks.


def check_circuits(rotations, oldest):
    expect(not {0, 999} & set(rotations.plates()), "numbers that GPlates keeps are plates")
    crossovers = 0
    for plate in rotations.plates():
        ends = {s["samples"][k][0] for s in rotations.sequences if s["pair"][0] == plate for k in (0, -1)}
        for time in ends:
            expect(0.0 <= time <= oldest, "plate", plate, "at", time, "Ma")
            there = rotations.all_at(plate, time)
            expect(there, "plate", plate, "has no circuit at", time)
            crossovers += len(there) == 2
            for other in there[1:]:
                apart = np.degrees(2 * np.arcsin(np.linalg.norm(product(inverse(there[0]), other)[1:])))
                expect(apart < 1e-9, "plate", plate, "jumps", apart, "degrees at", time)
    return crossovers


def check_layers(folder, times):
    layers = {}
    for name, wanted in LAYERS.items():
        layers[name] = geojson(folder / f"{name}.geojson")
        same = gpml(folder / f"{name}.gpml")
        expect(len(same) == len(layers[name]) > 0, name, "has", len(layers[name]), "and", len(same))
        for a, b in zip(layers[name], same):
            expect(wanted is None or a["GPGIM_TYPE"] == wanted, name, "has", a["GPGIM_TYPE"])
            expect(all(a.get(key) == b[key] for key in b if key != "lines"), name, "differs:", a["NAME"])
            expect(all(np.abs(x - y).max() < 1e-9 for x, y in zip(a["lines"], b["lines"])), "places of", a["NAME"])
            expect(a["FROMAGE"] in times and 0.0 <= a["TOAGE"] <= a["FROMAGE"], "times of", a["NAME"])
    kinds = {feature["GPGIM_TYPE"] for feature in layers["boundaries"]}
    expect({"gpml:MidOceanRidge", "gpml:SubductionZone", "gpml:Transform"} <= kinds, "boundaries are", kinds)
    for trench in layers["boundaries"]:
        expect((trench["GPGIM_TYPE"] == "gpml:SubductionZone") == ("POLARITY" in trench), "polarity", trench["NAME"])
    return layers


def at_time(features, time):
    """Those that are there, as GPlates chooses them."""
    return [f for f in features if f["FROMAGE"] >= time >= f["TOAGE"]]


def check_fit(rotations, plates, times):
    """At the time of a frame neighbours share the points of their boundary; none is left over."""
    for time in times:
        rings = []
        for feature in at_time(plates, time):
            expect(feature["FROMAGE"] == time, "plates of two frames at", time)
            rings += [turned(rotations.at(feature["PLATEID1"], time), ring)[:-1] for ring in feature["lines"]]
        _, shared = np.unique(np.round(1e6 * np.concatenate(rings)), axis=0, return_counts=True)
        alone = np.mean(shared == 1)  # but for those that rounding parts
        expect(alone < 0.01, f"at {time} Ma {100 * alone:.1f} % of the points are of one plate alone")


def check_cells(rotations, plates, times, run):
    """The plate of each cell of a frame is that of the polygon in which it lies, the edge aside."""
    try:
        import netCDF4
    except ImportError:
        return
    for time in times:
        name = "01-plates.nc" if time == 0.0 else f"frames/plates-{times[0] - time:07.2f}.nc"
        with netCDF4.Dataset(run / name) as file:
            numbers = np.squeeze(np.asarray(file["plate_id"][:]))
            step = max(1, len(numbers) // 32)
            longitude, latitude = np.meshgrid(file["lon"][::step], file["lat"][::step])
        numbers = numbers[::step, ::step].ravel()
        places = unit(np.stack([longitude.ravel(), latitude.ravel()], 1))
        right = total = 0
        for feature in at_time(plates, time):
            rings = [turned(rotations.at(feature["PLATEID1"], time), ring) for ring in feature["lines"]]
            if sum(area_to_the_left(ring) for ring in rings[:1]) > np.pi:
                continue  # what is outside so large a plate is a matter of taste
            own = numbers + 1000 == feature["PLATEID1"]
            right += np.sum(is_inside(places[own], rings))
            total += np.sum(own)
        expect(right > 0.99 * total, "at", time, "Ma", right, "of", total, "cells lie in their plate")


def check_table(rotations, times, run):
    """Stages are those of the table of the run."""
    rows = np.genfromtxt(run / "01-plates-rotations.csv", delimiter=",", names=True)
    apart = 0.0
    for row in rows[:: max(1, len(rows) // 500)]:
        plate = 1000 + int(row["plate_id"])
        older, younger = (rotations.at(plate, times[0] - row[key]) for key in ("from_myr", "to_myr"))
        stage = quaternion(row["pole_latitude_deg"], row["pole_longitude_deg"],
                           row["rate_deg_myr"] * (row["to_myr"] - row["from_myr"]))
        apart = max(apart, np.linalg.norm(product(inverse(stage), product(younger, inverse(older)))[1:]))
    expect(apart < 1e-12, "stages are", apart, "rad from those of the table")


def outlines(rotations, continents, frame_ma):
    """Continents of a frame: plate and rings, where they were."""
    return [(f["PLATEID1"], [turned(rotations.at(f["PLATEID1"], frame_ma), ring) for ring in f["lines"]])
            for f in continents if f["FROMAGE"] == frame_ma]


def interior(rings, all_places):
    """Places of a net over the sphere that lie within an outline."""
    middle = rings[0].mean(axis=0)
    near = all_places[all_places @ (middle / np.linalg.norm(middle)) > 0.0]
    return near[is_inside(near, rings)]


def net(count):
    k = np.arange(count)
    z, longitude = 1.0 - (2 * k + 1) / count, np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(longitude), r * np.sin(longitude), z], axis=1)


def landing(rotations, carriers, continents, times):
    """Frame by frame: how far outlines of continents, carried to the next frame, land from its
    outlines, and places within them from its continents; km."""
    places, edges, inner = net(2000), [], []
    for older, younger in zip(times, times[1:]):
        there = outlines(rotations, continents, younger)
        edge = np.concatenate([ring for _, rings in there for ring in rings])
        for plate, rings in outlines(rotations, continents, older):
            at_end = carriers.at(plate, younger)
            if at_end is None:
                continue  # it was subducted
            stage = product(at_end, inverse(carriers.at(plate, older)))
            edges.append(nearest_km(turned(stage, np.concatenate(rings)[::5]), edge))
            now = turned(stage, interior(rings, places))
            if len(now):
                lands = np.any([is_inside(now, other) for _, other in there], axis=0)
                inner.append(np.where(lands, 0.0, nearest_km(now, edge)))
    return np.concatenate(edges), np.concatenate(inner)


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    samples, run = SAMPLES, folder / "run"
    if len(sys.argv) > 3:
        run = Path(sys.argv[3])
        for line in (run / "config.toml").read_text().splitlines():
            if line.strip().startswith("samples ="):
                samples = float(line.split("=")[1].split("#")[0])
    else:
        subprocess.run([program, "run", "--preset", "sphere", "--grid", "256x128", "--to", "plates",
                        "--set", f"plates.sphere.samples={SAMPLES}", "--set", "plates.sphere.time_myr=80",
                        "--set", "plates.sphere.frames_myr=20", "--no-maps", "-o", run], check=True,
                       capture_output=True)
    spacing_km = RADIUS_KM * np.sqrt(4 * np.pi / samples)
    subprocess.run([program, "export", run, "--format", "gplates", "-o", folder / "gplates"],
                   check=True, capture_output=True)
    rotations = Rotations(folder / "gplates/rotations.rot")
    times = sorted({f["FROMAGE"] for f in geojson(folder / "gplates/plates.geojson")}, reverse=True)
    expect(len(times) > 2 and times[-1] == 0.0, "frames of", times)
    crossovers = check_circuits(rotations, times[0])
    layers = check_layers(folder / "gplates", times)
    check_fit(rotations, layers["plates"], times)
    check_cells(rotations, layers["plates"], times, run)
    check_table(rotations, times, run)
    print(f"{len(times)} frames, {len(rotations.plates())} plates, {crossovers} crossovers; samples "
          f"{spacing_km:.0f} km apart")
    still = Rotations(folder / "gplates/rotations.rot", 0.0)
    found = {}
    for words, carriers in (("", rotations), ("left where they are, ", still)):
        edges, inner = landing(rotations, carriers, layers["continents"], times)
        found[words] = np.median(edges), np.mean(inner <= spacing_km)
        print(f"{words}outlines of continents land {np.median(edges):.0f} km from those of the next frame "
              f"(median), {100 * np.mean(edges <= spacing_km):.1f} % within one spacing; of places within "
              f"them {100 * found[words][1]:.2f} % on a continent or within one spacing of it")
    expect(found[""][0] <= spacing_km, "the median outline lands", found[""][0], "km away")
    expect(found[""][1] > 0.98, "places within continents land on none:", found[""][1])
    # Continents that do not move must not pass for those that do.
    expect(found["left where they are, "][0] > 1.5 * found[""][0], "continents hardly moved")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
