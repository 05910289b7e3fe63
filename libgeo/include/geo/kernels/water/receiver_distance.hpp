#pragma once

#include "geo/core/grid.hpp"

namespace geo {

/// Distance from each cell of a row to its receiver: from the flat offset inside the grid, by
/// search at its edges.
class ReceiverDistance {
 public:
  ReceiverDistance(const Grid& grid, int row) : grid_(grid), row_(row) {
    const auto& distance = grid.distances_m(row);
    for (int k = 0; k < kDirections; ++k) {
      by_step_[kRowStep[k] + 1][kColumnStep[k] + 1] = distance[k];
    }
  }
  [[nodiscard]] double operator()(Index cell, int column, Index receiver) const {
    if (grid_.is_interior(column, row_)) {
      const Index step = receiver - cell + grid_.nx() + 1;  // row step * nx + column step, shifted
      const Index row_step = step / grid_.nx();
      return by_step_[row_step][step - row_step * grid_.nx()];
    }
    for (int k = 0; k < kDirections; ++k) {
      if (grid_.neighbour(column, row_, k) == receiver) return grid_.distances_m(row_)[k];
    }
    return grid_.distances_m(row_)[kNorth];
  }

 private:
  const Grid& grid_;
  int row_;
  double by_step_[3][3] = {};
};

}  // namespace geo
