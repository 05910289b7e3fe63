#include "geo/stages/erosion/seas.hpp"

#include <algorithm>
#include <cmath>

#include "geo/kernels/landscape/straits.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/water/sea_parts.hpp"

namespace geo {

bool join_seas(const ErosionParameters& p, const Grid& grid, std::span<float> elevation_m) {
  if (p.strait_sill_m <= 0.0 || grid.topology() == Topology::plane) return false;
  const StraitLaw law{.sill_m = p.strait_sill_m,
                      .drawdown = p.strait_drawdown,
                      .land_m = 1e3 * p.strait_land_km,
                      .depth_m = p.strait_depth_m,
                      .width_m = 1e3 * p.strait_width_km,
                      .least_m2 = 1e6 * p.strait_sea_km2};
  return open_straits(grid, law, elevation_m) > 0;
}

std::vector<std::uint8_t> landlocked_cells(const ErosionParameters& p, const Grid& grid,
                                           std::span<const float> elevation_m) {
  if (p.strait_sill_m <= 0.0 || grid.topology() == Topology::plane) return {};
  const NumberedSeas seas = number_seas(grid, elevation_m);
  if (seas.parts.size() < 2) return {};
  std::vector<std::uint8_t> cells(elevation_m.size());
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = seas.part_of_cell[c] > 0 ? 1 : 0;
  return cells;
}

double share_of_sea(const Grid& grid, std::span<const float> elevation_m) {
  return area_sum<double>(grid, [&](Index c) { return elevation_m[c] < 0.0F ? 1.0 : 0.0; }) /
         grid.total_area_m2();
}

float moved_sea_level_m(const ErosionParameters& p, const Grid& grid,
                        std::span<const float> elevation_m, double share) {
  const bool moves = p.strait_sill_m > 0.0 && grid.topology() != Topology::plane;
  if (!moves || share <= 0.0 || share >= 1.0) return 0.0F;
  return static_cast<float>(level_for_fraction(grid, elevation_m, share));
}

bool keep_sea_share(const ErosionParameters& p, const Grid& grid, std::span<float> elevation_m,
                    double share) {
  const float level_m = moved_sea_level_m(p, grid, elevation_m, share);
  if (level_m == 0.0F) return false;
  constexpr float kRavinement_m = -5.0F, kLevel_m = 1e-6F;
  for (float& z : elevation_m) {
    z -= level_m;
    if (std::abs(z) < kLevel_m) z = 0.0F;
  }
  double lacking_m2 = (share - share_of_sea(grid, elevation_m)) * grid.total_area_m2();
  // The sea comes in over flats from their shores; those that it cannot reach are last.
  std::vector<Index> drowned;
  const auto drown = [&](Index c) {
    if (c == kNoCell || elevation_m[c] != 0.0F) return;
    const double area_m2 = grid.area_m2(grid.row(c));
    if (lacking_m2 < 0.5 * area_m2) return;
    elevation_m[c] = kRavinement_m;
    lacking_m2 -= area_m2;
    drowned.push_back(c);
  };
  const auto is_shore = [&](Index c) {
    for (int k = 0; k < kDirections; ++k) {
      const Index beside = grid.neighbour(c, k);
      if (beside != kNoCell && elevation_m[beside] < 0.0F) return true;
    }
    return false;
  };
  std::vector<Index> shore;
  for (Index c = 0; c < grid.size(); ++c) {
    if (elevation_m[c] == 0.0F && is_shore(c)) shore.push_back(c);
  }
  std::for_each(shore.begin(), shore.end(), drown);
  for (std::size_t at = 0; at < drowned.size(); ++at) {
    for (int k = 0; k < kDirections; ++k) drown(grid.neighbour(drowned[at], k));
  }
  for (Index c = 0; c < grid.size(); ++c) drown(c);
  return true;
}

bool settle_seas(const ErosionParameters& p, const Grid& grid, std::span<float> elevation_m,
                 double share) {
  // A strait adds to the sea, which sinks; where that lays shoals dry that a way led over, another
  // is cut, and the sea sinks again, each time by less.
  constexpr int kStraits = 6;
  bool changed = keep_sea_share(p, grid, elevation_m, share);
  for (int time = 0; time < kStraits && join_seas(p, grid, elevation_m); ++time) {
    changed = true;
    if (time + 1 < kStraits) keep_sea_share(p, grid, elevation_m, share);
  }
  return changed;
}

}  // namespace geo
