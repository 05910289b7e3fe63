#include "geo/stages/isostasy/coarse_grid.hpp"

#include <algorithm>

namespace geo {

CoarseGrid::CoarseGrid(const Grid& fine)
    : fine_(fine),
      grid_(fine.nx() <= kColumns
                ? fine
                : Grid::sphere(kColumns, kColumns / 2, fine.figure(), fine.turn())) {}

std::pair<int, int> CoarseGrid::first(int column, int row, double within) const {
  return {std::min(fine_.nx(), static_cast<int>((column + within) * fine_.nx() / grid_.nx())),
          std::min(fine_.ny(), static_cast<int>((row + within) * fine_.ny() / grid_.ny()))};
}

CoarseGrid::Boundaries CoarseGrid::strongest(std::span<const std::int8_t> type,
                                             std::span<const float> strength) const {
  Boundaries found{std::vector<std::int8_t>(grid_.size(), 0),
                   std::vector<float>(grid_.size(), 0.0F)};
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    const int column = grid_.column(cell), row = grid_.row(cell);
    const auto [i0, j0] = first(column, row, 0.0);
    const auto [i1, j1] = first(column + 1, row + 1, 0.0);
    for (int j = j0; j < std::max(j1, j0 + 1); ++j) {
      for (int i = i0; i < std::max(i1, i0 + 1); ++i) {
        const Index at = fine_.cell(i, j);
        if (type[at] == 0 || strength[at] <= found.strength[cell]) continue;
        found.type[cell] = type[at];
        found.strength[cell] = strength[at];
      }
    }
  }
  return found;
}

}  // namespace geo
