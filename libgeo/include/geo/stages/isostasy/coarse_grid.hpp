#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/core/grid.hpp"

namespace geo {

/// The planet as far as plates shape it from afar: nothing here is sharper than some tens of
/// kilometres, so a grid of that spacing holds it, the same for all finer ones.
class CoarseGrid {
 public:
  explicit CoarseGrid(const Grid& fine);

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const Grid& fine() const { return fine_; }

  /// The value at the middle of each cell.
  template <class T>
  [[nodiscard]] std::vector<T> middle(std::span<const T> values) const {
    std::vector<T> out(grid_.size());
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      const auto [i, j] = first(grid_.column(cell), grid_.row(cell), 0.5);
      out[cell] = values[fine_.cell(i, j)];
    }
    return out;
  }

  struct Boundaries {
    std::vector<std::int8_t> type;
    std::vector<float> strength;
  };
  /// The strongest boundary within each cell.
  [[nodiscard]] Boundaries strongest(std::span<const std::int8_t> type,
                                     std::span<const float> strength) const;

 private:
  /// Column and row of the fine grid at a share `within` of a coarse cell.
  [[nodiscard]] std::pair<int, int> first(int column, int row, double within) const;

  static constexpr int kColumns = 1024;
  const Grid& fine_;
  Grid grid_;
};

}  // namespace geo
