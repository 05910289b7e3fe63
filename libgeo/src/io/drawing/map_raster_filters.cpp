// What is made of a raster pixel by pixel: running means and change.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "map_raster.hpp"

namespace geo::io {
namespace {

// Running means of half-width `radius` along lines of `n` values `stride` apart, of as many lines
// side by side.
template <int lines>
void box_lines(float* first, int n, std::size_t stride, int radius, bool wraps,
               std::vector<double>& sums) {
  sums.resize(static_cast<std::size_t>(n + 2 * radius + 1) * lines);
  std::fill_n(sums.begin(), lines, 0.0);
  for (int i = 0; i < n + 2 * radius; ++i) {
    const int at = i - radius;
    const int from = wraps ? (at % n + n) % n : std::clamp(at, 0, n - 1);
    const float* const value = first + from * stride;
    const double* const before = &sums[static_cast<std::size_t>(i) * lines];
    double* const after = &sums[static_cast<std::size_t>(i + 1) * lines];
    for (int k = 0; k < lines; ++k) after[k] = before[k] + value[k];
  }
  const double share = 1.0 / (2 * radius + 1);
  for (int i = 0; i < n; ++i) {
    const double* const low = &sums[static_cast<std::size_t>(i) * lines];
    const double* const high = &sums[static_cast<std::size_t>(i + 2 * radius + 1) * lines];
    float* const mean = first + i * stride;
    for (int k = 0; k < lines; ++k) mean[k] = static_cast<float>((high[k] - low[k]) * share);
  }
}

// Half-widths of the running mean of each row of pixels, and of the columns.
struct BlurReach {
  std::vector<int> rows;
  int columns;
};

void blur_thrice(const MapFrame& frame, Raster& raster, const BlurReach& reach) {
  const bool wraps_north = frame.is_aligned() && frame.grid().topology() == Topology::torus;
  ParallelErrors errors;
  for (int pass = 0; pass < 3; ++pass) {
#pragma omp parallel
    {
      std::vector<double> sums;
#pragma omp for schedule(static)
      for (int y = 0; y < raster.height; ++y) {
        errors.guard([&] {
          box_lines<1>(&raster.at(0, y), raster.width, 1, reach.rows[y], frame.wraps_east(), sums);
        });
      }
      constexpr int kBundle = 16;
      const int bundles = raster.width / kBundle;
#pragma omp for schedule(static)
      for (int i = 0; i < bundles; ++i) {
        errors.guard([&] {
          box_lines<kBundle>(&raster.at(kBundle * i, 0), raster.height, raster.width, reach.columns,
                             wraps_north, sums);
        });
      }
#pragma omp for schedule(static)
      for (int x = kBundle * bundles; x < raster.width; ++x) {
        errors.guard([&] {
          box_lines<1>(&raster.at(x, 0), raster.height, raster.width, reach.columns, wraps_north,
                       sums);
        });
      }
    }
  }
  errors.rethrow();
}

}  // namespace

Raster blur(const MapFrame& frame, const Raster& raster, double radius_px) {
  Raster out = raster;
  BlurReach reach{std::vector<int>(raster.height), static_cast<int>(std::lround(radius_px))};
  if (frame.is_aligned()) {
    const double ground_m = radius_px * frame.pixel_north_m(raster.height / 2);
    for (int y = 0; y < raster.height; ++y) {
      reach.rows[y] =
          static_cast<int>(std::min(std::lround(ground_m / std::max(frame.pixel_east_m(y), 1e-3)),
                                    static_cast<long>(out.width / 8)));
    }
    blur_thrice(frame, out, reach);
    return out;
  }
  std::fill(reach.rows.begin(), reach.rows.end(), reach.columns);
  Raster there(frame, 1.0F);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    if (out.values[i] == out.values[i]) continue;
    out.values[i] = there.values[i] = 0.0F;
  }
  blur_thrice(frame, out, reach);
  blur_thrice(frame, there, reach);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = raster.values[i] == raster.values[i] ? out.values[i] / there.values[i]
                                                         : std::numeric_limits<float>::quiet_NaN();
  }
  return out;
}

void change_per_pixel(const Raster& raster, int y, std::vector<float>& change) {
  const int width = raster.width, above = std::max(y - 1, 0),
            below = std::min(y + 1, raster.height - 1);
  const float* const here = &raster.values[static_cast<std::size_t>(y) * width];
  const float* const up = &raster.values[static_cast<std::size_t>(above) * width];
  const float* const down = &raster.values[static_cast<std::size_t>(below) * width];
  const float per_row = below - above == 2 ? 0.5F : 1.0F;
  change.resize(width);
  float* const out = change.data();
  const auto larger = [&](int x, int west, int east, float per_column) {
    const float across = std::abs(here[east] - here[west]) * per_column;
    const float along = std::abs(down[x] - up[x]) * per_row;
    const float most = across < along ? along : across;
    out[x] = most == most ? most : 0.0F;
  };
#pragma omp simd
  for (int x = 1; x < width - 1; ++x) larger(x, x - 1, x + 1, 0.5F);
  for (const int x : {0, width - 1}) {
    const int west = raster.west_of(x), east = raster.east_of(x);
    larger(x, west, east, west == x || east == x ? 1.0F : 0.5F);
  }
}

}  // namespace geo::io
