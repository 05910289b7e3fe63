#include "island_plains.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/receiver_distance.hpp"
#include "island_cells.hpp"

namespace geo {
namespace {

/// Hollows about dips that the window's edge, which keeps the planet's heights, would hold closed:
/// all that water would stand over whose sill lies within `seam_m` of the edge.
std::vector<std::uint8_t> closed_by_edge(const Grid& fine, const FlowGraph& graph, double seam_m,
                                         std::span<const std::uint8_t> dips,
                                         std::span<const float> z) {
  std::vector<Index> sill(z.size());
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {  // downstream first
    const Index c = *at, to = graph.receiver[c];
    sill[c] = to == c || z[c] >= z[sill[to]] ? c : sill[to];
  }
  const auto closed = [&](Index c) {
    const Index at = sill[c];
    return z[c] < z[at] && edge_ramp(fine, fine.column(at), fine.row(at), seam_m) < 1.0;
  };
  std::vector<std::uint8_t> hollow(z.size());
  for (const Index c : graph.order) {
    const Index to = graph.receiver[c];
    if (dips[c] != 0 && closed(c)) hollow[c] = 1;
    if (hollow[c] != 0 && closed(to)) hollow[to] = 1;
  }
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {
    if (hollow[graph.receiver[*at]] != 0 && closed(*at)) hollow[*at] = 1;
  }
  return hollow;
}

/// Makes plains of dips: they rise from where their water leaves them, along its ways over the
/// ground as it dips, as graded rivers do, S = S1 (A / 1 km2)^-1/2. On an even plain rivers would
/// run straight along the grid. At the shore they stand as high as tides lay mud. Where the
/// window's edge holds a hollow closed, its plain rises from there.
void grade_plains(const Grid& fine, double seam_m, std::span<const std::uint8_t> dips,
                  std::span<const std::uint8_t> sea, std::span<float> z) {
  constexpr double kSlope = 2e-4, kArea_m2 = 1e6;
  constexpr float kHighWater_m = 0.5F;
  std::vector<std::uint8_t> outlets(sea.begin(), sea.end());
  for (Index c = 0; c < fine.size(); ++c) {
    if (fine.is_open_edge(fine.column(c), fine.row(c))) outlets[c] = 1;
  }
  const FlowGraph graph = route_water(fine, z, outlets).graph;
  const std::vector<std::uint8_t> hollow = closed_by_edge(fine, graph, seam_m, dips, z);
  std::vector<double> area_m2(fine.size(), fine.area_m2(0));
  graph.accumulate(area_m2);
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {  // downstream first
    const Index c = *at, to = graph.receiver[c];
    if (dips[c] == 0 && hollow[c] == 0) continue;
    z[c] = std::max(z[c], kHighWater_m);
    if (to == c) continue;
    const ReceiverDistance distance(fine, fine.row(c));
    const double slope = kSlope * std::sqrt(kArea_m2 / area_m2[c]);
    const auto graded =
        static_cast<float>(std::max(z[to], 0.0F) + slope * distance(c, fine.column(c), to));
    z[c] = std::max(z[c], graded);
  }
}

/// Makes dips shallow and uneven, so that courses wind over the plains that fill them: what lies
/// buried does not lead them, and over an even slope brooks would run side by side, straight along
/// the grid. A depth d becomes d exp(n) / (1 + d / R), n noise of unit variance, R the least
/// roughness of ground.
void roughen(const PlanetCells& cells, const IslandParameters& p, std::uint64_t seed,
             std::span<const std::uint8_t> dips, std::span<float> z) {
  constexpr float kLeast_m = 1e-3F;
  const DetailLaw law = plain_law(cells, p.cell_m);
  const auto roughness_m = static_cast<float>(plain_roughness_m(p, law));
  if (roughness_m <= 0.0F) return;
  std::vector<float> uneven(z.size());
  unit_detail(cells.fine(), law, seed, "island.floodplain", uneven);
  on_cells(cells.fine(), [&](int, int, Index c) {
    if (dips[c] == 0) return;
    const float depth_m = std::max(kLeast_m, -z[c]);
    z[c] = -depth_m * std::exp(uneven[c]) / (1.0F + depth_m / roughness_m);
  });
}

}  // namespace

void dry_inland_dips(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     const IslandParameters& p, std::uint64_t seed, std::span<float> z) {
  // What with_detail has pressed to the level of the sea is as even as what lies below it.
  const float even_m = p.detail == "height" ? 0.0F : 0.01F;
  const Grid& fine = cells.fine();
  std::vector<std::uint8_t> wet(fine.size());
  std::vector<Index> front;
  for (Index c = 0; c < fine.size(); ++c) {
    if (z[c] >= 0.0F || planet_elevation_m[cells.cell_of()[c]] >= 0.0F) continue;
    wet[c] = 1;
    front.push_back(c);
  }
  while (!front.empty()) {
    const Index c = front.back();
    front.pop_back();
    for (int k = 0; k < kDirections; ++k) {
      const Index next = fine.neighbour(c, k);
      if (next == kNoCell || wet[next] != 0 || z[next] >= 0.0F) continue;
      wet[next] = 1;
      front.push_back(next);
    }
  }
  std::vector<std::uint8_t> dips(fine.size());
  for (Index c = 0; c < fine.size(); ++c) dips[c] = z[c] < even_m && wet[c] == 0 ? 1 : 0;
  if (std::find(dips.begin(), dips.end(), 1) == dips.end()) return;
  roughen(cells, p, seed, dips, z);
  grade_plains(fine, seam_m(cells), dips, wet, z);
}

}  // namespace geo
