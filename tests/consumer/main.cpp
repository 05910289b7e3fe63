// Prints the share of a small planet that lies below the median of its relief.
#include <cmath>
#include <cstdio>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

int main() {
  const geo::Grid grid = geo::Grid::sphere(64, 32);
  std::vector<float> elevation_m(grid.size());
  for (geo::Index cell = 0; cell < grid.size(); ++cell) {
    const auto [x, y, z] = grid.unit_vector(grid.column(cell), grid.row(cell));
    elevation_m[cell] = static_cast<float>(1000.0 * std::sin(3 * x) * std::cos(2 * y) + 500.0 * z);
  }
  const float median_m = geo::quantile(grid, elevation_m, 0.5);
  const double below = geo::fraction_below(grid, elevation_m, median_m);
  std::printf("%.3f\n", below);
  return std::abs(below - 0.5) < 0.01 ? 0 : 1;
}
