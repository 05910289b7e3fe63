#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
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

/// Values of a grid's cells at those of a page.
template <class T>
std::vector<T> thinned(std::span<const T> values, const Grid& grid, const Thinning& cells) {
  std::vector<T> out;
  out.reserve(cells.size());
  for (int j = 0; j < cells.ny; ++j) {
    for (int i = 0; i < cells.nx; ++i) {
      out.push_back(values[grid.cell(cells.column(i), cells.row(j))]);
    }
  }
  return out;
}

inline constexpr std::array<const char*, Climatology::kMonths> kMonthNames{
    "January", "February", "March",     "April",   "May",      "June",
    "July",    "August",   "September", "October", "November", "December"};
/// A month's rain has the colours of a year with this many times as much; with twelve, classes
/// would not end at round numbers.
inline constexpr float kRainOfAYear = 12.5F;

/// The year of a planet as far as pictures show it, on the cells of a page.
struct PlanetMonths {
  Thinning cells;
  Climatology::Monthly temperature_c, precipitation_mm;
};

/// Reads it from a climate file on `grid` that has months; none where it has not.
std::optional<PlanetMonths> read_planet_months(const std::filesystem::path& file, const Grid& grid,
                                               int most_columns);

}  // namespace geo::io
