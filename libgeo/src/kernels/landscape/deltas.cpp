#include "geo/kernels/landscape/deltas.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

/// For each cell of a delta the nearest cell of the sea, in steps over deltas.
std::vector<Index> new_mouths(const Grid& grid, std::span<const std::uint8_t> sea,
                              std::span<const float> laid_m) {
  std::vector<Index> mouth(laid_m.size(), kNoCell), front;
  const auto is_delta = [&](Index c) { return sea[c] != 0 && laid_m[c] > 0.0F; };
  for (Index c = 0; c < grid.size(); ++c) {
    if (!is_delta(c)) continue;
    for (int k = 0; k < kDirections && mouth[c] == kNoCell; ++k) {
      const Index to = grid.neighbour(c, k);
      if (to != kNoCell && sea[to] != 0 && !is_delta(to)) mouth[c] = to;
    }
    if (mouth[c] != kNoCell) front.push_back(c);
  }
  for (std::size_t head = 0; head < front.size(); ++head) {
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid.neighbour(front[head], k);
      if (to == kNoCell || !is_delta(to) || mouth[to] != kNoCell) continue;
      mouth[to] = mouth[front[head]];
      front.push_back(to);
    }
  }
  return mouth;
}

}  // namespace

std::vector<std::pair<Index, Index>> build_deltas(const Grid& grid, const DeltaLaw& law,
                                                  std::span<const std::uint8_t> sea,
                                                  std::span<const float> elevation_m,
                                                  std::span<double> volume_m3,
                                                  std::span<float> laid_m) {
  check_sizes("build_deltas", grid.size(),
              {{"sea", sea.size()},
               {"elevation_m", elevation_m.size()},
               {"volume_m3", volume_m3.size()},
               {"laid_m", laid_m.size()}});
  constexpr double kGentle_m = 10.0;
  const auto rise_m = [&](Index c) { return static_cast<float>(law.top_m) - elevation_m[c]; };
  const auto room_m3 = [&](Index c) {
    return static_cast<double>(rise_m(c)) * grid.area_m2(grid.row(c));
  };
  const auto may_fill = [&](Index c) {
    return sea[c] != 0 && laid_m[c] == 0.0F && elevation_m[c] >= -law.deepest_m;
  };
  std::vector<Index> mouths;
  for (Index c = 0; c < grid.size(); ++c) {
    if (volume_m3[c] > 0.0 && may_fill(c) && volume_m3[c] >= room_m3(c)) mouths.push_back(c);
  }
  std::stable_sort(mouths.begin(), mouths.end(),
                   [&](Index a, Index b) { return volume_m3[a] > volume_m3[b]; });
  std::vector<std::pair<Index, Index>> built;
  using Entry = std::pair<double, Index>;
  std::vector<Entry> heap;
  std::map<Index, double> cost;
  for (const Index mouth : mouths) {
    if (laid_m[mouth] > 0.0F) continue;
    heap.assign(1, {0.0, mouth});
    cost = {{mouth, 0.0}};
    while (!heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), std::greater<>());
      const auto [way, cell] = heap.back();
      heap.pop_back();
      if (way > cost.at(cell)) continue;
      if (laid_m[cell] > 0.0F) continue;  // another river's, or reached before
      if (!may_fill(cell) || volume_m3[mouth] < room_m3(cell)) break;
      volume_m3[mouth] -= room_m3(cell);
      laid_m[cell] = rise_m(cell);
      const int i = grid.column(cell), j = grid.row(cell);
      for (int k = 0; k < kDirections; ++k) {
        const Index to = grid.neighbour(i, j, k);
        if (to == kNoCell || sea[to] == 0 || laid_m[to] > 0.0F) continue;
        const double depth = std::max(0.0, -static_cast<double>(elevation_m[to]));
        const double there = way + grid.distances_m(j)[k] * (1.0 + depth / kGentle_m);
        const auto at = cost.find(to);
        if (at != cost.end() && at->second <= there) continue;
        cost[to] = there;
        heap.emplace_back(there, to);
        std::push_heap(heap.begin(), heap.end(), std::greater<>());
      }
    }
  }
  const std::vector<Index> mouth_of = new_mouths(grid, sea, laid_m);
  for (Index c = 0; c < grid.size(); ++c) {
    if (sea[c] != 0 && laid_m[c] > 0.0F) built.emplace_back(c, mouth_of[c]);
  }
  return built;
}

}  // namespace geo
