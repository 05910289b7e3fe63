#pragma once

#include <array>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/noise/noise.hpp"

namespace geo {

/// Noise along one row of a grid, in those columns that want it. Holds scratch: one per thread.
class NoiseRow {
 public:
  explicit NoiseRow(const Grid& grid) : grid_(grid) {}

  /// Chooses the columns of `row` for which `wanted(column)` is true.
  template <class Wanted>
  void choose(int row, Wanted&& wanted) {
    row_ = row;
    columns_.clear();
    positions_.clear();
    for (int i = 0; i < grid_.nx(); ++i) {
      if (!wanted(i)) continue;
      columns_.push_back(i);
      positions_.push_back(grid_.unit_vector(i, row));
    }
  }
  void choose_all(int row) {
    choose(row, [](int) { return true; });
  }
  /// Noise::fbm at the chosen columns of `line`; the others stay as they are.
  void fbm(const Noise& noise, double frequency, int octaves, double gain, std::span<float> line) {
    values_.resize(columns_.size());
    noise.fbm(positions_, frequency, octaves, gain, values_);
    for (std::size_t k = 0; k < columns_.size(); ++k) line[columns_[k]] = values_[k];
  }

  /// The westernmost cell of the chosen row.
  [[nodiscard]] Index first_cell() const { return grid_.cell(0, row_); }

 private:
  const Grid& grid_;
  int row_ = 0;
  std::vector<int> columns_;
  std::vector<std::array<double, 3>> positions_;
  std::vector<float> values_;
};

}  // namespace geo
