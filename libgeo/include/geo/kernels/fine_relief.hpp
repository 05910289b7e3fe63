#pragma once

#include <cstdint>
#include <span>
#include <string_view>
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

/// Roughness of a planet's relief at the scale of its own cells, m: the root mean square, over the
/// four directions through a cell, of its height above the mean of the two neighbours, and over the
/// cell and its eight neighbours. Slopes do not count, and heights beyond a shore count as the sea
/// level. `covered` holds one value per covered cell of the planet.
void local_roughness(const PlanetCells& cells, std::span<const float> planet_elevation_m,
                     std::span<float> covered);

/// Detail below the planet's own cells.
struct DetailLaw {
  double wavelength_m = 20e3;  ///< of the first octave
  int octaves = 6;
  double gain = 0.5;  ///< amplitude of each octave over that of the one before, 2^-Hurst
};

/// Fractional Brownian motion of unit variance at every cell: a function of seed, stream and
/// position.
void unit_detail(const Grid& fine, const DetailLaw& law, std::uint64_t seed,
                 std::string_view stream, std::span<float> detail);

/// A height with detail on it. Plains near the level of the sea would become flats at it wherever
/// detail dips further: `inland` (0 to 1), h exp(d / h) stays above it and drains.
[[nodiscard]] double with_detail(double height_m, double detail_m, double inland);

/// Smooth step from 0 at the edge of a plane to 1 at `width_m` from it, at one cell.
double edge_ramp(const Grid& fine, int column, int row, double width_m);

}  // namespace geo
