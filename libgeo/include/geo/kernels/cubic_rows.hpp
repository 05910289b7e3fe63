#pragma once

#include <array>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Reads fields of one sphere grid at the cell centres of another, row by row, so that a smooth
/// field needs no copy at full resolution. Catmull-Rom cubics along meridians and parallels,
/// across the date line and the poles; where both grids are equal the values come back unchanged.
class CubicRows {
 public:
  CubicRows(const Grid& from, const Grid& to);
  /// Values of `field` (one per cell of `from`) along row `row` of `to`. `scratch` is resized.
  void read(std::span<const float> field, int row, std::span<float> out,
            std::vector<float>& scratch) const;

 private:
  struct Stencil {
    int first;
    std::array<float, 4> weight;
  };
  static std::vector<Stencil> stencils(int from, int to);
  int nx_, ny_;
  std::vector<Stencil> columns_, rows_;
};

}  // namespace geo
