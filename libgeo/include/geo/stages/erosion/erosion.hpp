#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "geo/core/stage.hpp"

namespace geo {

/// Settings of the erosion stage, section "erosion".
struct ErosionParameters {
  std::int64_t steps = 10;
  double time_step_yr = 2e6;
  std::int64_t route_every = 1;
  double area_exponent = 0.5;
  double slope_exponent = 1.0;
  double erodibility_yr = 2e-6;
  double diffusivity_m2_yr = 0.02;
  std::string model = "sediment";
  // Of the model "sediment".
  double deposition = 1.0;
  double dispersal_km = 300.0;
  double wave_base_m = 120.0;
  double highstand_yr = 7000.0;
  std::string discharge = "rain";
  // Of the discharge "rain".
  double reference_runoff_mm_yr = 300.0;
  double least_runoff_mm_yr = 5.0;
  std::int64_t climates = 2;
  std::string ice_model = "plastic";
  // Of the ice, where the discharge is "rain".
  double ice_stress_kpa = 80.0;
  double ice_melt_mm_k_d = 8.0;
  double snow_melt_mm_k_d = 3.0;
  double glacial_time_yr = 2.6e6;
  double glacial_share = 0.3;
  double glacial_cooling_k = 6.0;
  std::int64_t glacial_cycles = 4;
  double abrasion = 7e-7;
  double overdeepening = 1.5;
  double till_share = 0.3;
  double grounding_m = 300.0;
  double strait_sill_m = 300.0;
  double strait_drawdown = 0.2;
  double strait_land_km = 3000.0;
  double strait_depth_m = 60.0;
  double strait_width_km = 80.0;
  double strait_sea_km2 = 5e4;
  std::string flow_routing = "mfd";
  double flow_exponent = 1.1;
  std::string depressions = "fill";
  double erodibility_factor = 0.55;
  double reference_cell_km = 10.0;
  double subgrid_exponent = 0.38;
  double uplift_mm_yr = 0.0;
  std::string uplift_from = "shortening";
  double convergent_uplift_mm_yr = 0.06;
  double divergent_uplift_mm_yr = -0.02;
  double transform_uplift_mm_yr = 0.03;
  double uplift_speed_cm_yr = 0.0;
  double damage = 6.0;
  double rebound_fraction = 0.8;
  double rebound_length_km = 100.0;
  double rebound_time_yr = 1e6;
  double noise_injection_m = 0.0;
  double warping_m = 25.0;
  double warping_km = 450.0;
  double relaxation_fraction = 0.0;
  double land_smoothing_km = 0.0;
  std::string hypsometry = "none";
  double hypsometry_median_m = 400.0;
  double hypsometry_smoothing_km = 31.0;
  double detail_noise = 0.0;

  [[nodiscard]] std::vector<Parameter> declarations();
  /// Whether rivers deposit what they cannot carry.
  [[nodiscard]] bool deposits() const { return model == "sediment" && deposition > 0.0; }
  /// Whether ice is modelled.
  [[nodiscard]] bool freezes() const {
    return ice_model != "none" && discharge == "rain" && steps > 0;
  }
};

/// Landscape evolution, dz/dt = U - K A^m S^n + (G / A) Q + kappa lap(z) on land (Braun & Willett
/// 2013; Davy & Lague 2009; Hergarten 2020), with the sea and open edges as base level. The model
/// "detachment" has G = 0: what rivers take is lost. Each step: route the water, raise the
/// ground, let rivers cut and, with "sediment", deposit (implicit, any m and n), let hillslopes
/// creep (implicit), deposit on the sea floor what rivers bring there, and let isostasy respond to
/// erosion and deposition. With the discharge "rain" the area A is weighted by runoff over the
/// reference, for which the climate stage is run on a coarse grid, `climates` times; on whole
/// planets whose run has that stage. There ice forms in the last `glacial_time_yr`, in cold and
/// warm times by turns, and works on its bed after the rivers; that of today lies on the finished
/// bed, and elevation is then its surface. Before the first step and after the last straits join
/// seas behind low sills to the ocean of a whole planet; those that stay cut off fill to the brim
/// and become land. In the last step rivers build deltas. With no steps elevation stays as it is
/// and the present rate of incision is reported.
std::unique_ptr<Stage> make_erosion_stage();

}  // namespace geo
