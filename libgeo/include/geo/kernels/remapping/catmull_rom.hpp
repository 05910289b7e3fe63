#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "geo/core/grid.hpp"

namespace geo {

/// The 16 cells of a planet round a place and their weights: bicubic convolution with a = -1/2
/// (Catmull & Rom 1974; Keys 1981) in latitude and longitude. Once continuously differentiable,
/// passes through the values at cell centres, exact for parabolas. Columns wrap; beyond a pole the
/// rows go on half-way round, where components of vectors change their sign.
struct CatmullRom {
  /// Throws InputError unless `planet` is a sphere.
  CatmullRom(const Grid& planet, Centre position);

  /// Interpolates `at(column, row)`.
  template <class At>
  [[nodiscard]] double of(At&& at, double beyond_pole = 1.0) const {
    double sum = 0.0;
    for (int j = 0; j < 4; ++j) {
      const int shift = crossed[j] ? half_round : 0;
      double along = 0.0;
      for (int i = 0; i < 4; ++i) {
        const int k = column[i] + shift;
        along += column_weight[i] * at(k < columns ? k : k - columns, row[j]);
      }
      sum += row_weight[j] * (crossed[j] ? beyond_pole * along : along);
    }
    return sum;
  }
  template <class T>
  [[nodiscard]] double of(std::span<const T> values, double beyond_pole = 1.0) const {
    return of([&](int i, int j) { return static_cast<double>(values[j * columns + i]); },
              beyond_pole);
  }
  /// Least and greatest of the four cells round the place; NaN where one of them is.
  [[nodiscard]] std::pair<float, float> range(std::span<const float> values) const {
    float least = INFINITY, most = -INFINITY;
    for (const int j : {1, 2}) {
      const int shift = crossed[j] ? half_round : 0;
      for (const int i : {1, 2}) {
        const int k = column[i] + shift;
        const float value = values[row[j] * columns + (k < columns ? k : k - columns)];
        if (std::isnan(value)) return {value, value};
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
    return {least, most};
  }
  /// Cell that the place lies in.
  [[nodiscard]] Index nearest() const noexcept { return nearest_; }

  int columns, half_round;
  std::array<int, 4> column, row;
  std::array<bool, 4> crossed;
  std::array<double, 4> column_weight, row_weight;

 private:
  Index nearest_;
};

}  // namespace geo
