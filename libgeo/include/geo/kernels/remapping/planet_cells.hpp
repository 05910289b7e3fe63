#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// How a fine grid lies on the cells of a planet: which cell each of its own falls into, and means
/// over them. Covers the rows of the planet that the fine grid touches, and two more on each side.
class PlanetCells {
 public:
  /// Throws InputError unless `planet` is a sphere and `fine` geographic.
  PlanetCells(const Grid& planet, const Grid& fine);

  [[nodiscard]] const Grid& planet() const noexcept { return planet_; }
  [[nodiscard]] const Grid& fine() const noexcept { return fine_; }
  [[nodiscard]] int first_row() const noexcept { return first_row_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }
  /// Size of arrays with one value for each covered cell of the planet.
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(rows_) * planet_.nx();
  }
  /// Place of a planet cell in such an array.
  [[nodiscard]] std::size_t at(int column, int row) const noexcept {
    return static_cast<std::size_t>(row - first_row_) * planet_.nx() + column;
  }
  /// Planet cell that each fine cell lies in.
  [[nodiscard]] std::span<const Index> cell_of() const noexcept { return cell_; }

  /// Means of `values` over the fine cells that `wanted` (empty: all) marks, in each covered planet
  /// cell; `otherwise` where there are none. The same for any number of threads.
  /// One value per fine cell; Bug otherwise.
  [[nodiscard]] std::vector<float> means(std::span<const float> values,
                                         std::span<const std::uint8_t> wanted,
                                         float otherwise) const;
  /// Catmull-Rom through such an array at a fine cell.
  [[nodiscard]] double interpolate(std::span<const float> covered, int column, int row) const;

 private:
  const Grid& planet_;
  const Grid& fine_;
  int first_row_ = 0, rows_ = 0;
  std::vector<Index> cell_;
};

}  // namespace geo
