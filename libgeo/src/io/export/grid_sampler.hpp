#pragma once

#include <cmath>
#include <span>

#include "geo/core/grid.hpp"

namespace geo::io {

/// A place on a grid in cells: whole numbers are centres of cells, rows count northwards.
struct GridPlace {
  double column, row;
};

/// Reads a field anywhere on its grid: bicubic convolution (a = -1/2, as in geo::CatmullRom) round
/// a planet and a torus, up to the edges of a plane. The centre of a cell has its very value, a
/// pole the mean of the cells around it, and nothing lies beyond the field's own range.
class GridSampler {
 public:
  GridSampler(const Grid& grid, std::span<const float> values);

  /// NaN where the nearest cell is; beside such cells the nearest value.
  [[nodiscard]] float at(GridPlace place) const;
  /// The cell that a place lies in.
  [[nodiscard]] Index nearest(GridPlace place) const;
  [[nodiscard]] float least() const { return least_; }
  [[nodiscard]] float most() const { return most_; }
  /// Whether there are cells without a value.
  [[nodiscard]] bool has_gaps() const { return gaps_; }

  /// Where a geographic position lies on the grid of a planet or a window.
  [[nodiscard]] static GridPlace place_of(const Grid& grid, double latitude_deg,
                                          double longitude_deg);

 private:
  [[nodiscard]] Index cell_at(int column, int row) const;

  const Grid& grid_;
  std::span<const float> values_;
  float least_, most_, south_pole_ = 0.0F, north_pole_ = 0.0F;
  bool gaps_ = false;
};

}  // namespace geo::io
