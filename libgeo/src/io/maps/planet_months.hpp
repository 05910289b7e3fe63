#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "geo/core/climatology.hpp"
#include "geo/core/grid.hpp"

namespace geo::io {

/// Which cells of a grid a page has: every `step`th, from the middle of the first step, so that
/// there are at most `most` columns.
struct Thinning {
  Thinning(const Grid& grid, int most_columns)
      : step(std::max(1, (grid.nx() + most_columns - 1) / most_columns)),
        nx(grid.nx() / step),
        ny(std::max(1, grid.ny() / step)) {}
  [[nodiscard]] int column(int i) const { return i * step + step / 2; }
  [[nodiscard]] int row(int j) const { return j * step + step / 2; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(nx) * ny; }

  int step, nx, ny;
};

/// The year of a planet as far as pictures show it, on the cells of a page.
struct PlanetMonths {
  Thinning cells;
  Climatology::Monthly temperature_c, precipitation_mm;
};

/// Reads it from a climate file on `grid` that has months; none where it has not.
std::optional<PlanetMonths> read_planet_months(const std::filesystem::path& file, const Grid& grid,
                                               int most_columns);

}  // namespace geo::io
