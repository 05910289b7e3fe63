#pragma once

#include <string>

#include "geo/kernels/plates/raster/raster_elevation.hpp"
#include "geo/kernels/plates/raster/raster_tectonics.hpp"

namespace geo {

/// Settings of plates.model = "raster" beyond those that models share. Lengths are shares of the
/// width of the map.
struct RasterParameters {
  RasterSettings model;
  std::int64_t columns = 512, rows = 512;
  std::int64_t plates = 10;
  std::int64_t cycles = 2, cycle_steps = 600, erosion_steps = 60, restart_quiet = 10;
  double drift = 1.0 / 512.0;  ///< of a new plate in a step
  double arc_distance = 10.0 / 512.0;
  double overlap_absolute = 4.0;  ///< of the map's area
  double spin_deg_myr = 0.0, curve_deg_myr = 0.0;
  std::string plate_speed, plate_folding, plate_overlap, plate_erosion;
  double median_land_m = 300.0;
};

}  // namespace geo
