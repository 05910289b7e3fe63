#include "geo/kernels/climate/orography.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

int wrapped(int index, int count) {
  const int rest = index % count;
  return rest < 0 ? rest + count : rest;
}

}  // namespace

float DisplacedSampler::at(int column, int row) const {
  const int nx = grid_.nx(), ny = grid_.ny();
  switch (grid_.topology()) {
    case Topology::plane:
      return values_[grid_.cell(std::clamp(column, 0, nx - 1), std::clamp(row, 0, ny - 1))];
    case Topology::torus:
      return values_[grid_.cell(wrapped(column, nx), wrapped(row, ny))];
    case Topology::sphere:
      break;
  }
  if (row < 0 || row >= ny) {
    row = std::clamp(row < 0 ? -1 - row : 2 * ny - 1 - row, 0, ny - 1);
    column += nx / 2;
  }
  return values_[grid_.cell(wrapped(column, nx), row)];
}

float DisplacedSampler::operator()(int column, int row, double east_m, double north_m) const {
  const double x = column + east_m / grid_.spacing_east_m(row);
  const double y = row + north_m / grid_.face_east_m(row);
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const int i = static_cast<int>(x0), j = static_cast<int>(y0);
  const float south = at(i, j) + fx * (at(i + 1, j) - at(i, j));
  const float north = at(i, j + 1) + fx * (at(i + 1, j + 1) - at(i, j + 1));
  return south + fy * (north - south);
}

void upwind_lift(const Grid& grid, std::span<const float> height_m,
                 std::span<const float> wind_east, std::span<const float> wind_north,
                 double reach_m, std::span<float> lift_m) {
  check_sizes("upwind_lift", grid.size(),
              {{"height_m", height_m.size()},
               {"wind_east", wind_east.size()},
               {"wind_north", wind_north.size()},
               {"lift_m", lift_m.size()}});
  // Mid-points of six intervals in units of the reach, each with the weight of its interval.
  constexpr std::array<double, 6> kDistance{0.25, 0.75, 1.25, 1.75, 2.25, 2.75};
  std::array<double, 6> weight{};
  double total = 0.0;
  for (std::size_t k = 0; k < weight.size(); ++k) total += weight[k] = std::exp(-kDistance[k]);
  const DisplacedSampler height(grid, height_m);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      const double u = wind_east[here], v = wind_north[here];
      const double speed = std::hypot(u, v);
      double upwind = height_m[here];
      if (speed > 0.0) {
        upwind = 0.0;
        for (std::size_t k = 0; k < weight.size(); ++k) {
          const double back_m = -kDistance[k] * reach_m / speed;
          upwind += weight[k] / total * height(i, j, back_m * u, back_m * v);
        }
      }
      lift_m[here] = static_cast<float>(height_m[here] - upwind);
    }
  }
}

}  // namespace geo
