#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "map_frame.hpp"

namespace geo::io {

/// Rows of a grid resampled to the columns of a map, while rows of pixels share them.
class ResampledRows {
 public:
  struct Row {
    int of = -1;
    std::vector<float> sum, share;
  };

  ResampledRows(const Taps& rows, int width) {
    int most = 1;
    for (std::size_t y = 0; y + 1 < rows.begin.size(); ++y) {
      most = std::max(most, rows.begin[y + 1] - rows.begin[y]);
    }
    rows_.resize(most + 1);
    for (Row& row : rows_) {
      row.sum.resize(width);
      row.share.resize(width);
    }
  }

  /// The row of the grid; `fill(row)` computes it where it is not held.
  template <class Fill>
  const Row& get(int row, const Fill& fill) {
    Row& held = rows_[row % rows_.size()];
    if (held.of != row) {
      held.of = row;
      fill(held);
    }
    return held;
  }

 private:
  std::vector<Row> rows_;
};

/// Resamples `value(cell)`, NaN where there is none, on an aligned page. `cover` may be null.
template <class Value>
void resample_rows(const MapFrame& frame, Filter filter, const Value& value, Raster& mean,
                   Raster* cover) {
  const auto columns = frame.column_taps(filter), rows = frame.row_taps(filter);
  const int nx = frame.grid().nx(), width = frame.width();
  // Along the rows of the grid first: each is seen by several rows of pixels where these are finer.
  const auto fill = [&](ResampledRows::Row& row) {
    const Index base = row.of * nx;
    for (int x = 0; x < width; ++x) {
      float sum = 0.0F, there = 0.0F;
      for (int i = columns.begin[x]; i < columns.begin[x + 1]; ++i) {
        const float v = value(base + columns.index[i]);
        if (v == v) {
          sum += columns.weight[i] * v;
          there += columns.weight[i];
        }
      }
      row.sum[x] = sum;
      row.share[x] = there;
    }
  };
  ParallelErrors errors;
#pragma omp parallel
  {
    auto made = errors.make<ResampledRows>(rows, width);
    auto shares = errors.make<std::vector<float>>(width);
#pragma omp for schedule(static)
    for (int y = 0; y < frame.height(); ++y) {
      if (errors.any()) continue;
      ResampledRows& resampled = *made;
      float* const sums = &mean.at(0, y);
      std::fill(shares.begin(), shares.end(), 0.0F);
      for (int j = rows.begin[y]; j < rows.begin[y + 1]; ++j) {
        const auto& row = resampled.get(rows.index[j], fill);
        const float weight = rows.weight[j];
        for (int x = 0; x < width; ++x) {
          sums[x] += weight * row.sum[x];
          shares[x] += weight * row.share[x];
        }
      }
      for (int x = 0; x < width; ++x) {
        sums[x] = shares[x] > 0.0F ? sums[x] / shares[x] : std::numeric_limits<float>::quiet_NaN();
      }
      if (cover != nullptr) std::copy(shares.begin(), shares.end(), &cover->at(0, y));
    }
  }
  errors.rethrow();
}

/// Resamples `value(cell)`, NaN where there is none.
template <class Value>
Sampled sample(const MapFrame& frame, Filter filter, const Value& value) {
  if (!frame.is_aligned()) {
    return frame.project(sample(frame.source(), Filter::linear, value), filter);
  }
  Sampled out{Raster(frame), Raster(frame)};
  resample_rows(frame, filter, value, out.mean, &out.cover);
  return out;
}

/// The same without the share of each pixel where there are values.
template <class Value>
Raster sample_mean(const MapFrame& frame, Filter filter, const Value& value) {
  if (!frame.is_aligned()) return sample(frame, filter, value).mean;
  Raster mean(frame);
  resample_rows(frame, filter, value, mean, nullptr);
  return mean;
}

/// The category that covers most of each pixel; the nearest one where pixels are finer. Of equal
/// shares the lowest wins.
Raster sample_majority(const MapFrame& frame, std::span<const std::int8_t> categories);

/// Running mean over a square of that many pixels of latitude, three times (nearly Gaussian);
/// widened with latitude, so that it is round on the ground. On projected pages round on the page,
/// over the pixels that have a value.
Raster blur(const MapFrame& frame, const Raster& raster, double radius_px);

/// Change of a raster per pixel along a row of pixels, larger of the two directions: borders are
/// drawn one pixel wide. 0 beyond the edge of the map.
void change_per_pixel(const Raster& raster, int y, std::vector<float>& change);

}  // namespace geo::io
