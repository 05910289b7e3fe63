#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {

/// Width of the valleys that a grid can hold, m: that of a cell, and where meridians converge the
/// height of the row (see widen_valleys).
inline double valley_width_m(const Grid& grid, int row) {
  const double cell_m = std::sqrt(grid.area_m2(row));
  return grid.topology() == Topology::sphere ? std::max(cell_m, grid.face_east_m(row)) : cell_m;
}

/// Area by which a cell as wide as its valley would exceed a cell of this row, m2.
inline double valley_floor_beyond_cell_m2(const Grid& grid, int row) {
  if (grid.topology() != Topology::sphere) return 0.0;
  const double height_m = grid.face_east_m(row);
  return std::max(0.0, height_m * height_m - grid.area_m2(row));
}

namespace detail {

/// Valleys of one row of a sphere whose cells are narrower than high.
class RowOfValleys {
 public:
  explicit RowOfValleys(int columns)
      : before_(columns), after_(columns), lowest_(columns), source_(columns) {}

  /// `before_m`, `elevation_m`, `fixed`: the row's cells, as in widen_valleys.
  template <class V>
  void widen(double width_m, double height_m, const V* before_m, const std::uint8_t* fixed,
             V* elevation_m) {
    draw_bell(width_m, height_m);
    for (int i = 0; i < columns(); ++i) {
      before_[i] = value_of(before_m[i]);
      lowest_[i] = after_[i] = value_of(elevation_m[i]);
      source_[i] = i;
    }
    for (int s = 0; s < columns(); ++s) {
      if (fixed[s] == 0 && is_source(s)) {
        for (const int side : {-1, 1}) spread(s, side, fixed);
      }
    }
    lower(before_m, elevation_m);
  }

 private:
  [[nodiscard]] int columns() const { return static_cast<int>(source_.size()); }
  [[nodiscard]] double cut_m(int i) const { return before_[i] - after_[i]; }
  [[nodiscard]] int east(int i) const { return i + 1 < columns() ? i + 1 : 0; }
  [[nodiscard]] int west(int i) const { return i > 0 ? i - 1 : columns() - 1; }

  /// cos² out to half a height, as far as the row goes round.
  void draw_bell(double width_m, double height_m) {
    bell_.clear();
    for (int k = 1; k * width_m < height_m && 2 * k < columns(); ++k) {
      const double c = std::cos(0.5 * std::numbers::pi * k * width_m / height_m);
      bell_.push_back(c * c);
    }
  }
  [[nodiscard]] bool is_source(int s) const {
    constexpr double kLeast_m = 1e-3;  // of lowering that makes a valley
    return cut_m(s) >= kLeast_m && cut_m(s) >= cut_m(west(s)) && cut_m(s) >= cut_m(east(s));
  }
  void spread(int s, int side, const std::uint8_t* fixed) {
    int i = s;
    for (const double share : bell_) {
      i = side < 0 ? west(i) : east(i);
      if (fixed[i] != 0) return;
      const double to = std::max(before_[i] - share * cut_m(s), after_[s]);
      if (to >= lowest_[i]) continue;
      lowest_[i] = to;
      source_[i] = s;
    }
  }
  /// Beds first come as they are; then what they took from others, from the same step's values.
  template <class V>
  void lower(const V* before_m, V* elevation_m) const {
    const std::vector<V> beds(elevation_m, elevation_m + columns());
    for (int i = 0; i < columns(); ++i) {
      const int s = source_[i];
      if (s == i) continue;
      const int apart = std::min((s - i + columns()) % columns(), (i - s + columns()) % columns());
      const V taken(bell_[apart - 1] * (before_m[s] - beds[s]));
      elevation_m[i] = greater(V(before_m[i] - taken), beds[s]);
    }
  }

  std::vector<double> before_, after_, lowest_, bell_;
  std::vector<int> source_;  ///< whose valley each cell is part of
};

}  // namespace detail

/// Valleys as wide as the cells are high. A river lowers one cell; where meridians converge cells
/// are slivers, and the valley of a river along a meridian would be as narrow as they are, that of
/// one along a parallel as wide as anywhere. So what a step of incision took from a cell it takes
/// from its row around as well, over a bell cos²(π x / 2 h) of half its width h, the height of the
/// cells:
///
///   z(x) = min over sources s of max(z0(x) - bell(x - s) (z0(s) - z1(s)), z1(s))
///
/// with z0 before the step and z1 after it. Nothing is lowered below the bed that lowers it.
/// Sources are the cells that the step lowered more than their neighbours to the west and east;
/// rows of a sphere with cells as wide as high stay as they are. A river along a meridian then
/// takes as much rock per length as one along a parallel. Cells with a non-zero byte in `fixed`
/// keep their height, and no valley reaches across them. Cost: cells times height over width.
///
/// `before_m`: z0, m. `elevation_m`: z1 in, z out. Both have one value per cell.
/// So has `fixed`; Bug otherwise.
template <class V>
void widen_valleys(const Grid& grid, std::span<const V> before_m,
                   std::span<const std::uint8_t> fixed, std::span<V> elevation_m) {
  check_sizes("widen_valleys", grid.size(),
              {{"before_m", before_m.size()},
               {"fixed", fixed.size()},
               {"elevation_m", elevation_m.size()}});
  if (grid.topology() != Topology::sphere) return;
  ParallelErrors errors;
#pragma omp parallel
  {
    auto row = errors.make<detail::RowOfValleys>(grid.nx());
#pragma omp for schedule(dynamic, 8)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        const double width_m = grid.spacing_east_m(j), height_m = grid.face_east_m(j);
        if (width_m >= height_m) return;
        const Index begin = grid.cell(0, j);
        row->widen(width_m, height_m, &before_m[begin], &fixed[begin], &elevation_m[begin]);
      });
    }
  }
  errors.rethrow();
}

}  // namespace geo
