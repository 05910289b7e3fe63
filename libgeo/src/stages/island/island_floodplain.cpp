#include "island_floodplain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "island_cells.hpp"

namespace geo {
namespace {

/// Mean square of the bumps of a surface about each cell, over the four directions through it; none
/// on the edge.
std::vector<float> square_bumps(const Grid& fine, std::span<const float> z) {
  std::vector<float> square(z.size());
  const std::array<Index, kDirections> offsets = fine.offsets();
  on_cells(fine, [&](int i, int j, Index c) {
    if (fine.is_open_edge(i, j)) return;
    float sum = 0.0F;
    for (int k = 0; k < 4; ++k) {
      const float bump = z[c] - 0.5F * (z[c + offsets[k]] + z[c + offsets[k + 4]]);
      sum += bump * bump;
    }
    square[c] = 0.25F * sum;
  });
  return square;
}

}  // namespace

void roughen_floodplains(const PlanetCells& cells, const IslandParameters& p, std::uint64_t seed,
                         std::span<const std::uint8_t> held, std::span<float> z) {
  constexpr double kAround_cells = 1.4;  // over which a place has as many bumps as it needs
  const Grid& fine = cells.fine();
  const DetailLaw law = plain_law(cells, p.cell_m);
  const double least_m = plain_roughness_m(p, law);
  if (least_m <= 0.0) return;
  std::vector<float> uneven(z.size()), ground_m(z.size());
  unit_detail(fine, law, seed, "island.levee", uneven);
  const std::vector<float> own = square_bumps(fine, uneven);
  const double of_noise =
      std::accumulate(own.begin(), own.end(), 0.0) / static_cast<double>(own.size());
  std::transform(z.begin(), z.end(), ground_m.begin(), [](float h) { return std::max(h, 0.0F); });
  std::vector<float> bumps_m2 = square_bumps(fine, ground_m);
  smooth(fine, bumps_m2, kAround_cells * p.cell_m);
  on_cells(fine, [&](int, int, Index c) {
    if (z[c] < 0.0F || held[c] != 0) return;
    const double lacks_m2 = least_m * least_m - bumps_m2[c] / of_noise;
    const double detail_m = std::sqrt(std::max(0.0, lacks_m2)) * uneven[c];
    z[c] = static_cast<float>(with_detail(z[c], detail_m, /*inland=*/1.0));
  });
}

}  // namespace geo
