#include "rocks.hpp"

#include <algorithm>
#include <array>

#include "geo/kernels/noise.hpp"
#include "geo/kernels/smoothing.hpp"

namespace geo {
namespace {

/// Of each rock type, yr-1.
constexpr std::array<float, 6> kErodibility{1.0e-6F, 1.2e-6F, 0.5e-6F, 0.8e-6F, 2.0e-6F, 3.0e-6F};

/// Cover where nothing deforms: layers of sediment and windows of basement.
RockType cover(float strata) {
  return strata < -0.06F  ? RockType::limestone
         : strata < 0.06F ? RockType::sandstone
                          : RockType::granite;
}

}  // namespace

void classify_rock(const Crust& crust) {
  const Grid& grid = crust.grid;
  const Noise strata(crust.seed, "isostasy.strata");
  const double frequency = crust.radius_km / 700.0;
#pragma omp parallel for schedule(dynamic, 4)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      RockType rock = RockType::basalt;
      if (crust.fraction[cell] < 0.5F) {
        if (crust.convergent[cell] > 0.3F) rock = RockType::schist;
      } else if (crust.convergent[cell] > 0.5F) {
        rock = RockType::granite;
      } else if (crust.convergent[cell] > 0.15F) {
        rock = RockType::quartzite;
      } else if (crust.divergent[cell] > 0.3F) {
        rock = RockType::sandstone;
      } else if (crust.transform[cell] > 0.2F) {
        rock = RockType::schist;
      } else {
        rock = cover(strata.fbm(grid.unit_vector(i, j), frequency, 4));
      }
      crust.rock[cell] = static_cast<std::int8_t>(rock);
      const float fault = crust.boundary_type[cell] != 0 ? 1.5F : 1.0F;
      // Smoothing must not lose digits: millionths become ones.
      crust.erodibility[cell] = 1e6F * kErodibility[static_cast<int>(rock)] * fault;
    }
  }
  constexpr double kThreePasses_m = 26e3;
  smooth(grid, crust.erodibility, kThreePasses_m);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    crust.erodibility[cell] = 1e-6F * std::clamp(crust.erodibility[cell], 0.5F, 4.5F);
  }
}

}  // namespace geo
