#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geo/core/grid.hpp"
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

}  // namespace geo::io
