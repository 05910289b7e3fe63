#include "sea_floor_fabric.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/kernels/noise/oriented_noise.hpp"
#include "geo/kernels/numerics/shapes.hpp"

namespace geo {
namespace {

/// Along the ridge that made the floor, on the coarse grid.
Orientation ridges(const Crust<float>& crust, const CoarseGrid& coarse,
                   std::span<const float> ridge_east, std::span<const float> ridge_north) {
  constexpr double kSmoothing_m = 100e3, kLeast = 0.05;
  const Grid& grid = coarse.grid();
  Orientation along = level_lines(grid, coarse.middle(crust.in.age_myr));
  if (!ridge_east.empty()) {
    const Orientation given =
        orientation_of(grid, coarse.middle(ridge_east), coarse.middle(ridge_north), kLeast);
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (given.cosine[cell] == 0.0F && given.sine[cell] == 0.0F) continue;
      along.cosine[cell] = given.cosine[cell];
      along.sine[cell] = given.sine[cell];
    }
  }
  const auto share = coarse.middle(std::span<const float>(crust.fraction));
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (share[cell] > 0.5F) along.cosine[cell] = along.sine[cell] = 0.0F;
  }
  smooth(grid, along, kSmoothing_m);
  return along;
}

}  // namespace

void engrave_sea_floor(const Crust<float>& crust, const CoarseGrid& coarse,
                       std::span<const float> ridge_east, std::span<const float> ridge_north) {
  const IsostasyParameters& p = crust.parameters;
  if (p.fracture_m <= 0.0 && p.abyssal_hills_m <= 0.0) return;
  const Orientation along = ridges(crust, coarse, ridge_east, ridge_north);
  std::vector<float> relief(crust.grid.size(), 0.0F);
  const auto add = [&](const Orientation& crests, const OrientedBand& band, double height_m,
                       std::string_view stream) {
    add_oriented_noise(crust.grid, coarse.grid(), crests, band, height_m, crust.seed, stream,
                       relief);
  };
  const double zone_km = p.fracture_spacing_km;
  add(across(along),
      {.wavelength_km = zone_km, .width_km = 0.7 * zone_km, .length_km = 4.0 * zone_km},
      p.fracture_m, "isostasy.fractures");
  // Hills are lower the narrower they are; those narrower than the cells are left out.
  double hill_km = 48.0, height_m = p.abyssal_hills_m;
  for (const char* stream : {"isostasy.hills_1", "isostasy.hills_2", "isostasy.hills_3"}) {
    add(along, {.wavelength_km = hill_km, .width_km = 0.9 * hill_km, .length_km = 2.4 * hill_km},
        height_m, stream);
    hill_km *= 0.5;
    height_m *= 0.6;
  }
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < crust.grid.size(); ++cell) {
    float& z = crust.elevation_m[cell];
    const double depth = smooth_step(300.0, 2000.0, -static_cast<double>(z));
    if (depth <= 0.0) continue;
    const double fresh = std::exp(-static_cast<double>(crust.in.age_myr[cell]) / p.fabric_age_myr);
    const double floor = 1.0 - smooth_step(0.05, 0.4, static_cast<double>(crust.fraction[cell]));
    z = std::min(-1.0F, z + static_cast<float>(depth * fresh * floor * relief[cell]));
  }
}

}  // namespace geo
