#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

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

/// How a grid lies on the pixels of its map. Where pixels are larger than cells a pixel takes the
/// mean of what it covers, else it interpolates.
class MapFrame {
 public:
  MapFrame(const Grid& grid, int width_px, int height_px);

  [[nodiscard]] const Grid& grid() const { return *grid_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool wraps_east() const { return grid_->topology() != Topology::plane; }
  /// Pixels across a cell (less than 1 where the map is coarser).
  [[nodiscard]] double pixels_per_column() const { return double(width_) / grid_->nx(); }
  [[nodiscard]] double pixels_per_row() const { return double(height_) / grid_->ny(); }
  [[nodiscard]] bool is_coarser() const { return pixels_per_row() < 1.0; }
  /// Extent of a pixel on the ground in a row of pixels, m.
  [[nodiscard]] double pixel_east_m(int y) const;
  [[nodiscard]] double pixel_north_m(int y) const;
  /// Position of a cell centre, pixels from the upper left corner of the map.
  [[nodiscard]] double x_of(double column) const { return (column + 0.5) * pixels_per_column(); }
  [[nodiscard]] double y_of(double row) const { return height_ - (row + 0.5) * pixels_per_row(); }

  [[nodiscard]] Taps column_taps(Filter filter) const;
  [[nodiscard]] Taps row_taps(Filter filter) const;

 private:
  [[nodiscard]] int row_under(int y) const;
  const Grid* grid_;
  int width_, height_;
};

/// A resampled field: mean over those cells where it exists, and the share of the pixel where it
/// does. `mean` is NaN where the share is 0.
struct Sampled {
  Raster mean, cover;
};

/// Resamples `value(cell)`, NaN where there is none.
template <class Value>
Sampled sample(const MapFrame& frame, Filter filter, const Value& value) {
  const auto columns = frame.column_taps(filter), rows = frame.row_taps(filter);
  Sampled out{Raster(frame), Raster(frame)};
  const int nx = frame.grid().nx();
#pragma omp parallel for schedule(static)
  for (int y = 0; y < frame.height(); ++y) {
    float* const mean = &out.mean.at(0, y);
    float* const cover = &out.cover.at(0, y);
    for (int j = rows.begin[y]; j < rows.begin[y + 1]; ++j) {
      const Index base = rows.index[j] * nx;
      for (int x = 0; x < frame.width(); ++x) {
        float sum = 0.0F, there = 0.0F;
        for (int i = columns.begin[x]; i < columns.begin[x + 1]; ++i) {
          const float v = value(base + columns.index[i]);
          if (v == v) {
            sum += columns.weight[i] * v;
            there += columns.weight[i];
          }
        }
        mean[x] += rows.weight[j] * sum;
        cover[x] += rows.weight[j] * there;
      }
    }
    for (int x = 0; x < frame.width(); ++x) {
      mean[x] = cover[x] > 0.0F ? mean[x] / cover[x] : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return out;
}

/// The category that covers most of each pixel; the nearest one where pixels are finer. Of equal
/// shares the lowest wins.
Raster sample_majority(const MapFrame& frame, std::span<const std::int8_t> categories);

/// Running mean over a square of that many pixels of latitude, three times (nearly Gaussian);
/// widened with latitude, so that it is round on the ground.
Raster blur(const MapFrame& frame, const Raster& raster, double radius_px);

/// Change of a raster per pixel, larger of the two directions (borders are drawn one pixel wide).
float change_per_pixel(const Raster& raster, int x, int y);

}  // namespace geo::io
