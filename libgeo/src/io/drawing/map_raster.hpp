#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/parallel_errors.hpp"
#include "map_page.hpp"

namespace geo::io {

class MapFrame;

/// Values of the pixels of a map, row 0 at its upper edge.
struct Raster {
  int width = 0, height = 0;
  bool wraps_east = false;
  std::vector<float> values;

  Raster() = default;
  explicit Raster(const MapFrame& frame, float value = 0.0F);
  [[nodiscard]] float& at(int x, int y) { return values[static_cast<std::size_t>(y) * width + x]; }
  [[nodiscard]] float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * width + x];
  }
  [[nodiscard]] const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * width;
  }
  /// Neighbouring columns: round the planet, or the column itself at an edge.
  [[nodiscard]] int west_of(int x) const { return x > 0 ? x - 1 : wraps_east ? width - 1 : 0; }
  [[nodiscard]] int east_of(int x) const { return x < width - 1 ? x + 1 : wraps_east ? 0 : x; }
};

/// The cells of one axis that a pixel sees, with weights that sum to 1.
struct Taps {
  std::vector<int> begin;  ///< of pixel i: taps begin[i] to begin[i + 1]
  std::vector<int> index;
  std::vector<float> weight;
};

enum class Filter {
  linear,  ///< between cell centres
  smooth,  ///< cubic B-spline: no facets, the slope is continuous
};

/// A resampled field: mean over those cells where it exists, and the share of the pixel where it
/// does. `mean` is NaN where the share is 0.
struct Sampled {
  Raster mean, cover;
};

/// What of the ground a pixel of a projected map shows: metres east and north from its left to its
/// right edge, and from its upper to its lower one.
struct PixelGround {
  float across_east, across_north, down_east, down_north;
};

/// Length on the ground of a pixel of a map, and largest over smallest of its lengths.
struct MapScale {
  double metres_per_px, varies;
};

/// How a grid lies on the pixels of its map. Where pixels are larger than cells a pixel takes the
/// mean of what it covers, else it interpolates.
///
/// On an aligned page columns and rows are resampled one after the other. On a projected one the
/// grid is first brought to cells as large as pixels on the ground (the source), towards the poles
/// as wide as high, and each pixel then interpolates between those.
class MapFrame {
 public:
  explicit MapFrame(const MapPage& page);

  [[nodiscard]] const Grid& grid() const { return page_->grid(); }
  [[nodiscard]] const MapPage& page() const { return *page_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool is_aligned() const { return aligned_; }
  /// Whether the eastern edge of the page goes on at its western one.
  [[nodiscard]] bool wraps_east() const {
    return is_aligned() && grid().topology() != Topology::plane;
  }
  /// Pixels across a cell (less than 1 where the map is coarser).
  [[nodiscard]] double pixels_per_column() const { return columns_px_; }
  [[nodiscard]] double pixels_per_row() const { return rows_px_; }
  [[nodiscard]] bool is_coarser() const { return rows_px_ < 1.0; }
  /// Extent of a pixel on the ground in a row of pixels of an aligned page, m.
  [[nodiscard]] double pixel_east_m(int y) const;
  [[nodiscard]] double pixel_north_m(int y) const;
  /// Side of a typical pixel on the ground, m.
  [[nodiscard]] double pixel_m() const { return pixel_m_; }
  [[nodiscard]] MapScale scale() const;

  /// Whether a pixel shows a part of the planet.
  [[nodiscard]] bool shows(int x, int y) const {
    return is_aligned() || latitude_deg_[at(x, y)] == latitude_deg_[at(x, y)];
  }
  /// The cell in the middle of a pixel, kNoCell beyond the edge of the map.
  [[nodiscard]] Index cell_at(int x, int y) const;
  /// What a pixel of a projected page shows; needs shows(x, y).
  [[nodiscard]] const PixelGround& ground(int x, int y) const { return ground_[at(x, y)]; }
  /// A vector of the ground as it points on the page (x to the right, y down), as long as it was.
  [[nodiscard]] PagePoint on_page(int x, int y, double east, double north) const;

  [[nodiscard]] Taps column_taps(Filter filter) const;
  [[nodiscard]] Taps row_taps(Filter filter) const;

  /// The grid in cells about as large as pixels; of projected pages.
  [[nodiscard]] const MapFrame& source() const { return *source_; }
  /// Pixels of a projected page from those of its source; NaN beyond the edge of the map.
  [[nodiscard]] Sampled project(Sampled source, Filter filter) const;
  [[nodiscard]] Raster project_nearest(const Raster& source) const;

 private:
  MapFrame(const MapPage& page, int width_px, int height_px);
  void locate_pixels();
  void measure_ground(const std::vector<Centre>& places);
  void choose_source();
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * width_ + x;
  }
  [[nodiscard]] int row_under(int y) const;
  /// Position in the rasters of the source, from the upper left centre of a pixel.
  [[nodiscard]] PagePoint source_point(std::size_t pixel) const;

  const MapPage* page_;
  bool aligned_ = true;
  int width_, height_;
  double columns_px_, rows_px_, pixel_m_;
  std::unique_ptr<MapFrame> source_;
  // Of projected pages; degrees from the south-western corner of the grid, NaN beyond the edge.
  std::vector<float> latitude_deg_, longitude_deg_;
  std::vector<PixelGround> ground_;
};

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
