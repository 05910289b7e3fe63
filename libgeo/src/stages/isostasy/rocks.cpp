#include "geo/stages/isostasy/rocks.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/noise/noise_row.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

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

/// Whether nothing deformed the continent here.
bool is_covered(const Crust<float>& crust, Index cell) {
  return crust.fraction[cell] >= 0.5F && crust.convergent[cell] <= 0.15F &&
         crust.divergent[cell] <= 0.3F && crust.transform[cell] <= 0.2F;
}

/// Rock of sea floor and of deformed continents.
RockType basement(const Crust<float>& crust, Index cell) {
  if (crust.fraction[cell] < 0.5F) {
    return crust.convergent[cell] > 0.3F ? RockType::schist : RockType::basalt;
  }
  if (crust.convergent[cell] > 0.5F) return RockType::granite;
  if (crust.convergent[cell] > 0.15F) return RockType::quartzite;
  return crust.divergent[cell] > 0.3F ? RockType::sandstone : RockType::schist;
}

}  // namespace

void classify_rock(const Crust<float>& crust) {
  const Grid& grid = crust.grid;
  const Noise strata(crust.seed, "isostasy.strata");
  const double frequency = crust.radius_km() / 700.0;
  ParallelErrors errors;
#pragma omp parallel
  {
    NoiseRow row(grid);
    auto layer = errors.make<std::vector<float>>(grid.nx());
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        row.choose(j, [&](int i) { return is_covered(crust, grid.cell(i, j)); });
        row.fbm(strata, frequency, 4, 0.5, layer);
        for (int i = 0; i < grid.nx(); ++i) {
          const Index cell = grid.cell(i, j);
          const RockType rock = is_covered(crust, cell) ? cover(layer[i]) : basement(crust, cell);
          crust.rock[cell] = static_cast<std::int8_t>(rock);
          const float fault = crust.in.boundary_type[cell] != 0 ? 1.5F : 1.0F;
          // Smoothing must not lose digits: millionths become ones.
          crust.erodibility[cell] = 1e6F * kErodibility[static_cast<int>(rock)] * fault;
        }
      });
    }
  }
  errors.rethrow();
  constexpr double kThreePasses_m = 26e3;
  smooth(grid, crust.erodibility, kThreePasses_m);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    crust.erodibility[cell] = 1e-6F * std::clamp(crust.erodibility[cell], 0.5F, 4.5F);
  }
}

}  // namespace geo
