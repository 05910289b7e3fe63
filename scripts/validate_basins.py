#!/usr/bin/env python3
"""Compares the largest drainage basins of a run on Earth's topography with Earth's.

    scripts/validate_basins.py RUN/05-hydrology.nc

A basin is found by a town on its main river: the cell with the largest drainage area within one
degree. Prints its area beside the real one, where its river ends and its discharge there. The
Parana, which shares its mouth with the Uruguay, is measured at the town itself.
"""

import argparse

import netCDF4
import numpy as np

# River, latitude and longitude of a town on it, area in million km2, mean discharge in m3/s.
BASINS = [
    ("Amazon", "Manaus", -3.1, -60.0, 6.1, 209000),
    ("Congo", "Mbandaka", 0.0, 18.3, 3.7, 41000),
    ("Nile", "Khartoum", 15.6, 32.5, 3.3, 2800),
    ("Mississippi", "Memphis", 35.1, -90.1, 3.2, 17000),
    ("Ob", "Khanty-Mansiysk", 61.0, 69.0, 3.0, 12500),
    # Above the Uruguay, which meets it in the estuary.
    ("Parana", "Santa Fe", -31.6, -60.7, 2.7, 17000),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("hydrology")
    path = parser.parse_args().hydrology
    with netCDF4.Dataset(path) as file:
        lat, lon = (np.asarray(file[name][:], float) for name in ("lat", "lon"))
        basin, area, upstream, elevation, discharge = (
            np.ma.filled(file[name][:], 0)
            for name in ("basin_id", "cell_area", "drainage_area", "elevation", "discharge"))
    land = elevation >= 0
    print(f"land {100 * area[land].sum() / area.sum():.2f} % of the area")
    sums = np.bincount(basin[land], area[land])
    print(f"{'river':<12} {'Mkm2':>6} {'Earth':>6} {'ratio':>6}   {'mouth':>15} {'m3/s':>8} {'Earth':>8}")
    for river, _, town_lat, town_lon, real_mkm2, real_m3_s in BASINS:
        near = (np.abs(lat[:, None] - town_lat) < 1) & (np.abs(lon[None, :] - town_lon) < 1) & land
        number = basin.flat[np.argmax(np.where(near, upstream, 0))]
        inside = (basin == number) & land
        mouth = np.unravel_index(np.argmax(np.where(inside, upstream, 0)), basin.shape)
        mkm2 = sums[number] / 1e12
        if river == "Parana":
            mouth = np.unravel_index(np.argmax(np.where(near, upstream, 0)), basin.shape)
            mkm2 = upstream[mouth] / 1e12
        print(f"{river:<12} {mkm2:6.2f} {real_mkm2:6.2f} {mkm2 / real_mkm2:6.2f}   "
              f"{lat[mouth[0]]:6.1f} {lon[mouth[1]]:8.1f} {discharge[mouth]:8.0f} {real_m3_s:8d}")


if __name__ == "__main__":
    main()
