#include "geo/stages/erosion/seas.hpp"

#include <algorithm>

#include "geo/kernels/figures/relief_figures.hpp"
#include "geo/kernels/landscape/straits.hpp"

namespace geo {

bool join_seas(const ErosionParameters& p, const Grid& grid, std::span<float> elevation_m) {
  if (p.strait_sill_m <= 0.0 || grid.topology() == Topology::plane) return false;
  const StraitLaw law{.sill_m = p.strait_sill_m,
                      .land_m = 1e3 * p.strait_land_km,
                      .depth_m = p.strait_depth_m,
                      .width_m = 1e3 * p.strait_width_km,
                      .least_m2 = 1e6 * p.strait_sea_km2};
  return open_straits(grid, law, elevation_m) > 0;
}

std::vector<std::uint8_t> landlocked_cells(const ErosionParameters& p, const Grid& grid,
                                           std::span<const float> elevation_m) {
  if (p.strait_sill_m <= 0.0 || grid.topology() == Topology::plane) return {};
  const std::vector<std::int32_t> part = number_seas(grid, elevation_m);
  if (std::none_of(part.begin(), part.end(), [](std::int32_t number) { return number > 1; })) {
    return {};
  }
  std::vector<std::uint8_t> cells(part.size());
  std::transform(part.begin(), part.end(), cells.begin(),
                 [](std::int32_t number) { return static_cast<std::uint8_t>(number > 1); });
  return cells;
}

}  // namespace geo
