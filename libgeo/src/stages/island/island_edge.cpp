#include "island_edge.hpp"

#include <algorithm>

#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/receiver_distance.hpp"
#include "geo/kernels/water/water_balance.hpp"

namespace geo {
namespace {

/// What a cell of each planet cell's land yields, m3/s.
std::vector<double> runoff_m3_s(const PlanetCells& cells, const WideWater& water,
                                std::span<const float> precipitation_mm_yr,
                                std::span<const float> potential_mm_yr) {
  const double m3_s_per_mm_yr = 1e-3 * cells.fine().area_m2(0) / kSecondsPerYear;
  std::vector<double> runoff(cells.fine().size());
  for (std::size_t c = 0; c < runoff.size(); ++c) {
    runoff[c] = water.inflow_m3_s[c];
    if (water.elevation_m[c] < 0.0F) continue;
    const Index there = cells.cell_of()[c];
    const double rain_mm_yr = precipitation_mm_yr[there];
    runoff[c] +=
        m3_s_per_mm_yr * (rain_mm_yr - land_evaporation(rain_mm_yr, potential_mm_yr[there]));
  }
  return runoff;
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

void fill_hollows_across_edge(const IslandWindow& window, const PlanetCells& cells,
                              std::span<const std::uint8_t> outlets,
                              std::span<const std::int32_t> planets_lake_id, std::span<float> z) {
  constexpr double kSlope = 1e-5;
  if (!window.has_margin()) return;
  const Grid& wide = window.wide();
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
    if (is_lake(c)) {
      if (window.in_island(c) == kNoCell || window.in_island(to) == kNoCell)
        z[c] = routing.filled_m[c];
      continue;
    }
    const ReceiverDistance distance(wide, wide.row(c));
    const double rise_m = kSlope * distance(c, wide.column(c), to);
    z[c] = std::max(z[c], static_cast<float>(z[to] + rise_m));
  }
}

IslandEdge find_island_edge(const IslandWindow& window, const PlanetCells& cells,
                            const WideWater& water, std::span<const float> precipitation_mm_yr,
                            std::span<const float> potential_mm_yr) {
  if (!window.has_margin()) {
    return {{water.inflow_area_m2.begin(), water.inflow_area_m2.end()},
            {water.inflow_m3_s.begin(), water.inflow_m3_s.end()},
            {}};
  }
  const Grid& wide = window.wide();
  const Grid& island = *window.island();
  const FlowGraph graph = route_water(wide, water.elevation_m, water.outlets).graph;
  std::vector<double> area_m2(wide.size(), wide.area_m2(0));
  for (Index c = 0; c < wide.size(); ++c) area_m2[c] += water.inflow_area_m2[c];
  graph.accumulate(area_m2);
  std::vector<double> discharge = runoff_m3_s(cells, water, precipitation_mm_yr, potential_mm_yr);
  graph.accumulate(discharge);

  IslandEdge edge{std::vector<double>(island.size()), std::vector<float>(island.size()),
                  std::vector<std::uint8_t>(island.size())};
  const auto flows_in = [&](Index c) {
    return water.elevation_m[c] >= 0.0F && window.in_island(graph.receiver[c]) != kNoCell;
  };
  for (Index c = 0; c < wide.size(); ++c) {
    const Index here = window.in_island(c), entry = window.in_island(graph.receiver[c]);
    if (here != kNoCell) {
      edge.shut[here] = window.on_islands_edge(c) && flows_in(c) ? 1 : 0;
    } else if (entry != kNoCell && flows_in(graph.receiver[c])) {
      edge.inflow_area_m2[entry] += area_m2[c];
      edge.inflow_m3_s[entry] += static_cast<float>(discharge[c]);
    }
  }
  return edge;
}

}  // namespace geo
