#include <algorithm>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/water/breaching.hpp"
#include "geo/kernels/water/rivers.hpp"

namespace geo {
namespace {

// A centimetre in a kilometre: as gentle as large rivers get.
constexpr double kBedSlope = 1e-5;

double step_m(const Grid& grid, Index from, Index to) {
  const int i = grid.column(from), j = grid.row(from);
  for (int k = 0; k < kDirections; ++k) {
    if (grid.neighbour(i, j, k) == to) return grid.distances_m(j)[k];
  }
  return 0.0;
}

/// Lowers the way out of `pit` if it keeps the limits.
bool cut(const Grid& grid, const FlowGraph& graph, std::span<const double> discharge,
         const GorgeLimits& limits, Index pit, std::span<float> z) {
  const float bottom = z[pit];
  const auto allowed_m = [&](Index cell) {
    return limits.depth_factor * valley_depth(discharge[cell]);
  };
  double length_m = 0.0, dam_m = 0.0;
  Index end = pit;
  while (true) {
    const Index to = graph.receiver[end];
    if (to == end) break;
    const double step = step_m(grid, end, to);
    length_m += step;
    if (z[to] - bottom > limits.shallow_m) dam_m += step;
    end = to;
    if (z[to] < bottom) break;
    if (dam_m > limits.length_m || z[to] - bottom > allowed_m(to)) return false;
  }
  const double low = std::max(z[end], 0.0F);
  const double slope = std::min(kBedSlope, (bottom - low) / std::max(length_m, 1.0));
  double way_m = 0.0;
  for (Index at = pit; graph.receiver[at] != end && at != end;) {
    const Index to = graph.receiver[at];
    way_m += step_m(grid, at, to);
    const double bed = std::max(bottom - slope * way_m, low);
    z[to] = std::min(z[to], static_cast<float>(bed));
    at = to;
  }
  return true;
}

}  // namespace

int grade_rivers(const Grid& grid, const FlowGraph& graph, std::span<const std::uint8_t> outlets,
                 std::span<const double> discharge_m3_s, const GorgeLimits& limits,
                 std::span<float> elevation_m) {
  check_sizes("grade_rivers", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"outlets", outlets.size()},
               {"discharge_m3_s", discharge_m3_s.size()},
               {"elevation_m", elevation_m.size()}});
  // Where the way to the outlet starts to climb.
  std::vector<Index> pits;
  std::vector<std::uint8_t> has_lower_donor(grid.size(), 0);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const Index to = graph.receiver[cell];
    if (outlets[cell] == 0 && elevation_m[to] > elevation_m[cell]) pits.push_back(cell);
  }
  // A climb of several cells is cut from its foot.
  for (const Index cell : pits) has_lower_donor[graph.receiver[cell]] = 1;
  std::erase_if(pits, [&](Index cell) { return has_lower_donor[cell] != 0; });
  std::stable_sort(pits.begin(), pits.end(),
                   [&](Index a, Index b) { return elevation_m[a] > elevation_m[b]; });
  int cuts = 0;
  for (const Index pit : pits) {
    cuts += cut(grid, graph, discharge_m3_s, limits, pit, elevation_m);
  }
  return cuts;
}

}  // namespace geo
