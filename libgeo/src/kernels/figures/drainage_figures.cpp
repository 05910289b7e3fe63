#include "geo/kernels/figures/drainage_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/regression.hpp"
#include "geo/kernels/water/flow_graph.hpp"

namespace geo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check_shape(const Grid& grid, std::size_t size, const char* what) {
  if (size != static_cast<std::size_t>(grid.size())) {
    throw InputError(std::string("drainage: ") + what + " has " + std::to_string(size) +
                     " values, the grid " + std::to_string(grid.size()) + " cells");
  }
}

void check_shapes(const Grid& grid, const DrainedPlanet& drainage) {
  check_shape(grid, drainage.elevation_m.size(), "elevation");
  check_shape(grid, drainage.receiver.size(), "flow_receiver");
  check_shape(grid, drainage.area_m2.size(), "drainage_area");
}

double step_m(const Grid& grid, Index from, Index to) {
  const int row = grid.row(from), column = grid.column(from);
  for (int k = 0; k < kDirections; ++k) {
    if (grid.neighbour(column, row, k) == to) return grid.distances_m(row)[k];
  }
  throw Bug("drainage: receiver " + std::to_string(to) + " is no neighbour of cell " +
            std::to_string(from));
}

bool is_land(const DrainedPlanet& drainage, Index c) { return drainage.elevation_m[c] >= 0.0F; }

/// The last cell on land on the way to the sea, or the bottom of an endorheic basin.
bool is_mouth(const DrainedPlanet& drainage, Index c) {
  const Index to = drainage.receiver[c];
  return is_land(drainage, c) && (to == c || !is_land(drainage, to));
}

/// Whether each cell lies in a basin that drains at least so much at its mouth.
std::vector<std::uint8_t> cells_of_large_basins(const DrainedPlanet& drainage,
                                                double least_area_m2) {
  std::vector<std::uint8_t> is_large(drainage.receiver.size(), 0);
  const auto order = downstream_order(drainage.receiver);
  for (auto cell = order.rbegin(); cell != order.rend(); ++cell) {
    if (!is_land(drainage, *cell)) continue;
    is_large[*cell] = is_mouth(drainage, *cell) ? drainage.area_m2[*cell] >= least_area_m2
                                                : is_large[drainage.receiver[*cell]];
  }
  return is_large;
}

}  // namespace

std::vector<float> flow_length_m(const Grid& grid, const DrainedPlanet& drainage) {
  check_shapes(grid, drainage);
  std::vector<float> length(grid.size(), 0.0F);
  for (const Index c : downstream_order(drainage.receiver)) {
    const Index to = drainage.receiver[c];
    if (to == c || !is_land(drainage, c) || !is_land(drainage, to)) continue;
    length[to] = std::max(length[to], length[c] + static_cast<float>(step_m(grid, c, to)));
  }
  return length;
}

double hack_exponent(const Grid& grid, const DrainedPlanet& drainage, double least_area_m2) {
  const auto length = flow_length_m(grid, drainage);
  std::vector<double> log_area, log_length;
  for (Index c = 0; c < grid.size(); ++c) {
    if (!(drainage.area_m2[c] >= least_area_m2) || !is_mouth(drainage, c)) continue;
    if (length[c] <= 0.0F) continue;
    log_area.push_back(std::log(drainage.area_m2[c]));
    log_length.push_back(std::log(length[c]));
  }
  constexpr std::size_t kFewest = 10;
  return log_area.size() < kFewest ? kNaN : regression_slope(log_area, log_length);
}

HortonRatios horton_ratios(const Grid& grid, const DrainedPlanet& drainage,
                           std::span<const std::int8_t> stream_order, double least_area_m2) {
  check_shapes(grid, drainage);
  check_shape(grid, stream_order.size(), "stream_order");
  constexpr int kOrders = 128, kFewestStreams = 5, kFewestOrders = 3;
  std::array<double, kOrders> streams{}, length_m{}, area_m2{};
  const auto is_counted = cells_of_large_basins(drainage, least_area_m2);
  for (Index c = 0; c < grid.size(); ++c) {
    const int order = stream_order[c];
    if (order <= 0 || is_counted[c] == 0) continue;
    const Index to = drainage.receiver[c];
    if (to != c) length_m[order] += step_m(grid, c, to);
    if (to == c || stream_order[to] != order) {
      streams[order] += 1.0;
      area_m2[order] += drainage.area_m2[c];
    }
  }
  std::vector<double> orders, number, length, area;
  for (int order = 1; order < kOrders && streams[order] >= kFewestStreams; ++order) {
    orders.push_back(order);
    number.push_back(std::log(streams[order]));
    length.push_back(std::log(length_m[order] / streams[order]));
    area.push_back(std::log(area_m2[order] / streams[order]));
  }
  if (orders.size() < kFewestOrders) return {kNaN, kNaN, kNaN};
  return {std::exp(-regression_slope(orders, number)), std::exp(regression_slope(orders, length)),
          std::exp(regression_slope(orders, area))};
}

Basins measure_basins(const Grid& grid, const DrainedPlanet& drainage,
                      std::span<const std::int32_t> basin_id) {
  check_shapes(grid, drainage);
  check_shape(grid, basin_id.size(), "basin_id");
  const auto most = std::max(0, *std::max_element(basin_id.begin(), basin_id.end()));
  Basins basins{std::vector<double>(most + 1, 0.0), std::vector<std::uint8_t>(most + 1, 0)};
  for (int j = 0; j < grid.ny(); ++j) {
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      if (basin_id[c] <= 0 || !is_land(drainage, c)) continue;
      basins.area_m2[basin_id[c]] += grid.area_m2(j);
      if (drainage.receiver[c] == c) basins.is_endorheic[basin_id[c]] = 1;
    }
  }
  return basins;
}

std::vector<double> basin_means(const Grid& grid, std::span<const float> elevation_m,
                                std::span<const std::int32_t> basin_id,
                                std::span<const float> field) {
  check_shape(grid, elevation_m.size(), "elevation");
  check_shape(grid, basin_id.size(), "basin_id");
  check_shape(grid, field.size(), "field");
  const auto most = std::max(0, *std::max_element(basin_id.begin(), basin_id.end()));
  std::vector<double> sum(most + 1, 0.0), area(most + 1, 0.0);
  for (int j = 0; j < grid.ny(); ++j) {
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      if (basin_id[c] <= 0 || elevation_m[c] < 0.0F || std::isnan(field[c])) continue;
      sum[basin_id[c]] += grid.area_m2(j) * field[c];
      area[basin_id[c]] += grid.area_m2(j);
    }
  }
  for (std::size_t b = 0; b < sum.size(); ++b) sum[b] = area[b] > 0.0 ? sum[b] / area[b] : kNaN;
  return sum;
}

}  // namespace geo
