#include "geo/kernels/water/rivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/kernels/water/valley_width.hpp"

namespace geo {
namespace {

constexpr double kBedrock_m = 1600.0, kBedrockShare = 0.42, kDeepestShare = 0.23;

/// Calls visit(direction, neighbour) for the neighbours of a cell.
template <class Visit>
void for_neighbours(const Grid& grid, const std::array<Index, kDirections>& offsets, int i, int j,
                    Visit&& visit) {
  const Index cell = grid.cell(i, j);
  if (grid.is_interior(i, j)) {
    for (int k = 0; k < kDirections; ++k) visit(k, cell + offsets[k]);
  } else {
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid.neighbour(i, j, k);
      if (to != kNoCell) visit(k, to);
    }
  }
}

/// Height of a river cell after all rounds, its receiver aside.
double incised(double height_m, double discharge_m3_s, const CarvingLaw& law) {
  const double depth_m = law.factor * valley_depth(discharge_m3_s) / law.rounds;
  for (int round = 0; round < law.rounds; ++round) {
    const double cut = std::min(depth_m, kDeepestShare * height_m);
    height_m -= height_m > kBedrock_m ? (1 - kBedrockShare) * cut : cut;
  }
  return height_m;
}

}  // namespace

void steepest_slope(const Grid& grid, std::span<const float> elevation_m,
                    std::span<const std::uint8_t> sea, std::span<float> slope) {
  check_sizes("steepest_slope", grid.size(),
              {{"elevation_m", elevation_m.size()}, {"sea", sea.size()}, {"slope", slope.size()}});
  const auto offsets = grid.offsets();
#pragma omp parallel for schedule(dynamic, 8)
  for (int j = 0; j < grid.ny(); ++j) {
    std::array<float, kDirections> inverse;
    for (int k = 0; k < kDirections; ++k) {
      inverse[k] = static_cast<float>(1 / grid.distances_m(j)[k]);
    }
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      slope[cell] = 0.0F;
      if (sea[cell] != 0) continue;
      float steepest = 0.0F;
      for_neighbours(grid, offsets, i, j, [&](int k, Index to) {
        const float below = sea[to] != 0 ? std::max(elevation_m[to], 0.0F) : elevation_m[to];
        steepest = std::max(steepest, (elevation_m[cell] - below) * inverse[k]);
      });
      slope[cell] = steepest;
    }
  }
}

void flow_directions(const Grid& grid, std::span<const Index> receiver,
                     std::span<std::int8_t> direction) {
  check_sizes("flow_directions", grid.size(),
              {{"receiver", receiver.size()}, {"direction", direction.size()}});
  const auto offsets = grid.offsets();
  bool all_found = true;
#pragma omp parallel for schedule(static) reduction(&& : all_found)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j), wanted = receiver[cell];
      direction[cell] = 0;
      if (wanted == cell) continue;
      for_neighbours(grid, offsets, i, j, [&](int k, Index to) {
        if (to == wanted && direction[cell] == 0) direction[cell] = static_cast<std::int8_t>(k + 1);
      });
      all_found = all_found && direction[cell] != 0;
    }
  }
  if (!all_found) throw Bug("flow_directions: a receiver is not a neighbour of its cell");
}

float river_prominence(double discharge_m3_s, double slope, RiverScale scale) {
  if (!(discharge_m3_s > scale.threshold_m3_s)) return 0.0F;
  const double size = (discharge_m3_s - scale.threshold_m3_s) /
                      std::max(scale.reference_m3_s - scale.threshold_m3_s, 1e-9);
  const double slope_m_km = 1000 * slope;
  const double vigour = 0.34 + 0.86 * slope_m_km / (slope_m_km + scale.slope_m_km);
  return static_cast<float>(std::min(std::pow(std::min(size, 1.0), 0.45) * vigour, 1.0));
}

RiverScale blueprint_river_scale(const Grid& grid, std::span<const double> area_m2,
                                 std::span<const std::uint8_t> sea, double rounds) {
  check_sizes("blueprint_river_scale", grid.size(),
              {{"area_m2", area_m2.size()}, {"sea", sea.size()}});
  double largest_m2 = 0.0;
  for (std::size_t cell = 0; cell < area_m2.size(); ++cell) {
    if (sea[cell] == 0) largest_m2 = std::max(largest_m2, area_m2[cell]);
  }
  return {.threshold_m3_s = (0.00018 + 0.00007 * rounds) * grid.total_area_m2(),
          .reference_m3_s = largest_m2,
          .slope_m_km = 35.0 / 9.77};
}

double valley_depth(double discharge_m3_s) {
  return discharge_m3_s > 0 ? 16.0 * std::pow(discharge_m3_s, 0.36) : 0.0;
}

void carve_valleys(const Grid& grid, const FlowGraph& graph, std::span<const std::uint8_t> sea,
                   std::span<const double> discharge_m3_s, const CarvingLaw& law,
                   std::span<float> elevation_m) {
  check_sizes("carve_valleys", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"sea", sea.size()},
               {"discharge_m3_s", discharge_m3_s.size()},
               {"elevation_m", elevation_m.size()}});
  const auto is_river = [&](Index cell) {
    return sea[cell] == 0 && discharge_m3_s[cell] > law.threshold_m3_s;
  };
  // From the mouths upwards, so that receivers are final.
  const auto lower = [&](Index cell, double valley_m) {
    const double share = std::min(1.0, law.width_m / valley_width_m(grid, grid.row(cell)));
    const double wanted_m = elevation_m[cell] + share * (valley_m - elevation_m[cell]);
    const Index to = graph.receiver[cell];
    const float base = to == cell ? elevation_m[cell] : std::max(elevation_m[to], 0.0F);
    if (base >= elevation_m[cell]) return;
    elevation_m[cell] = std::min(elevation_m[cell], std::max(static_cast<float>(wanted_m), base));
  };
  std::vector<std::uint8_t> beside(elevation_m.size(), 0);
  const auto offsets = grid.offsets();
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {
    if (!is_river(*at)) continue;
    lower(*at, incised(elevation_m[*at], discharge_m3_s[*at], law));
    for_neighbours(grid, offsets, grid.column(*at), grid.row(*at),
                   [&](int, Index to) { beside[to] = sea[to] == 0 && !is_river(to) ? 1 : 0; });
  }
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {
    if (beside[*at] == 0) continue;
    double sum = elevation_m[*at];
    int count = 1;
    for_neighbours(grid, offsets, grid.column(*at), grid.row(*at), [&](int, Index to) {
      sum += std::max(elevation_m[to], 0.0F);
      ++count;
    });
    lower(*at, elevation_m[*at] + law.side_blend * (sum / count - elevation_m[*at]));
  }
}

}  // namespace geo
