#!/usr/bin/env python3
"""The summary figure of a sweep: curves, distances to the target, and parameters of each preset.

Reads RESULTS/PRESET/fit/{calibration.json,hypsometry.csv} and the planets in
RESULTS/PRESET/{before,after}/part-N/seed-M, as the last stage left them, and writes a figure and a table.
"""
import argparse
import csv
import json
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no screen needed
import matplotlib.pyplot as plt
import netCDF4
import numpy as np

INK, GREY, RED = "#20262d", "#8c949e", "#bd3829"


def planet_of(folder, seed):
    """terrane sweep gives all seeds of a part as many digits."""
    return next(planet for planet in sorted(folder.glob("part-*/seed-*"))
                if int(planet.name.removeprefix("seed-")) == seed)


def relief_of(folder):
    """The file of the last stage that changed the elevation."""
    files = (folder / name for name in ("05-hydrology.nc", "03-erosion.nc", "02-isostasy.nc"))
    return next(file for file in files if file.exists())


def bin_means(folder, bins):
    """Mean elevation of equal shares of a planet's area, from the lowest to the highest."""
    path = relief_of(folder)
    with netCDF4.Dataset(path) as file:
        elevation = np.asarray(file["elevation"][:], dtype=float).ravel()
        area = np.asarray(file["cell_area"][:], dtype=float)
        if area.ndim == 1:  # one value for each latitude
            area = np.repeat(area, elevation.size // area.size)
        area = area.ravel()
    order = np.argsort(elevation, kind="stable")
    below = np.concatenate([[0.0], np.cumsum(area[order])])
    volume = np.concatenate([[0.0], np.cumsum(area[order] * elevation[order])])
    edges = np.interp(np.linspace(0.0, below[-1], bins + 1), below, volume)
    return np.diff(edges) * bins / below[-1]


def read_target(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return (np.array([float(row["quantile"]) for row in rows]),
            np.array([float(row["target_m"]) for row in rows]))


class Sweep:
    """One preset: its fit, and its planets before and after."""

    def __init__(self, results, preset, seeds):
        folder = Path(results) / preset
        self.preset, self.seeds = preset, seeds
        self.fit = json.loads((folder / "fit" / "calibration.json").read_text())
        self.quantile, self.target = read_target(folder / "fit" / "hypsometry.csv")
        self.curves = {
            when: [bin_means(planet_of(folder / when, seed), self.target.size) for seed in seeds]
            for when in ("before", "after")
        }

    def distances_m(self, when):
        """Wasserstein-1 distance of each planet to the target."""
        return [float(np.mean(np.abs(curve - self.target))) for curve in self.curves[when]]


def draw_curves(axes, sweep):
    higher = 100.0 * (1.0 - sweep.quantile)
    for when, colour in (("before", GREY), ("after", RED)):
        for number, curve in enumerate(sweep.curves[when]):
            axes.plot(higher, curve, color=colour, lw=0.8, alpha=0.8,
                      label=when if number == 0 else None)
    axes.plot(higher, sweep.target, color=INK, lw=1.8, label=f"target: {sweep.fit['target']}")
    axes.axhline(0.0, color=INK, lw=0.6)
    axes.set(title=sweep.preset, xlim=(0, 100), xlabel="% of the area lies higher",
             ylabel="elevation, m")
    axes.legend(frameon=False)


def draw_distances(axes, sweep):
    before, after = sweep.distances_m("before"), sweep.distances_m("after")
    for place, (low, high) in enumerate(zip(after, before)):
        axes.plot([place, place], [low, high], color=GREY, lw=0.8, zorder=1)
    axes.scatter(range(len(before)), before, color=GREY, label=f"before, mean {np.mean(before):.0f} m")
    axes.scatter(range(len(after)), after, color=RED, label=f"after, mean {np.mean(after):.0f} m")
    axes.set_xticks(range(len(sweep.seeds)), [str(seed) for seed in sweep.seeds])
    axes.set(xlim=(-0.6, len(sweep.seeds) - 0.4), xlabel="seed", ylabel="Wasserstein-1 distance, m",
             title="planets that the fit has not seen")
    axes.set_ylim(0.0, 1.35 * max(before + after))
    axes.legend(frameon=False, loc="upper right")


def place_in_bounds(parameter, value):
    low, high = parameter["bounds"]
    if parameter["scale"] == "logarithmic":
        return math.log(value / low) / math.log(high / low)
    return (value - low) / (high - low)


def one_error_around(parameter, error):
    """From one error below to one above; a factor where the parameter was fitted on a log scale."""
    fitted, (low, high) = parameter["fitted"], parameter["bounds"]
    if parameter["scale"] == "logarithmic":
        factor = math.exp(min(error / fitted, 50.0))
        ends = fitted / factor, fitted * factor
    else:
        ends = fitted - error, fitted + error
    return [min(max(value, low), high) for value in ends]


def draw_parameters(axes, sweep):
    parameters = sweep.fit["parameters"]
    for row, parameter in enumerate(reversed(parameters)):
        fitted = parameter["fitted"]
        error = max(parameter[key] or 0.0 for key in ("standard_error", "seed_error"))
        ends = [place_in_bounds(parameter, value) for value in one_error_around(parameter, error)]
        axes.plot(ends, [row, row], color=RED, lw=1.5)
        axes.plot(place_in_bounds(parameter, parameter["start"]), row, "o", mfc="none", color=GREY)
        axes.plot(place_in_bounds(parameter, fitted), row, "o", color=RED)
        axes.annotate(f"{fitted:.4g}", (1.03, row), xycoords=("axes fraction", "data"), va="center")
    axes.set_yticks(range(len(parameters)), [each["name"] for each in reversed(parameters)])
    axes.set(xlim=(0, 1), ylim=(-0.6, len(parameters) - 0.4), xlabel="place within the bounds")
    axes.set_title("parameters" if sweep.fit["converged"] else "parameters (did not converge)")


def draw(sweeps, path):
    figure, grid = plt.subplots(len(sweeps), 3, figsize=(15, 4.2 * len(sweeps)), squeeze=False,
                                constrained_layout=True)
    for row, sweep in zip(grid, sweeps):
        draw_curves(row[0], sweep)
        draw_distances(row[1], sweep)
        draw_parameters(row[2], sweep)
        for axes in row:
            axes.spines[["top", "right"]].set_visible(False)
            axes.grid(alpha=0.2)
    figure.savefig(path, dpi=150, metadata={"Software": None})


def write_table(sweeps, path):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["preset", "seed", "before_m", "after_m", "converged"])
        for sweep in sweeps:
            rows = zip(sweep.seeds, sweep.distances_m("before"), sweep.distances_m("after"))
            for seed, before, after in rows:
                writer.writerow([sweep.preset, seed, f"{before:.1f}", f"{after:.1f}",
                                 str(sweep.fit["converged"]).lower()])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", required=True)
    parser.add_argument("--presets", nargs="+", required=True)
    parser.add_argument("--seeds", nargs="+", type=int, required=True)
    parser.add_argument("--figure", required=True)
    parser.add_argument("--table", required=True)
    options = parser.parse_args()
    sweeps = [Sweep(options.results, preset, options.seeds) for preset in options.presets]
    draw(sweeps, options.figure)
    write_table(sweeps, options.table)


if __name__ == "__main__":
    main()
