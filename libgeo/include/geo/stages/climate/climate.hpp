#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/climate/seasonal_climate.hpp"

namespace geo {

struct ClimateParameters {
  std::string model = "energy-balance";
  SeasonalClimate seasonal;
  BlueprintClimate blueprint;
  double resolution_deg = 2.0;
  double topography_resolution_km = 20.0;
  double latitude_deg = 45.0;
  std::string surroundings = "edge";
  double lift_reach_km = 40.0;
  double lift_height_m = 1.95e+03;
  double temperature_noise_k = 0.0;
  double precipitation_noise_mm_yr = 0.0;
  double noise_wavelength_km = 500.0;
  double wind_speed_m_s = 7.0;
  /// No key of its own: off where nobody reads the currents of the sea, which are then 0. Nothing
  /// else depends on them.
  bool solves_currents = true;
  /// No key of its own: by how much the planet would be colder but for what snow and ice add.
  double colder_k = 0.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// Temperature, winds and rain of a planet from its topography.
///
/// `climate.model = "energy-balance"`: temperature from insolation by an energy-balance model with
/// snow, ice, moist transport and seasons; winds from cells, heat lows and stationary waves; rain
/// from the moisture budget of twelve months on a coarse grid, in which lift and lee of single
/// ranges take their water from the air and leave it there; each coarse cell's rain is then spread
/// over its ranges. On a whole planet all that evaporates rains: the budget has both sides, summed
/// apart, and their `air_water_closing_error`. A part of a planet has no such budget of its own;
/// its is that of the planet around it. `temperature_held_share` is the share of the area whose
/// temperature would leave the range that the air allows, with a warning.
/// `"blueprint"`: the closed formulas of the Tectonica blueprint, section 5, for annual means; the
/// seasons, which it leaves open, come from the former.
std::unique_ptr<Stage> make_climate_stage(ClimateParameters parameters = {});

}  // namespace geo
