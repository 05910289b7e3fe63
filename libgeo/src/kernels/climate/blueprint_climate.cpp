#include "geo/kernels/climate/blueprint_climate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/climate/circulation.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

}  // namespace

double sea_exposure(const DisplacedSampler& land, int column, int row, double reach_m) {
  // Rings in the middle of shells of equal area, each turned against the last, so that no straight
  // shore runs along their samples.
  constexpr int kRings = 3, kSpokes = 12;
  double sea = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double reach = reach_m * std::sqrt((ring + 0.5) / kRings);
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double turns = (spoke + (ring + 0.5) / kRings) / kSpokes;
      const double angle = 2.0 * std::numbers::pi * turns;
      sea += 1.0 - land(column, row, reach * std::cos(angle), reach * std::sin(angle));
    }
  }
  return sea / (kRings * kSpokes);
}

double blueprint_temperature_c(const BlueprintClimate& model, double latitude_deg,
                               double elevation_m, double distance_to_coast_km, double pressure_bar,
                               double noise_k, double aerosol_k) {
  const bool ocean = elevation_m < 0.0;
  const double sea_level = model.equator_c - model.cooling_c_deg2 * latitude_deg * latitude_deg;
  const double lapse = model.lapse_k_km * 1.0e-3 * std::max(0.0, elevation_m);
  const double continental = ocean ? 0.0
                                   : model.continental_k_km * distance_to_coast_km *
                                         std::sin(std::abs(latitude_deg) * kRadians);
  return std::clamp(sea_level - lapse + (ocean ? model.ocean_warming_k : 0.0) +
                        model.greenhouse_k * std::log1p(pressure_bar) - continental + noise_k -
                        aerosol_k,
                    -70.0, 55.0);
}

double hadley_precipitation_mm_yr(double latitude_deg) {
  constexpr std::array<double, 8> kLatitude{0, 10, 20, 35, 50, 70, 90, 91};
  constexpr std::array<double, 8> kRain{2000, 2000, 600, 250, 900, 400, 150, 150};
  const double distance = std::min(std::abs(latitude_deg), 90.0);
  std::size_t k = 0;
  while (kLatitude[k + 1] < distance) ++k;
  const double along = (distance - kLatitude[k]) / (kLatitude[k + 1] - kLatitude[k]);
  return kRain[k] + along * (kRain[k + 1] - kRain[k]);
}

void blueprint_orographic_precipitation(const Grid& grid, const BlueprintClimate& model,
                                        std::span<const double> latitude_deg,
                                        std::span<const float> land_fraction,
                                        std::span<const float> height_m,
                                        std::span<float> rain_mm_yr) {
  check_sizes("blueprint_orographic_precipitation", grid.ny(),
              {{"latitude_deg", latitude_deg.size()}});
  check_sizes("blueprint_orographic_precipitation", grid.size(),
              {{"land_fraction", land_fraction.size()},
               {"height_m", height_m.size()},
               {"rain_mm_yr", rain_mm_yr.size()}});
  constexpr double kLandStep_km = 40.0, kShadowStep_km = 20.0;
  const DisplacedSampler land(grid, land_fraction), height(grid, height_m);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const WindDirection wind = three_cell_wind(latitude_deg[j]);
    const double speed = std::max(1e-9, std::hypot(wind.east, wind.north));
    const double back_east = -1000.0 * wind.east / speed, back_north = -1000.0 * wind.north / speed;
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      if (land_fraction[here] <= 0.0F) {
        rain_mm_yr[here] = static_cast<float>(model.windward_mm_yr + model.coastal_mm_yr);
        continue;
      }
      double over_land_km = 0.0;
      for (double d = 0.5 * kLandStep_km; d < model.windward_trace_km; d += kLandStep_km) {
        over_land_km += kLandStep_km * land(i, j, d * back_east, d * back_north);
      }
      const double h = height_m[here];
      double shadow = 0.0;
      for (double d = kShadowStep_km; d <= model.shadow_trace_km; d += kShadowStep_km) {
        const double above = height(i, j, d * back_east, d * back_north) - h;
        if (above > 0.0) shadow = std::max(shadow, above * std::exp(-d / model.shadow_decay_km));
      }
      const double lift =
          h - height(i, j, model.lift_step_km * back_east, model.lift_step_km * back_north);
      rain_mm_yr[here] = static_cast<float>(
          model.windward_mm_yr * std::exp(-over_land_km / model.windward_decay_km) +
          model.coastal_mm_yr * sea_exposure(land, i, j, 1000.0 * model.coastal_reach_km) +
          model.lift_mm_yr_m * std::max(0.0, lift) - model.shadow_mm_yr_m * shadow);
    }
  }
}

double blueprint_precipitation_mm_yr(const BlueprintClimate& model, double hadley_mm_yr,
                                     double relief_mm_yr, double elevation_m,
                                     double distance_to_coast_km, double pressure_bar,
                                     double noise_mm_yr, double aerosol) {
  const double atmosphere = std::sqrt(pressure_bar);
  if (elevation_m < 0.0) return hadley_mm_yr * model.ocean_factor * atmosphere;
  const double altitude = std::max(0.1, std::exp(-elevation_m * model.altitude_decay_1_m));
  const double inland = std::exp(-distance_to_coast_km / model.continental_decay_km);
  const double rain = (hadley_mm_yr * inland + relief_mm_yr) * altitude + noise_mm_yr;
  return std::clamp(rain * atmosphere - aerosol * model.aerosol_mm_yr, 20.0, 4500.0);
}

}  // namespace geo
