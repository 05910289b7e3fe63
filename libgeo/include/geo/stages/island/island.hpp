#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"

namespace geo {

/// Settings of the island stage, section "island".
struct IslandParameters {
  std::string center = "auto";
  std::string choose_by = "whole";
  std::int64_t nx = 1024;
  std::int64_t ny = 512;
  double cell_m = 400.0;

  std::string detail = "roughness";
  double detail_amplitude = 1.0;
  double detail_hurst = 0.75;
  double least_roughness_m = 2.0;
  double coast_fray = 0.5;
  double old_orogeny_myr = 100.0;
  double plain_slope = 0.005;
  double height_amplitude = 0.15;
  double height_frequency = 8.0;
  std::int64_t height_octaves = 6;
  bool edge_fade = false;
  double edge_margin = 0.06;

  std::int64_t erosion_steps = 10;
  double time_step_yr = 100e3;
  std::string erodibility = "planet";
  double convergent_erodibility_yr = 2e-6;
  double divergent_erodibility_yr = 5e-6;
  double interior_erodibility_yr = 8e-6;
  bool keep_means = true;

  double river_threshold_m3_s = 2.0;
  double river_reference_m3_s = 2000.0;
  double channel_area_km2 = 5.0;

  double lift_reach_km = 10.0;
  double climate_smoothing_km = 0.75;
  double biome_smoothing_km = 1.0;
  double river_weight = 0.25;
  double coast_weight = 0.15;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// A part of the planet seen closer, on an equal-area grid of its own (Tectonica blueprint,
/// section 9): the most interesting window or a given place; elevation by Catmull-Rom interpolation
/// and detail, fractal or after exemplars (Cortial et al. 2019, section 5); some fine steps of
/// erosion with the rivers that enter from outside; then hydrology, climate, biomes and settlement.
///
/// The island inherits the planet: rivers enter with their area and discharge, mean heights of land
/// over each planet cell stay (the crust rises by as much as rivers take away), temperature and
/// rain are the planet's, adapted to the finer topography. Its surface is made on a window that is
/// wider by 5 % of the shorter side all round, whose edge keeps the planet's heights, and which is
/// cropped: the island's own edge has the detail and the valleys of its inside, water leaves over
/// it where it goes on beyond, and what drains back into the island enters as inflow. With
/// `edge_fade` the edges sink below the sea instead. The stages inside take the settings that their
/// namesakes have in the run. Reads a whole planet: Stage::check refuses any other grid, and a
/// planet that it does not fit.
std::unique_ptr<Stage> make_island_stage(IslandParameters parameters = {});

}  // namespace geo
