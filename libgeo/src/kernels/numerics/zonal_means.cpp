#include "geo/kernels/numerics/zonal_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geo/core/error.hpp"

namespace geo {

std::vector<double> zonal_means(const Grid& grid, std::span<const float> field, int bands,
                                std::span<const std::uint8_t> mask) {
  const auto cells = static_cast<std::size_t>(grid.size());
  if (bands < 1 || !grid.is_geographic() || field.size() != cells ||
      (!mask.empty() && mask.size() != cells)) {
    throw InputError("zonal means: need latitudes, a band, and a value per cell");
  }
  std::vector<double> sums(grid.ny(), 0.0), counts(grid.ny(), 0.0);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      if ((!mask.empty() && mask[c] == 0) || std::isnan(field[c])) continue;
      sums[j] += field[c];
      counts[j] += 1.0;
    }
  }
  std::vector<double> means(bands, 0.0), areas(bands, 0.0);
  for (int j = 0; j < grid.ny(); ++j) {
    const int band =
        std::clamp(static_cast<int>((grid.latitude_deg(j) + 90.0) / 180.0 * bands), 0, bands - 1);
    means[band] += sums[j] * grid.area_m2(j);
    areas[band] += counts[j] * grid.area_m2(j);
  }
  for (int band = 0; band < bands; ++band) {
    means[band] =
        areas[band] > 0.0 ? means[band] / areas[band] : std::numeric_limits<double>::quiet_NaN();
  }
  return means;
}

double zonal_rms(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw InputError("zonal means: as many bands in both are needed");
  const auto edge = [&](std::size_t band) {
    return std::sin((static_cast<double>(band) / static_cast<double>(a.size()) - 0.5) *
                    std::numbers::pi);
  };
  double squares = 0.0, weight = 0.0;
  for (std::size_t band = 0; band < a.size(); ++band) {
    const double difference = a[band] - b[band];
    if (std::isnan(difference)) continue;
    const double share = edge(band + 1) - edge(band);
    squares += share * difference * difference;
    weight += share;
  }
  return std::sqrt(squares / weight);
}

}  // namespace geo
