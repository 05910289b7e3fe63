#include "blueprint_crust.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"

namespace geo {
namespace {

/// Calls `at_cell(cell, unit vector)` for every cell.
template <class AtCell>
void for_each_cell(const Grid& grid, AtCell&& at_cell) {
#pragma omp parallel for schedule(dynamic, 4)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) at_cell(grid.cell(i, j), grid.unit_vector(i, j));
  }
}

/// Coasts are smoothed, perturbed where they are neither land nor sea, and smoothed again.
void perturb_coasts(const Crust<float>& crust) {
  smooth(crust.grid, crust.fraction, 1e3 * crust.parameters.coast_smoothing_km);
  const Noise coast(crust.seed, "isostasy.coast");
  for_each_cell(crust.grid, [&](Index cell, const std::array<double, 3>& at) {
    float& share = crust.fraction[cell];
    const double noise =
        0.10 * coast.value(at, 4) + 0.04 * coast.value(at, 8) + 0.01 * coast.value(at, 16);
    const double margin = 1.0 - std::abs(2.0 * share - 1.0);
    share = static_cast<float>(std::clamp(share + noise * margin, 0.0, 1.0));
  });
  constexpr double kThreePasses_m = 26e3;
  smooth(crust.grid, crust.fraction, kThreePasses_m);
}

void read_deformation(const Crust<float>& crust, const CoarseGrid& coarse,
                      const Tectonics<float>& t) {
  const Grid& grid = crust.grid;
  const CubicRows rows(coarse.grid(), grid);
  ParallelErrors errors;
#pragma omp parallel
  {
    std::vector<float> scratch;
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        const auto read = [&](const std::vector<float>& from, std::span<float> to) {
          rows.read(from, j, to.subspan(grid.cell(0, j), grid.nx()), scratch);
        };
        read(t.convergent, crust.convergent);
        read(t.divergent, crust.divergent);
        read(t.transform, crust.transform);
        read(t.weakness, crust.weakness);
      });
    }
  }
  errors.rethrow();
}

void draw_thickness(const Crust<float>& crust) {
  const IsostasyParameters& p = crust.parameters;
  const Noise broad(crust.seed, "isostasy.crust"), fine(crust.seed, "isostasy.crust_again");
  for_each_cell(crust.grid, [&](Index cell, const std::array<double, 3>& at) {
    for (const auto& field :
         {crust.fraction, crust.convergent, crust.divergent, crust.transform, crust.weakness}) {
      field[cell] = std::clamp(field[cell], 0.0F, 1.0F);
    }
    const double share = crust.fraction[cell];
    if (share > 0.1) crust.convergent[cell] *= crust.weakness[cell];
    const double noise = p.thickness_noise_km * (broad.value(at, 3) + 0.5 * fine.value(at, 6));
    const double base = p.oceanic_km + (p.continental_km + noise - p.oceanic_km) * share;
    const double change =
        crust.convergent[cell] * (p.arc_km + (p.collision_km - p.arc_km) * share) -
        crust.divergent[cell] * p.rift_km + crust.transform[cell] * p.transpression_km;
    crust.thickness_m[cell] = static_cast<float>(1e3 * std::clamp(base + change, 5.0, 75.0));
  });
  smooth(crust.grid, crust.thickness_m, 1e3 * p.crust_smoothing_km);
}

/// Height of a column: dry as the blueprint has it (3.3), or on the ridge's datum with the sea's
/// load and a lithosphere as cold as the floor is old.
double balanced_m(const Crust<float>& crust, bool is_dry, Index cell) {
  const IsostasyParameters& p = crust.parameters;
  const double thickness_m = crust.thickness_m[cell], density = crust.density[cell];
  if (is_dry) return airy_freeboard_m(thickness_m, density, p.density.mantle);
  const double share = crust.fraction[cell];
  const double floor =
      crust.datum().lithosphere_of_depth(ocean_depth_m(std::min(crust.in.age_myr[cell], 200.0F)));
  const double lithosphere = share * p.lithosphere + (1.0 - share) * floor;
  return crust.datum().loaded(crust.datum().dry_elevation_m(thickness_m, density, lithosphere));
}

void draw_heights(const Crust<float>& crust) {
  const IsostasyParameters& p = crust.parameters;
  const bool is_dry = p.compensation == "airy-dry";
  const Noise overlay(crust.seed, "isostasy.overlay");
  for_each_cell(crust.grid, [&](Index cell, const std::array<double, 3>& at) {
    const double share = crust.fraction[cell];
    const double density =
        p.density.oceanic_crust + (p.density.continental_crust - p.density.oceanic_crust) * share;
    crust.density[cell] =
        static_cast<float>(density * (1.0 - p.thermal_coefficient * crust.in.heat[cell]));
    const double noise = 60.0 * overlay.value(at, 3) + 35.0 * overlay.value(at, 6) +
                         18.0 * overlay.value(at, 12) + 7.0 * overlay.value(at, 24);
    crust.elevation_m[cell] =
        static_cast<float>(balanced_m(crust, is_dry, cell) + p.noise_factor * noise);
  });
}

}  // namespace

void draw_blueprint_crust(const Crust<float>& crust, const CoarseGrid& coarse,
                          const Tectonics<float>& t) {
  perturb_coasts(crust);
  read_deformation(crust, coarse, t);
  draw_thickness(crust);
  draw_heights(crust);
}

}  // namespace geo
