#include "island_edge.hpp"

#include <algorithm>
#include <cstdlib>
#include <unordered_set>

#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/receiver_distance.hpp"
#include "geo/kernels/water/water_balance.hpp"

namespace geo {
namespace {

/// What each wide cell yields, and what enters there, m3/s.
std::vector<double> runoff_m3_s(const PlanetCells& cells, const WideWater& water,
                                std::span<const float> precipitation_mm_yr,
                                std::span<const float> potential_mm_yr) {
  const double m3_s_per_mm_yr = 1e-3 * cells.fine().area_m2(0) / kSecondsPerYear;
  std::vector<double> runoff(cells.fine().size());
  for (std::size_t c = 0; c < runoff.size(); ++c) {
    runoff[c] = water.inflow_m3_s[c];
    if (water.elevation_m[c] < 0.0F) continue;
    const Index there = cells.cell_of()[c];
    const double rain_mm_yr = precipitation_mm_yr[there], potential = potential_mm_yr[there];
    const double lost = water.lake[c] != 0 ? potential : land_evaporation(rain_mm_yr, potential);
    runoff[c] += m3_s_per_mm_yr * (rain_mm_yr - lost);
  }
  return runoff;
}

int cells_apart(const Grid& grid, Index a, Index b) {
  return std::max(std::abs(grid.column(a) - grid.column(b)), std::abs(grid.row(a) - grid.row(b)));
}

/// Whether water can get from one cell of the island to another within it, near both, over ground
/// that is nowhere higher than a level.
bool has_low_way(const IslandWindow& window, std::span<const float> z, Index from, Index to,
                 float level_m) {
  const Grid& wide = window.wide();
  const int reach = 2 * window.margin();
  std::vector<Index> front{from};
  std::unordered_set<Index> seen{from};
  while (!front.empty()) {
    const Index c = front.back();
    front.pop_back();
    if (c == to) return true;
    for (int k = 0; k < kDirections; ++k) {
      const Index next = wide.neighbour(c, k);
      if (next == kNoCell || window.in_island(next) == kNoCell || z[next] > level_m) continue;
      if (cells_apart(wide, from, next) <= reach && seen.insert(next).second) front.push_back(next);
    }
  }
  return false;
}

/// Of cells at the island's edge whose water leaves only to come back nearby, and may as well stay
/// inside, where it comes back; kNoCell for all others. Which cells of the edge a river along it
/// crosses is an accident of the grid.
std::vector<Index> short_bends(const IslandWindow& window, const FlowGraph& graph,
                               std::span<const float> z) {
  constexpr float kHurdle_m = 1.0F;
  const Grid& wide = window.wide();
  std::vector<Index> comes_back(wide.size(), kNoCell);  // of the margin: where into the island
  std::vector<Index> bends(wide.size(), kNoCell);
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {  // downstream first
    const Index c = *at, to = graph.receiver[c];
    if (to == c) continue;
    const Index entry = window.in_island(to) != kNoCell ? to : comes_back[to];
    if (window.in_island(c) == kNoCell) {
      comes_back[c] = entry;
    } else if (window.in_island(to) == kNoCell && entry != kNoCell &&
               cells_apart(wide, c, entry) <= 2 * window.margin() &&
               has_low_way(window, z, c, entry, z[c] + kHurdle_m)) {
      bends[c] = entry;
    }
  }
  return bends;
}

/// Cells of hollows that lie on both sides of the island's edge.
std::vector<std::uint8_t> hollows_across(const IslandWindow& window,
                                         std::span<const float> filled_m,
                                         std::span<const float> z) {
  const Grid& wide = window.wide();
  std::vector<std::uint8_t> across(wide.size());
  std::vector<Index> front;
  const auto take = [&](Index c) {
    if (across[c] != 0 || z[c] >= filled_m[c]) return;
    across[c] = 1;
    front.push_back(c);
  };
  for (Index c = 0; c < wide.size(); ++c) {
    if (window.on_islands_edge(c)) take(c);
  }
  while (!front.empty()) {
    const Index c = front.back();
    front.pop_back();
    for (int k = 0; k < kDirections; ++k) {
      const Index next = wide.neighbour(c, k);
      if (next != kNoCell) take(next);
    }
  }
  return across;
}

}  // namespace

std::vector<std::uint8_t> fill_hollows_across_edge(const IslandWindow& window,
                                                   const PlanetCells& cells,
                                                   std::span<const std::uint8_t> outlets,
                                                   std::span<const std::int32_t> planets_lake_id,
                                                   std::span<float> z) {
  constexpr double kSlope = 1e-5;
  const Grid& wide = window.wide();
  std::vector<std::uint8_t> lake(wide.size());
  if (window.margin() == 0) return lake;
  const Routing routing = route_water(wide, z, outlets, /*want_filled=*/true);
  const std::vector<std::uint8_t> across = hollows_across(window, routing.filled_m, z);
  const auto is_lake = [&](Index c) {
    return !planets_lake_id.empty() && planets_lake_id[cells.cell_of()[c]] > 0;
  };
  const auto& receiver = routing.graph.receiver;
  const auto& order = routing.graph.order;
  for (auto at = order.rbegin(); at != order.rend(); ++at) {  // downstream first
    const Index c = *at, to = receiver[c];
    if (across[c] == 0 || to == c) continue;
    const bool in_margin = window.in_island(c) == kNoCell;
    if (is_lake(c)) {
      lake[c] = in_margin ? 1 : 0;
      // Where the island's part overflows into the margin it has a sill.
      if (in_margin || window.in_island(to) == kNoCell) z[c] = routing.filled_m[c];
      continue;
    }
    const ReceiverDistance distance(wide, wide.row(c));
    const double rise_m = kSlope * distance(c, wide.column(c), to);
    z[c] = std::max(z[c], static_cast<float>(z[to] + rise_m));
  }
  return lake;
}

IslandEdge find_island_edge(const IslandWindow& window, const PlanetCells& cells,
                            const WideWater& water, std::span<const float> precipitation_mm_yr,
                            std::span<const float> potential_mm_yr) {
  if (window.margin() == 0) {
    return {{water.inflow_area_m2.begin(), water.inflow_area_m2.end()},
            {water.inflow_m3_s.begin(), water.inflow_m3_s.end()},
            {}};
  }
  const Grid& wide = window.wide();
  const FlowGraph graph = route_water(wide, water.elevation_m, water.outlets).graph;
  const std::vector<Index> bends = short_bends(window, graph, water.elevation_m);
  std::vector<double> area_m2(wide.size(), wide.area_m2(0));
  for (Index c = 0; c < wide.size(); ++c) area_m2[c] += water.inflow_area_m2[c];
  std::vector<double> discharge = runoff_m3_s(cells, water, precipitation_mm_yr, potential_mm_yr);

  const auto size = static_cast<std::size_t>(window.island()->size());
  IslandEdge edge{std::vector<double>(size), std::vector<float>(size),
                  std::vector<std::uint8_t>(size)};
  const auto flows_in = [&](Index c) {
    return water.elevation_m[c] >= 0.0F &&
           (bends[c] != kNoCell || window.in_island(graph.receiver[c]) != kNoCell);
  };
  for (const Index c : graph.order) {
    const Index to = bends[c] != kNoCell ? bends[c] : graph.receiver[c];
    const Index here = window.in_island(c), entry = window.in_island(to);
    if (window.on_islands_edge(c)) edge.shut[here] = flows_in(c) ? 1 : 0;
    if (to == c) continue;
    area_m2[to] += area_m2[c];
    discharge[to] += discharge[c];
    if (here != kNoCell || entry == kNoCell || !flows_in(to)) continue;
    edge.inflow_area_m2[entry] += area_m2[c];
    edge.inflow_m3_s[entry] += static_cast<float>(std::max(0.0, discharge[c]));
  }
  return edge;
}

}  // namespace geo
