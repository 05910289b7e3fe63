#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"

namespace geo {

struct BiomesParameters {
  bool seasons = true;
  std::string treeline = "thermal";
  double treeline_m = 2000.0;
  double treeline_onset_m = 1700.0;
  double treeline_noise_m = 300.0;
  double treeline_noise_km = 50.0;
  double mountain_m = 1000.0;
  double lapse_rate_k_km = 6.0;
  double riparian_threshold = 0.12;
  double smoothing_km = 10.0;
  bool smooth_corridors = false;
  std::string settlement = "limits";
  double river_weight = 0.0;
  double coast_weight = 0.0;
  std::string coast = "distance";
  double coast_reach_km = 10.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// What grows on a planet, and where people would settle: biomes after Whittaker (1975) with a
/// treeline and river corridors, Köppen-Geiger classes of the harmonic year, net primary
/// productivity (Lieth 1975) and the farming and settlement that it feeds.
std::unique_ptr<Stage> make_biomes_stage(BiomesParameters parameters = {});

}  // namespace geo
