#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/kernels/noise/great_circles.hpp"
#include "geo/kernels/plates/growth/continents.hpp"
#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/plates/sphere/sphere_settings.hpp"
#include "geo/kernels/plates/sphere/sphere_start.hpp"
#include "geo/stages/plates/raster_parameters.hpp"

namespace geo {

/// What orders places by height, where a hypsography gives the heights.
struct HypsographicRanking {
  std::string by = "great-circles";
  CircleCuts cuts{.offset = 0.5};
  double smoothing_km = 0.0;
  double roughness = 0.02;
};

/// Settings of the stage plates, section "plates".
struct PlatesParameters {
  std::string model = "growth";
  PlateGrowth growth;
  bool no_net_rotation = true;
  std::int64_t evolution_steps = 6;
  double boundary_smoothing_km = 180.0;
  double boundary_width_km = 80.0;
  double outline_bending_km = 70.0;
  std::string continents = "cratons";
  Cratons cratons;
  double land_buffer = 0.20;
  double coast_roughness = 0.9;
  double coast_wavelength_km = 2100.0;
  double passive_margin_km = 320.0;
  double active_margin_km = 130.0;
  double oldest_floor_myr = 150.0;
  double plumes = 12.0;
  double orogeny_reach_km = 700.0;

  // Of the model "sphere".
  std::int64_t samples = 500'000;
  std::int64_t motion_samples = 0;
  double time_myr = 250.0;
  double spin_up_myr = 0.0;
  double frames_myr = 0.0;
  double slab_trench_m = 0.0;
  std::string initial_continents = "dispersed";
  std::string given_motions = "held";
  std::string uplift_profile = "piecewise";
  std::string overlap = "crust";
  std::string collisions = "terranes";
  std::string uplift_sources = "nearest";
  std::string accretion = "wedge";
  std::string rifting = "any";
  std::string landscape = "none";
  double climate_myr = 10.0;
  std::string erosion = "height";
  std::string sea_level = "fixed";
  std::string ocean_floor = "damping";
  SphereSettings sphere;
  SphereStart start;

  // Of the model "hypsography", and of "sphere" that starts from one.
  std::string initial_elevation = "noise";
  HypsographicRanking ranking;
  // Of the model "raster".
  RasterParameters raster;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// Plates of a planet: who belongs to which, how each moves, what happens at their boundaries, how
/// old the sea floor is and where continents are. Everything is a function of the seed and of
/// places on the sphere: the size of the grid's cells changes only how finely it is seen.
std::unique_ptr<Stage> make_plates_stage(PlatesParameters parameters = {});

}  // namespace geo
