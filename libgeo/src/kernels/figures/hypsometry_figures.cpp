#include "geo/kernels/figures/hypsometry_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kBinM = 25.0, kLowM = -12000.0;
constexpr int kBins = 1000, kSeaBin = static_cast<int>(-kLowM / kBinM);
// Shelves are drowned land: the sea floor proper begins below them.
constexpr int kDeepBin = kSeaBin - static_cast<int>(1000.0 / kBinM);

void check_shape(const Grid& grid, std::size_t size) {
  if (size != static_cast<std::size_t>(grid.size())) {
    throw InputError("hypsometry: field of " + std::to_string(size) + " values on a grid of " +
                     std::to_string(grid.size()) + " cells");
  }
}

/// Area per bin of 25 m from 12 km below the sea upwards; what lies beyond is in the end bins.
std::vector<double> area_by_elevation(const Grid& grid, std::span<const float> elevation_m) {
  std::vector<double> area(kBins, 0.0);
  std::vector<std::int32_t> cells(kBins);
  for (int j = 0; j < grid.ny(); ++j) {
    std::fill(cells.begin(), cells.end(), 0);
    for (const float z : elevation_m.subspan(std::size_t(j) * grid.nx(), grid.nx())) {
      if (std::isnan(z)) continue;
      ++cells[static_cast<int>(std::clamp((z - kLowM) / kBinM, 0.0, kBins - 1.0))];
    }
    for (int b = 0; b < kBins; ++b) area[b] += cells[b] * grid.area_m2(j);
  }
  return area;
}

std::vector<double> smoothed(const std::vector<double>& bins, double sigma_bins) {
  const int reach = static_cast<int>(std::ceil(4.0 * sigma_bins));
  std::vector<double> out(bins.size(), 0.0);
  for (int b = 0; b < kBins; ++b) {
    if (bins[b] == 0.0) continue;
    for (int k = std::max(0, b - reach); k <= std::min(kBins - 1, b + reach); ++k) {
      const double t = (k - b) / sigma_bins;
      out[k] += bins[b] * std::exp(-0.5 * t * t);
    }
  }
  return out;
}

double land_mode(const std::vector<double>& area) {
  std::vector<double> pairs;
  for (int b = kSeaBin; b + 1 < kBins; b += 2) pairs.push_back(area[b] + area[b + 1]);
  const int n = static_cast<int>(pairs.size());
  // Beyond the coast the first bin is its own neighbour: land does not go on below the sea.
  const auto blended = [&](int i) {
    return pairs[std::max(i - 1, 0)] + 2.0 * pairs[i] + pairs[std::min(i + 1, n - 1)];
  };
  int best = 0;
  for (int i = 1; i < n; ++i) best = blended(i) > blended(best) ? i : best;
  return blended(best) > 0.0 ? (2 * best + 1) * kBinM : kNaN;
}

double middle_m(std::ptrdiff_t bin) { return kLowM + (static_cast<double>(bin) + 0.5) * kBinM; }

}  // namespace

HypsometryFigures measure_hypsometry(const Grid& grid, std::span<const float> elevation_m) {
  check_shape(grid, elevation_m.size());
  double land_m2 = 0.0, ocean_m2 = 0.0, land_m3 = 0.0, ocean_m3 = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double land = 0.0, ocean = 0.0, land_sum = 0.0, ocean_sum = 0.0;
    for (const float z : elevation_m.subspan(std::size_t(j) * grid.nx(), grid.nx())) {
      if (z >= 0.0F) {
        land += 1.0;
        land_sum += z;
      } else if (z < 0.0F) {
        ocean += 1.0;
        ocean_sum += z;
      }
    }
    land_m2 += land * grid.area_m2(j);
    ocean_m2 += ocean * grid.area_m2(j);
    land_m3 += land_sum * grid.area_m2(j);
    ocean_m3 += ocean_sum * grid.area_m2(j);
  }
  return {land_m2 / (land_m2 + ocean_m2), land_m2 > 0.0 ? land_m3 / land_m2 : kNaN,
          ocean_m2 > 0.0 ? ocean_m3 / ocean_m2 : kNaN, -ocean_m3};
}

std::vector<double> shares_between(const Grid& grid, std::span<const float> field,
                                   std::span<const double> levels) {
  check_shape(grid, field.size());
  std::vector<double> area(levels.size() + 1, 0.0);
  std::vector<std::int32_t> cells(area.size());
  double total = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    std::fill(cells.begin(), cells.end(), 0);
    for (const float value : field.subspan(std::size_t(j) * grid.nx(), grid.nx())) {
      if (std::isnan(value)) continue;
      ++cells[std::upper_bound(levels.begin(), levels.end(), double(value)) - levels.begin()];
    }
    for (std::size_t k = 0; k < area.size(); ++k) {
      area[k] += cells[k] * grid.area_m2(j);
      total += cells[k] * grid.area_m2(j);
    }
  }
  if (total == 0.0) throw InputError("hypsometry: no cell has a value");
  for (double& share : area) share /= total;
  return area;
}

ElevationModes elevation_modes(const Grid& grid, std::span<const float> elevation_m) {
  check_shape(grid, elevation_m.size());
  const auto area = area_by_elevation(grid, elevation_m);
  constexpr double kSmoothingM = 150.0;
  const auto density = smoothed(area, kSmoothingM / kBinM);
  ElevationModes modes{kNaN, land_mode(area), kNaN};
  if (std::none_of(area.begin(), area.begin() + kDeepBin, [](double a) { return a > 0.0; })) {
    return modes;
  }
  const auto ocean = std::max_element(density.begin(), density.begin() + kDeepBin);
  const auto rarest = std::min_element(ocean, density.begin() + kSeaBin);
  modes.ocean_m = middle_m(ocean - density.begin());
  modes.antimode_m = middle_m(rarest - density.begin());
  return modes;
}

}  // namespace geo
