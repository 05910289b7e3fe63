#pragma once

#include <cstdint>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/kernels/plates/raster/raster_tectonics.hpp"

namespace geo {

/// What heights of a raster world are in metres and years.
struct RasterScale {
  double cell_km = 78.0;
  double step_myr = 2.0;
  double summit_km = 10.0;          ///< that land approaches, S
  double sea_height = 1.0;          ///< height whose top is at sea level, h_s
  double half_height = 18.0;        ///< h - h_s of land that stands at S / 2, c
  double shore_km = 30.0;           ///< thickness of crust whose top is at sea level
  double oceanic_km = 7.0;          ///< thickness of a bare ocean floor
  double oldest_floor_myr = 150.0;  ///< age that the floor approaches, a_0
  double rebound = 6.6;             ///< thickness of a root per height of land
};

/// Heights have no unit of their own: chooses h_s so that `ocean_share` of some heights, each of
/// which stands for the same area, lies below it, and c so that the median of the rest stands at
/// `median_land_m`. With an `ocean_share` of 1 or more, h_s stays 1.
void fit_scale(std::vector<float> heights, double ocean_share, double median_land_m,
               RasterScale& scale);

/// Elevation of land, m: S y / (1 + y) with y = ((h - h_s) / c)^1.5, so that plains stay low and no
/// pile of crust outgrows the planet. Below sea level it is that of ocean floor of this age (Stein
/// & Stein 1992), reduced by the crust there is: -d(a) (1 - t), t = (h - h_0) / (h_s - h_0).
[[nodiscard]] double raster_elevation_m(double height, double age_myr, double ocean_crust,
                                        const RasterScale& scale);
/// Thickness of the crust, m: 30 km where land begins, its root 6.6 times what stands out, thinning
/// linearly with h to bare ocean floor.
[[nodiscard]] double raster_thickness_m(double height, double ocean_crust,
                                        const RasterScale& scale);
/// Age of floor, Myr, from the steps since it was made: a_0 tanh(a / a_0).
[[nodiscard]] double raster_age_myr(double steps, const RasterScale& scale);

/// The last orogeny of some crust: that of two continents, or of magma that rose inland. Land that
/// never folded is older than the model's time.
struct RasterOrogeny {
  OrogenyType type = OrogenyType::none;
  double age_myr = 0.0;
};
[[nodiscard]] RasterOrogeny raster_orogeny(const RasterCrust& crust, double now,
                                           const RasterScale& scale);

/// A raster world in the vocabulary of the planet, one value a cell.
struct RasterElevation {
  RasterWorld world;
  std::vector<float> height, elevation_m, thickness_m, age_myr, orogeny_age_myr;
  std::vector<std::int8_t> orogeny;  ///< OrogenyType
  std::vector<std::int16_t> plate;
  /// Unit vectors along folds and ridges, or zero: along the contours of land and of the floor's
  /// age, each smoothed over a few cells.
  std::vector<float> fold_x, fold_y, ridge_x, ridge_y;
};
RasterElevation raster_elevation(const RasterTectonics& model, const RasterScale& scale);

/// Velocity of a plate at a place of the world, cells per step.
struct RasterVelocity {
  double x, y;
};
[[nodiscard]] RasterVelocity raster_velocity(const RasterPlate& plate, const RasterWorld& world,
                                             double column, double row);

/// Cubic B-spline through the values of cells about a place, in cells; centres are at halves.
/// Smooth (twice differentiable) where the map is a staircase; it rounds what is finer than two
/// cells.
[[nodiscard]] double smooth_value(const RasterWorld& world, const std::vector<float>& values,
                                  double column, double row);

}  // namespace geo
