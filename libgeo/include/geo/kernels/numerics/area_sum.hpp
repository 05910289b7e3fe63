#pragma once

#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Sum over cells of area * value(cell), row by row: the same for any number of threads. Number may
/// carry derivatives (core/numeric.hpp).
template <class Number, class Value>
Number area_sum(const Grid& grid, Value&& value) {
  std::vector<Number> rows(grid.ny());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    Number sum(0.0);
    for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
      sum += value(cell);
    }
    rows[j] = sum * grid.area_m2(j);
  }
  Number total(0.0);
  for (const Number& row : rows) total += row;
  return total;
}

}  // namespace geo
