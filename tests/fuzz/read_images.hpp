#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "fuzz.hpp"
#include "geo/core/field.hpp"
#include "geo/io/input/dem.hpp"

namespace geo::fuzz {

/// Reads a raster that is no NetCDF as a DEM and as a field.
inline void read_image(const std::string& path, const io::ImageWords& words = {}) {
  expect_value_or_refusal([&] {
    const io::Dem dem = io::read_dem(path, {}, words);
    claim(dem.elevation_m.size() == static_cast<std::size_t>(dem.grid.size()),
          "a DEM has a value for each cell");
    for (const float elevation_m : dem.elevation_m) {
      claim(std::isfinite(elevation_m), "a DEM is of numbers");
    }
    for (int j = 0; j < dem.grid.ny(); ++j) {
      const double area_m2 = dem.grid.area_m2(j);
      claim(area_m2 > 0.0 && std::isfinite(area_m2), "cells have an area");
    }
  });
  expect_value_or_refusal([&] { static_cast<void>(io::read_field(path, field::erodibility, {})); });
}

}  // namespace geo::fuzz
