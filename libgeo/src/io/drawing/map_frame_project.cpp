// Pixels of a projected page from the raster of its source.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/remapping/cubic_weights.hpp"
#include "map_frame.hpp"

namespace geo::io {
namespace {

// Means along rows near the poles, where cells are narrower than high, over as many as one is high.
void widen_rows(const MapFrame& source, Sampled& sampled) {
  const int width = sampled.mean.width;
  const auto widen = [&](int y) {
    const double cells = source.pixel_north_m(y) / std::max(source.pixel_east_m(y), 1e-3);
    const int reach = std::min(static_cast<int>(std::lround(0.5 * (cells - 1.0))), width / 2 - 1);
    if (reach < 1) return;
    std::vector<double> sums(width + 2 * reach + 1, 0.0), covers(sums.size(), 0.0);
    for (int i = 0; i < width + 2 * reach; ++i) {
      const int x =
          source.wraps_east() ? (i - reach + width) % width : std::clamp(i - reach, 0, width - 1);
      const float cover = sampled.cover.at(x, y);
      sums[i + 1] = sums[i] + (cover > 0.0F ? cover * sampled.mean.at(x, y) : 0.0F);
      covers[i + 1] = covers[i] + cover;
    }
    for (int x = 0; x < width; ++x) {
      const double cover = covers[x + 2 * reach + 1] - covers[x];
      const double sum = sums[x + 2 * reach + 1] - sums[x];
      sampled.cover.at(x, y) = static_cast<float>(cover / (2 * reach + 1));
      sampled.mean.at(x, y) =
          cover > 1e-9 ? static_cast<float>(sum / cover) : std::numeric_limits<float>::quiet_NaN();
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < sampled.mean.height; ++y) errors.guard([&] { widen(y); });
  errors.rethrow();
}

// Weights of four neighbours, the second and third of them around the point.
std::array<float, 4> weights(Filter filter, float t) {
  if (filter == Filter::linear) return {0.0F, 1.0F - t, t, 0.0F};
  return b_spline_weights(t);
}

}  // namespace

Sampled MapFrame::project(Sampled sampled, Filter filter) const {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const bool round = grid().topology() == Topology::sphere;
  widen_rows(*source_, sampled);
  const int columns = sampled.mean.width, rows = sampled.mean.height;
  Sampled out{Raster(*this, kNaN), Raster(*this, kNaN)};
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!shows(x, y)) continue;
      const PagePoint point = source_point(at(x, y));
      const int i = static_cast<int>(std::floor(point.x)),
                j = static_cast<int>(std::floor(point.y));
      const auto across = weights(filter, static_cast<float>(point.x - i));
      const auto down = weights(filter, static_cast<float>(point.y - j));
      float sum = 0.0F, there = 0.0F;
      for (int b = 0; b < 4; ++b) {
        if (down[b] == 0.0F) continue;
        int row = j - 1 + b, turned = 0;
        if (round && (row < 0 || row >= rows)) {  // over the pole
          row = row < 0 ? -1 - row : 2 * rows - 1 - row;
          turned = columns / 2;
        }
        row = std::clamp(row, 0, rows - 1);
        for (int a = 0; a < 4; ++a) {
          if (across[a] == 0.0F) continue;
          const int asked = i - 1 + a + turned;
          const int column =
              round ? (asked % columns + columns) % columns : std::clamp(asked, 0, columns - 1);
          const float cover = sampled.cover.at(column, row);
          if (!(cover > 0.0F)) continue;
          const float weight = across[a] * down[b] * cover;
          sum += weight * sampled.mean.at(column, row);
          there += weight;
        }
      }
      out.cover.at(x, y) = there;
      if (there > 0.0F) out.mean.at(x, y) = sum / there;
    }
  }
  return out;
}

Raster MapFrame::project_nearest(const Raster& source) const {
  Raster out(*this, std::numeric_limits<float>::quiet_NaN());
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!shows(x, y)) continue;
      const PagePoint point = source_point(at(x, y));
      out.at(x, y) =
          source.at(std::clamp(static_cast<int>(std::lround(point.x)), 0, source.width - 1),
                    std::clamp(static_cast<int>(std::lround(point.y)), 0, source.height - 1));
    }
  }
  return out;
}

}  // namespace geo::io
