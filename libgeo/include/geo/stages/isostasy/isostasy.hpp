#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/kernels/crust/airy.hpp"
#include "geo/kernels/crust/flexure.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"

namespace geo {

/// Settings of the stage isostasy, section "isostasy".
struct IsostasyParameters {
  std::string crust = "margins";
  std::string compensation = "flexural";
  ColumnDensities density;
  ElasticPlate plate{.thickness_m = 20e3};
  double elastic_thickness_km = 20.0;

  double convergent_length_km = 200.0;
  double divergent_length_km = 150.0;
  double transform_length_km = 100.0;
  double weakness_length_km = 300.0;
  double deformation_smoothing_km = 30.0;

  double continental_km = 36.4;
  double ocean_depth_m = 3750.0;
  double oceanic_km = 7.0;
  double thickness_noise_km = 5.4;
  double collision_km = 20.5;
  double collision_shortening = 0.1;
  double subduction_shortening = 0.033;
  double front_shortening = 0.55;
  double arc_km = 13.0;
  double rift_km = 20.0;
  double transpression_km = 2.0;
  double crust_smoothing_km = 70.0;
  double coast_smoothing_km = 80.0;

  double lithosphere = 1.22;
  double craton_compensation = 0.958;
  double swell_m = 345.0;
  double ocean_swell_m = 430.0;
  double margin_tilt_m = 760.0;
  double margin_tilt_km = 260.0;
  double relict_km = 5.2;
  double heat_m = 950.0;
  double thermal_coefficient = 0.02;
  double shelf_depth_m = 90.0;
  double shelf_edge = 0.78;
  double trench_depth_m = 1700.0;
  double slab_trench_m = 4200.0;
  double seamount_m = 1800.0;
  double seafloor_roughness_m = 130.0;
  double fracture_m = 0.0;
  double fracture_spacing_km = 90.0;
  double abyssal_hills_m = 0.0;
  double fabric_age_myr = 45.0;
  double land_roughness_m = 48.0;
  double noise_factor = 1.0;
  std::string detail = "noise";
  double detail_longest_km = 150.0;
  double detail_amplitude = 2.0;
  double old_orogeny_myr = 100.0;
  double plain_slope = 0.002;
  double basin_fill = 0.82;
  DeepSediment sediment;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// Crust and how it floats: what plate boundaries do to it, how thick and dense it is, what rock is
/// on top, and how high it stands in balance with the mantle, the sea and its own stiffness.
std::unique_ptr<Stage> make_isostasy_stage(IsostasyParameters parameters = {});

}  // namespace geo
