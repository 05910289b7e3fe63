#pragma once

#include <cmath>
#include <limits>

#include "calibration/result.hpp"

namespace geo::calibration {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Sea floor, shelf and land: a curve of two levels whose sea floor and land are moved.
inline Curve made_up_curve(double sea_floor_m, double land_m, int bins = 64) {
  Curve curve;
  for (int k = 0; k < bins; ++k) {
    const double share = (k + 0.5) / bins;
    const double land = 1.0 / (1.0 + std::exp(-(share - 0.66) / 0.03));
    const double peaks = 4200.0 * std::exp((share - 1.0) / 0.03);
    const double trenches = -3800.0 * std::exp(-share / 0.015);
    curve.elevation_m.push_back((1.0 - land) * (sea_floor_m + 2200.0 * share) +
                                land * (land_m + 900.0 * (share - 0.66)) + peaks + trenches);
  }
  return curve;
}

inline void add_residuals(Result& result) {
  const auto bins = result.target.elevation_m.size();
  for (std::size_t k = 0; k < bins; ++k) {
    result.residuals.push_back({"hypsometry " + std::to_string(k + 1), "m", (k + 0.5) / bins,
                                result.target.elevation_m[k], result.before.elevation_m[k],
                                result.after.elevation_m[k], 60.0 + 400.0 * (k + 1 == bins)});
  }
  result.residuals.push_back({"land_fraction", "1", kUnknown, 0.29, 0.34, 0.293, 0.01});
  result.residuals.push_back({"erosion_rate", "mm yr-1", kUnknown, 0.06, 0.15, 0.083, 0.01});
}

inline void add_iterations(Result& result) {
  for (int start = 0; start < 3; ++start) {
    double cost = 900.0 * (start + 1);
    for (int number = 0; number < 9; ++number) {
      const bool accepted = !(number == 6 && start == 0);
      if (accepted) cost = 40.0 + (cost - 40.0) * 0.45;
      result.iterations.push_back({start,
                                   number,
                                   cost,
                                   3.0 * std::sqrt(cost),
                                   std::pow(0.6, number),
                                   accepted,
                                   4.2,
                                   {38.0, 1.2, 0.05}});
    }
    result.starts.push_back({{30.0 + 5.0 * start, 1.22, 0.1},
                             {38.2, 1.219, 0.0512},
                             cost,
                             start < 2,
                             9,
                             start < 2 ? "the target is met" : "9 iterations did not suffice"});
  }
}

/// A fit of three parameters with all that a report can show.
inline Result made_up_result() {
  Result result;
  result.target_name = "earth";
  result.preset_or_config = "preset earth";
  result.grid = "512x256";
  result.held_out_grid = "1024x512";
  result.objective = "mean";
  result.converged = true;
  result.ending = "The cost changed by less than 0.1 % over two steps.";
  result.warnings = {
      "erosion.erodibility_factor and isostasy.lithosphere <are hardly told apart> & "
      "their correlation is 0.97."};
  result.parameters = {
      {"isostasy.collision_km", "km", "thickening of crust where continents collide", 30.0,
       38.1846251923, 0.0, 60.0, false, false, 0.0, 0.0, 0.8, 1.6},
      {"isostasy.lithosphere", "1", "mass of the mantle lithosphere below continents", 1.22, 1.219,
       0.5, 2.0, false, true, 1.22, 0.05, kUnknown, kUnknown},
      {"erosion.erodibility_factor", "1", "factor of the erodibility of rock", 0.1, 0.0512, 0.01,
       1.0, true, false, 0.0, 0.0, 0.0021, 0.004}};
  result.correlation = {{1.0, 0.31, -0.62}, {0.31, 1.0, 0.97}, {-0.62, 0.97, 1.0}};
  result.directions = {
      {48.2, {0.93, -0.2, 0.3}}, {9.4, {-0.32, 0.15, 0.935}}, {0.61, {0.1, 0.79, -0.6}}};
  result.condition = 79.0;
  result.profiles = {{"isostasy.collision_km", {34, 36, 38, 40, 42}, {62, 46, 40.1, 45, 64}, {}},
                     {"erosion.erodibility_factor",
                      {0.02, 0.03, 0.05, 0.08, 0.12},
                      {43.1, 41.0, 40.0, 41.3, 44.0},
                      {}}};
  result.target = made_up_curve(-5200.0, 480.0);
  result.before = made_up_curve(-4600.0, 820.0);
  result.after = made_up_curve(-5120.0, 530.0);
  add_residuals(result);
  add_iterations(result);
  for (int seed = 1; seed <= 4; ++seed) {
    result.fitted.push_back({seed, 300.0 + 20.0 * seed, 70.0 + 8.0 * seed});
    result.held_out.push_back({8 + seed, 310.0 + 15.0 * seed, 80.0 + 9.0 * seed});
    result.held_out_resolution.push_back({seed, 305.0 + 18.0 * seed, 88.0 + 7.0 * seed});
  }
  result.cost_before = 900.0;
  result.cost_after = 40.0;
  result.noise_m = 61.0;
  result.seconds = 212.0;
  result.forward_runs = 61;
  result.jacobians = 9;
  result.seconds_per_forward = 0.9;
  result.seconds_per_jacobian = 2.7;
  return result;
}

}  // namespace geo::calibration
