#!/usr/bin/env python3
"""Compares the climate of a run on Earth's topography with observations.

    scripts/validate_climate.py RUN/04-climate.nc NCEP_TEMPERATURE.nc CMAP_PRECIPITATION.nc

RUN's file has `temperature` (degC) and `precipitation` (mm yr-1) on latitudes and longitudes, and,
for the share of land, `elevation` (or another file of the run that holds it: --elevation FILE).
The references have annual means `t_annual` (degC) and `p_annual` (mm day-1).
Prints zonal means in 10 degree bands, area-weighted correlations and errors on land at the
references' own nodes.
"""

import argparse

import netCDF4
import numpy as np


def read(path, name):
    with netCDF4.Dataset(path) as file:
        values = np.ma.filled(file[name][:].astype(float), np.nan)
        names = file[name].dimensions[-2:]
        lat, lon = (np.asarray(file[n][:], float) for n in names)
    return values.squeeze(), lat, (lon + 180) % 360 - 180


def node_means(values, lat, lon, node_lat, node_lon, step):
    """Area-weighted mean of the fine values within step x step degrees around each node."""
    weight = np.cos(np.radians(lat))[:, None] * np.ones_like(values)
    columns = np.round((lon - node_lon[0]) / step).astype(int) % len(node_lon)
    order = np.argsort(node_lat)
    rows = order[np.clip(np.round((lat - node_lat.min()) / step).astype(int), 0, len(node_lat) - 1)]
    index = rows[:, None] * len(node_lon) + columns[None, :]
    count = len(node_lat) * len(node_lon)
    total = np.bincount(index.ravel(), (weight * values).ravel(), count)
    area = np.bincount(index.ravel(), weight.ravel(), count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return (total / area).reshape(len(node_lat), len(node_lon))


def weighted(a, b, w):
    """Correlation and root-mean-square difference under weights w."""
    use = np.isfinite(a) & np.isfinite(b) & (w > 0)
    a, b, w = a[use], b[use], w[use] / w[use].sum()
    da, db = a - (a * w).sum(), b - (b * w).sum()
    return (da * db * w).sum() / np.sqrt((da**2 * w).sum() * (db**2 * w).sum()), np.sqrt(
        ((a - b) ** 2 * w).sum()
    )


def bands(a, b, w, lat):
    use = np.isfinite(a) & np.isfinite(b)
    rows = []
    for south in range(-90, 90, 10):
        m = ((lat >= south) & (lat < south + 10))[:, None] & use
        rows.append((np.average(a[m], weights=w[m]), np.average(b[m], weights=w[m])))
    return np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("climate")
    parser.add_argument("temperature_reference")
    parser.add_argument("precipitation_reference")
    parser.add_argument("--elevation", help="file with `elevation`; default: the climate file")
    arguments = parser.parse_args()

    temperature, lat, lon = read(arguments.climate, "temperature")
    rain, _, _ = read(arguments.climate, "precipitation")
    elevation, _, _ = read(arguments.elevation or arguments.climate, "elevation")
    land = (elevation >= 0).astype(float)

    t_ref, t_lat, t_lon = read(arguments.temperature_reference, "t_annual")
    p_ref, p_lat, p_lon = read(arguments.precipitation_reference, "p_annual")
    p_ref = p_ref * 365.25
    step = 2.5
    on_t = [node_means(v, lat, lon, t_lat, t_lon, step) for v in (temperature, land)]
    on_p = [node_means(v, lat, lon, p_lat, p_lon, step) for v in (rain, land)]
    w_t = np.cos(np.radians(t_lat))[:, None] * np.ones_like(t_ref)
    w_p = np.cos(np.radians(p_lat))[:, None] * np.ones_like(p_ref)
    t_bands, p_bands = bands(on_t[0], t_ref, w_t, t_lat), bands(on_p[0], p_ref, w_p, p_lat)

    print("  band      T    NCEP     diff |      P    CMAP")
    for k in range(17, -1, -1):
        t, p = t_bands[k], p_bands[k]
        print(f"{10*k-90:4d}..{10*k-80:<3d} {t[0]:6.1f} {t[1]:6.1f} {t[0]-t[1]:+7.1f}  | {p[0]:6.0f} {p[1]:6.0f}")
    area = np.diff(np.sin(np.radians(np.arange(-90, 91, 10))))
    p_rms = np.sqrt(((p_bands[:, 0] - p_bands[:, 1]) ** 2 * area).sum() / area.sum())
    p_mean = (p_bands[:, 1] * area).sum() / area.sum()
    t_cor, t_rms = weighted(on_t[0], t_ref, w_t * (on_t[1] > 0.5))
    p_cor, p_rms_land = weighted(on_p[0], p_ref, w_p * (on_p[1] > 0.5))
    root_cor, _ = weighted(np.sqrt(on_p[0]), np.sqrt(p_ref), w_p * (on_p[1] > 0.5))
    sea_cor, _ = weighted(on_p[0], p_ref, w_p * (on_p[1] <= 0.5))
    dry = (on_p[1] > 0.5) & (p_ref < 250) & (np.abs(p_lat) < 50)[:, None]
    print(f"zonal temperature: largest difference {np.abs(np.diff(t_bands)).max():.1f} K")
    print(f"zonal precipitation: rms {100*p_rms/p_mean:.0f} % of the mean")
    print(f"land temperature: correlation {t_cor:.3f}, rms {t_rms:.1f} K")
    print(f"land precipitation: correlation {p_cor:.3f} (of square roots {root_cor:.3f}), rms {p_rms_land:.0f} mm/yr")
    print(f"sea precipitation: correlation {sea_cor:.3f}")
    print(f"deserts (CMAP below 250 mm/yr, within 50 deg): {np.average(on_p[0][dry], weights=w_p[dry]):.0f} mm/yr, CMAP {np.average(p_ref[dry], weights=w_p[dry]):.0f}")


if __name__ == "__main__":
    main()
