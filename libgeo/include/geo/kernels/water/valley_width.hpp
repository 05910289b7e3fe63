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
  constexpr double kLeast_m = 1e-3;  // of lowering that makes a valley
  const int nx = grid.nx();
  ParallelErrors errors;
#pragma omp parallel
  {
    auto before = errors.make<std::vector<double>>(nx);
    auto after = errors.make<std::vector<double>>(nx);
    auto lowest = errors.make<std::vector<double>>(nx);
    std::vector<double> bell;
    auto source = errors.make<std::vector<int>>(nx);
#pragma omp for schedule(dynamic, 8)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        const double width = grid.spacing_east_m(j), height = grid.face_east_m(j);
        if (width >= height) return;
        const Index begin = grid.cell(0, j);
        for (int i = 0; i < nx; ++i) {
          before[i] = value_of(before_m[begin + i]);
          lowest[i] = after[i] = value_of(elevation_m[begin + i]);
          source[i] = i;
        }
        bell.clear();
        for (int k = 1; k * width < height && 2 * k < nx; ++k) {
          const double c = std::cos(0.5 * std::numbers::pi * k * width / height);
          bell.push_back(c * c);
        }
        const auto lowered = [&](int i) { return before[i] - after[i]; };
        for (int s = 0; s < nx; ++s) {
          const double cut = lowered(s);
          if (fixed[begin + s] != 0 || cut < kLeast_m) continue;
          if (cut < lowered(s > 0 ? s - 1 : nx - 1) || cut < lowered(s + 1 < nx ? s + 1 : 0))
            continue;
          for (const int side : {-1, 1}) {
            int i = s;
            for (const double share : bell) {
              i += side;
              if (i < 0) i = nx - 1;
              if (i == nx) i = 0;
              if (fixed[begin + i] != 0) break;
              const double to = std::max(before[i] - share * cut, after[s]);
              if (to >= lowest[i]) continue;
              lowest[i] = to;
              source[i] = s;
            }
          }
        }
        // Beds first come as they are; then what they took from others, from the same step's
        // values.
        std::vector<V> beds(elevation_m.begin() + begin, elevation_m.begin() + begin + nx);
        for (int i = 0; i < nx; ++i) {
          const int s = source[i];
          if (s == i) continue;
          const int apart = std::min((s - i + nx) % nx, (i - s + nx) % nx);
          const V taken(bell[apart - 1] * (before_m[begin + s] - beds[s]));
          elevation_m[begin + i] = greater(V(before_m[begin + i] - taken), beds[s]);
        }
      });
    }
  }
  errors.rethrow();
}

}  // namespace geo
