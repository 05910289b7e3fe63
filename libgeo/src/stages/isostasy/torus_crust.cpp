#include "torus_crust.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {
namespace {

/// Distance to the nearest marked cell, km; very far where there is none.
std::vector<float> distance_to_km(const Grid& grid, std::span<const std::uint8_t> marked) {
  constexpr float kNone_km = 1e9F;
  std::vector<float> distance(grid.size(), kNone_km), side(grid.size());
  if (std::find(marked.begin(), marked.end(), 1) == marked.end()) return distance;
  for (Index cell = 0; cell < grid.size(); ++cell) side[cell] = marked[cell] != 0 ? -1.0F : 1.0F;
  distance_to_coast(grid, side, distance);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    distance[cell] = marked[cell] != 0 ? 0.0F : 1e-3F * distance[cell];
  }
  return distance;
}

/// Strength of the boundaries of one type about each place, dying away over a length.
void deform(const Crust<float>& crust, BoundaryType type, double length_km,
            std::span<float> deformation) {
  const Grid& grid = crust.grid;
  std::vector<std::uint8_t> marked(grid.size());
  std::vector<float> count(grid.size()), strength(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    marked[cell] = crust.in.boundary_type[cell] == static_cast<std::int8_t>(type);
    count[cell] = marked[cell];
    strength[cell] = marked[cell] != 0 ? crust.in.boundary_strength[cell] : 0.0F;
  }
  const std::vector<float> far_km = distance_to_km(grid, marked);
  smooth(grid, count, 1e3 * length_km);
  smooth(grid, strength, 1e3 * length_km);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    constexpr float kNone = 1e-6F;
    const float about = strength[cell] / std::max(count[cell], kNone);
    deformation[cell] =
        std::clamp(about * std::exp(-far_km[cell] / static_cast<float>(length_km)), 0.0F, 1.0F);
  }
}

}  // namespace

void take_torus_crust(const Crust<float>& crust) {
  const IsostasyParameters& p = crust.parameters;
  if (crust.in.made_elevation_m.empty()) {
    throw InputError("isostasy: crust = \"" + p.crust +
                     "\" needs a whole sphere; on a torus it must be \"simulated\"");
  }
  deform(crust, BoundaryType::convergent, p.convergent_length_km, crust.convergent);
  deform(crust, BoundaryType::divergent, p.divergent_length_km, crust.divergent);
  deform(crust, BoundaryType::transform, p.transform_length_km, crust.transform);
  const Grid& grid = crust.grid;
  std::vector<std::uint8_t> boundary(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    boundary[cell] = crust.in.boundary_type[cell] != 0;
  }
  const std::vector<float> far_km = distance_to_km(grid, boundary);
  const auto weakness_km = static_cast<float>(p.weakness_length_km);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    crust.weakness[cell] = std::exp(-far_km[cell] / weakness_km);
    crust.elevation_m[cell] = crust.in.made_elevation_m[cell];
    if (crust.in.has_density) continue;
    crust.density[cell] = static_cast<float>(
        p.density.oceanic_crust +
        (p.density.continental_crust - p.density.oceanic_crust) * crust.fraction[cell]);
  }
}

}  // namespace geo
