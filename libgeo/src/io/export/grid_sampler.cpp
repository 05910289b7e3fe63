#include "grid_sampler.hpp"

#include <algorithm>
#include <limits>

#include "geo/kernels/remapping/cubic_weights.hpp"

namespace geo::io {
namespace {

float mean_of_row(std::span<const float> row) {
  double sum = 0.0;
  for (const float value : row) sum += value;
  return static_cast<float>(sum / static_cast<double>(row.size()));
}

}  // namespace

GridSampler::GridSampler(const Grid& grid, std::span<const float> values)
    : grid_(grid),
      values_(values),
      least_(std::numeric_limits<float>::infinity()),
      most_(-std::numeric_limits<float>::infinity()) {
  float least = least_, most = most_;
  bool gaps = false;
#pragma omp parallel for reduction(min : least) reduction(max : most) reduction(|| : gaps)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const float value = values[cell];
    gaps = gaps || std::isnan(value);
    if (value < least) least = value;
    if (value > most) most = value;
  }
  least_ = least;
  most_ = most;
  gaps_ = gaps;
  if (grid.topology() == Topology::sphere) {
    south_pole_ = mean_of_row(values.first(grid.nx()));
    north_pole_ = mean_of_row(values.last(grid.nx()));
  }
}

Index GridSampler::cell_at(int column, int row) const {
  const int nx = grid_.nx(), ny = grid_.ny();
  if (grid_.topology() == Topology::plane) {
    return grid_.cell(std::clamp(column, 0, nx - 1), std::clamp(row, 0, ny - 1));
  }
  if (grid_.topology() == Topology::torus) {
    row = ((row % ny) + ny) % ny;
  } else if (row < 0 || row >= ny) {
    row = std::clamp(row < 0 ? -1 - row : 2 * ny - 1 - row, 0, ny - 1);
    column += nx / 2;
  }
  return grid_.cell(((column % nx) + nx) % nx, row);
}

Index GridSampler::nearest(GridPlace place) const {
  return cell_at(static_cast<int>(std::floor(place.column + 0.5)),
                 static_cast<int>(std::clamp(std::floor(place.row + 0.5), 0.0, grid_.ny() - 1.0)));
}

float GridSampler::at(GridPlace place) const {
  const double x0 = std::floor(place.column), y0 = std::floor(place.row);
  const auto i0 = static_cast<int>(x0), j0 = static_cast<int>(y0);
  if (place.column == x0 && place.row == y0) return values_[cell_at(i0, j0)];
  if (grid_.topology() == Topology::sphere) {
    if (place.row <= -0.5) return south_pole_;
    if (place.row >= grid_.ny() - 0.5) return north_pole_;
  }
  const auto along = cubic_weights(place.column - x0), up = cubic_weights(place.row - y0);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    double line = 0.0;
    for (int i = 0; i < 4; ++i) line += along[i] * values_[cell_at(i0 - 1 + i, j0 - 1 + j)];
    sum += up[j] * line;
  }
  if (std::isnan(sum)) return values_[nearest(place)];
  return std::clamp(static_cast<float>(sum), least_, most_);
}

GridPlace GridSampler::place_of(const Grid& grid, double latitude_deg, double longitude_deg) {
  const Window& w = grid.window();
  return {(longitude_deg - w.west_deg) / (w.east_deg - w.west_deg) * grid.nx() - 0.5,
          (latitude_deg - w.south_deg) / (w.north_deg - w.south_deg) * grid.ny() - 0.5};
}

}  // namespace geo::io
