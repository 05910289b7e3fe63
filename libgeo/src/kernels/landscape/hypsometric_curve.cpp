#include "geo/kernels/landscape/hypsometric_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {

namespace {

constexpr double kMost = 5.0;

double bend(const Grid& grid, std::span<float> elevation_m, double median_m, double smoothing_m,
            double least, int turns) {
  constexpr double kTolerance = 0.01;
  const std::vector<float> before(elevation_m.begin(), elevation_m.end());
  std::vector<std::uint8_t> land(before.size());
  std::transform(before.begin(), before.end(), land.begin(),
                 [](float height) { return static_cast<std::uint8_t>(height > 0.0F); });
  if (std::find(land.begin(), land.end(), 1) == land.end()) return 1.0;
  const auto half_and_most = quantiles(grid, before, std::vector<double>{0.5, 1.0}, land);
  const double median = half_and_most[0], most = half_and_most[1];
  if (median >= most || median_m >= most) return 1.0;
  double aim_m = median_m, alpha = 1.0;
  for (int turn = 0; turn < turns; ++turn) {
    alpha = std::clamp(std::log(aim_m / most) / std::log(median / most), least, kMost);
    std::vector<float> change(before.size(), 0.0F);
#pragma omp parallel for schedule(static)
    for (std::size_t cell = 0; cell < before.size(); ++cell) {
      if (land[cell] == 0) continue;
      change[cell] = before[cell] - static_cast<float>(most * std::pow(before[cell] / most, alpha));
    }
    if (smoothing_m > 0.0) smooth(grid, change, smoothing_m, land);
#pragma omp parallel for schedule(static)
    for (std::size_t cell = 0; cell < before.size(); ++cell) {
      if (land[cell] == 0) continue;
      // A smoothed change may exceed the height of a shore.
      elevation_m[cell] = std::max(before[cell] - change[cell], std::min(before[cell], 0.1F));
    }
    const double reached = quantile(grid, elevation_m, 0.5, land);
    if (std::abs(reached - median_m) <= kTolerance * median_m) break;
    aim_m *= median_m / reached;
  }
  return alpha;
}

}  // namespace

double bend_hypsometry(const Grid& grid, std::span<float> elevation_m, double median_m,
                       double smoothing_m) {
  check_sizes("bend_hypsometry", grid.size(), {{"elevation_m", elevation_m.size()}});
  constexpr double kLeast = 0.2;
  constexpr int kTurns = 8;
  return bend(grid, elevation_m, median_m, smoothing_m, kLeast, kTurns);
}

double bend_hypsometry_once(const Grid& grid, std::span<float> elevation_m, double median_m,
                            double smoothing_m) {
  check_sizes("bend_hypsometry_once", grid.size(), {{"elevation_m", elevation_m.size()}});
  return bend(grid, elevation_m, median_m, smoothing_m, 1.0, 1);
}

}  // namespace geo
