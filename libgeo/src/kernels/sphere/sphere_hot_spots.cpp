#include <algorithm>
#include <cmath>

#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {

/// Volcanoes grow on the ocean floor that lies over a plume and move away with it: chains of
/// islands and seamounts, the older the farther.
void SphereTectonics::erupt() {
  constexpr double kReach = 2.5;  // half widths
  SphereCrust& crust = state_.crust;
  std::vector<std::int32_t> around;
  for (const auto& [plume, growth_mm_yr] : state_.plumes) {
    if (growth_mm_yr <= 0.0) continue;
    const int plate = plate_at(plume);
    if (plate < 0) continue;
    for (std::size_t p = 0; p < state_.plates.size(); ++p) {
      if (!state_.plates[p].alive || state_.root(static_cast<int>(p)) != plate) continue;
      const Vector3 here = back(frame_[p], plume);
      around.assign(1, mesh_->samples().nearest(here));
      for (std::size_t k = 0; k < around.size(); ++k) {
        const std::int32_t i = around[k];
        const double far_km =
            settings_.radius_km * angle_between(mesh_->samples().position(i), here);
        if (k > 0 && far_km > kReach * settings_.plume_km) continue;
        for (const std::int32_t j : mesh_->neighbours(i)) {
          if (std::find(around.begin(), around.end(), j) == around.end()) around.push_back(j);
        }
        if (crust.plate[i] != static_cast<std::int16_t>(p) || crust.continental[i] != 0 ||
            hidden_[i] != 0) {
          continue;
        }
        const double grown_m = 1e3 * growth_mm_yr * settings_.law.step_myr *
                               std::exp2(-std::pow(far_km / settings_.plume_km, 2));
        const double top_m = 1e3 * settings_.plume_top_km;
        const double z_m = crust.elevation_m[i];
        if (z_m < top_m) crust.elevation_m[i] = static_cast<float>(std::min(top_m, z_m + grown_m));
      }
    }
  }
}

}  // namespace geo
