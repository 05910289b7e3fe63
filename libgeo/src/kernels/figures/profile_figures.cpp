#include "geo/kernels/figures/profile_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/regression.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"

namespace geo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check_shape(const Grid& grid, std::span<const float> elevation_m) {
  if (elevation_m.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("river profiles: elevation has " + std::to_string(elevation_m.size()) +
                     " values, the grid " + std::to_string(grid.size()) + " cells");
  }
}

double step_m(const Grid& grid, Index from, Index to) {
  for (int k = 0; k < kDirections; ++k) {
    if (grid.neighbour(from, k) == to) return grid.distances_m(grid.row(from))[k];
  }
  throw Bug("river profiles: receiver " + std::to_string(to) + " is no neighbour of cell " +
            std::to_string(from));
}

bool flows(const LaidRivers& rivers, Index cell) { return rivers.length_m[cell] > 0.0F; }

bool is_within(const Grid& grid, Index cell, LatitudeBand band) {
  return std::abs(grid.latitude_deg(grid.row(cell))) <= band.poleward_deg;
}

/// Hands on the cells of the band whose water goes on to another cell.
template <class Visit>
void each_reach(const Grid& grid, const LaidRivers& rivers, LatitudeBand band, Visit&& visit) {
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (flows(rivers, cell) && is_within(grid, cell, band)) visit(cell);
  }
}

}  // namespace

LaidRivers lay_rivers(const Grid& grid, std::span<const float> elevation_m) {
  check_shape(grid, elevation_m);
  const auto outlets = find_outlets(grid, elevation_m);
  Routing routing = route_water(grid, elevation_m, outlets);
  LaidRivers rivers;
  rivers.area_m2.resize(grid.size());
  rivers.fall_m.assign(grid.size(), 0.0F);
  rivers.length_m.assign(grid.size(), 0.0F);
  std::vector<std::uint8_t> sea(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    sea[cell] = elevation_m[cell] < 0.0F ? 1 : 0;
    rivers.area_m2[cell] = grid.area_m2(grid.row(cell));
    const Index to = routing.graph.receiver[cell];
    if (to == cell || sea[cell] != 0) continue;
    rivers.fall_m[cell] = elevation_m[cell] - std::max(0.0F, elevation_m[to]);
    rivers.length_m[cell] = static_cast<float>(step_m(grid, cell, to));
  }
  routing.graph.accumulate(rivers.area_m2);
  rivers.basin.assign(grid.size(), 0);
  // Each cell is numbered after its receiver; what ends in the sea, by its last cell on land.
  std::int32_t basins = 0;
  const auto& order = routing.graph.order;
  for (auto at = order.rbegin(); at != order.rend(); ++at) {
    if (sea[*at] != 0) continue;
    const Index to = routing.graph.receiver[*at];
    rivers.basin[*at] = to == *at || sea[to] != 0 ? ++basins : rivers.basin[to];
  }
  rivers.receiver = std::move(routing.graph.receiver);
  return rivers;
}

double river_slope(const Grid& grid, const LaidRivers& rivers, double least_area_m2,
                   LatitudeBand band) {
  double fall_m = 0.0, length_m = 0.0;
  each_reach(grid, rivers, band, [&](Index cell) {
    if (rivers.area_m2[cell] < least_area_m2) return;
    fall_m += rivers.fall_m[cell];
    length_m += rivers.length_m[cell];
  });
  return length_m > 0.0 ? fall_m / length_m : kNaN;
}

double concavity(const Grid& grid, const LaidRivers& rivers, double from_m2, double to_m2,
                 LatitudeBand band) {
  constexpr double kStep = 0.2;  // decades
  constexpr int kFewestCells = 10;
  constexpr std::size_t kFewestSteps = 3;
  struct Step {
    double fall_m = 0.0, length_m = 0.0, log_area = 0.0;
    int cells = 0;
  };
  const double first = std::log10(from_m2);
  std::vector<Step> steps(std::max(1L, std::lround((std::log10(to_m2) - first) / kStep)));
  each_reach(grid, rivers, band, [&](Index cell) {
    const double log_area = std::log10(rivers.area_m2[cell]);
    const double at = std::floor((log_area - first) / kStep);
    if (at < 0.0 || at >= static_cast<double>(steps.size())) return;
    Step& step = steps[static_cast<std::size_t>(at)];
    step.fall_m += rivers.fall_m[cell];
    step.length_m += rivers.length_m[cell];
    step.log_area += log_area;
    ++step.cells;
  });
  std::vector<double> log_area, log_slope;
  for (const Step& step : steps) {
    if (step.cells < kFewestCells || !(step.fall_m > 0.0)) continue;
    log_area.push_back(step.log_area / step.cells);
    log_slope.push_back(std::log10(step.fall_m / step.length_m));
  }
  return log_area.size() < kFewestSteps ? kNaN : -regression_slope(log_area, log_slope);
}

std::vector<float> channel_steepness(const Grid& grid, const LaidRivers& rivers, double theta,
                                     double least_area_m2, LatitudeBand band) {
  std::vector<float> steepness(grid.size(), std::numeric_limits<float>::quiet_NaN());
  each_reach(grid, rivers, band, [&](Index cell) {
    if (rivers.area_m2[cell] < least_area_m2) return;
    const double slope = std::max(0.0F, rivers.fall_m[cell]) / rivers.length_m[cell];
    steepness[cell] = static_cast<float>(slope * std::pow(rivers.area_m2[cell], theta));
  });
  return steepness;
}

std::vector<double> hypsometric_integrals(const Grid& grid, std::span<const float> elevation_m,
                                          const LaidRivers& rivers, double least_area_m2,
                                          LatitudeBand band) {
  check_shape(grid, elevation_m);
  struct Basin {
    double area_m2 = 0.0, volume_m3 = 0.0;
    float lowest_m = std::numeric_limits<float>::max(), highest_m = 0.0F;
    bool counts = false;
  };
  const auto most = *std::max_element(rivers.basin.begin(), rivers.basin.end());
  std::vector<Basin> basins(most + 1);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (rivers.basin[cell] == 0) continue;
    Basin& basin = basins[rivers.basin[cell]];
    const double area = grid.area_m2(grid.row(cell));
    basin.area_m2 += area;
    basin.volume_m3 += area * elevation_m[cell];
    basin.lowest_m = std::min(basin.lowest_m, elevation_m[cell]);
    basin.highest_m = std::max(basin.highest_m, elevation_m[cell]);
    const Index to = rivers.receiver[cell];
    const bool is_last = to == cell || rivers.basin[to] == 0;
    if (is_last && is_within(grid, cell, band)) basin.counts = true;
  }
  std::vector<double> integrals;
  for (const Basin& b : basins) {
    if (!b.counts || b.area_m2 < least_area_m2 || !(b.highest_m > b.lowest_m)) continue;
    integrals.push_back((b.volume_m3 / b.area_m2 - b.lowest_m) / (b.highest_m - b.lowest_m));
  }
  return integrals;
}

}  // namespace geo
