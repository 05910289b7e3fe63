#pragma once

#include <array>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// A grid over the same area as `fine`, of the same topology, with cells of about `spacing_m`,
/// never finer than `fine`.
Grid coarser_grid(const Grid& fine, double spacing_m);

/// A coarse raster laid over a fine one: averages elevation onto it and interpolates fields back,
/// so that smooth physics costs nothing per fine cell and does not depend on the fine resolution.
///
/// Either both grids cover the same area (sphere on sphere, torus on torus, plane on plane), or the
/// fine one is a part of the planet (a window, or a plane that knows or is given its latitude)
/// embedded in a coarse sphere.
class ConservativeRemapping {
 public:
  /// Same area, same topology.
  ConservativeRemapping(const Grid& fine, const Grid& coarse);
  /// A part of the planet, by the latitude of its row edges (ny + 1) and the longitude of its
  /// column edges (nx + 1), ascending, degrees.
  ConservativeRemapping(const Grid& fine, const Grid& coarse_sphere,
                        std::span<const double> row_edge_deg,
                        std::span<const double> column_edge_deg);

  [[nodiscard]] const Grid& fine() const noexcept { return fine_; }
  [[nodiscard]] const Grid& coarse() const noexcept { return coarse_; }

  /// Area-weighted mean of the fine values that each coarse cell holds; 0 where the fine grid
  /// covers nothing.
  /// `values`: one per fine cell, `mean`: one per coarse cell; Bug otherwise.
  void average(std::span<const float> values, std::span<float> mean) const;
  /// Area-weighted means of the land fraction (elevation >= 0) and of the elevation above sea
  /// level, and the share of each coarse cell that the fine grid covers (0..1).
  /// `elevation`: one per fine cell, the others one per coarse cell; Bug otherwise.
  void average_elevation(std::span<const float> elevation, std::span<float> land_fraction,
                         std::span<float> height_m, std::span<float> coverage) const;

 private:
  friend class Interpolator;
  /// Calls visit(coarse column, fine column, fine row, share of the coarse cell) for all fine cells
  /// under a coarse row.
  template <class Visit>
  void for_overlaps(int coarse_row, Visit&& visit) const;
  void overlap_columns();

  /// What a coarse column has of a fine one, in widths of the coarse.
  struct ColumnOverlap {
    int coarse, fine;
    double width;
  };
  const Grid& fine_;
  const Grid& coarse_;
  std::vector<double> column_edge_, row_edge_;  ///< in coarse cells from the coarse corner
  std::vector<ColumnOverlap> column_overlaps_;
};

/// Uniform cubic B-spline through a remapping: twice differentiable, never beyond the range of the
/// coarse values, smooths over about one coarse cell. Crosses the poles of a coarse sphere; a
/// component of a vector changes its sign there.
class Interpolator {
 public:
  enum class Kind { scalar, vector_component };
  /// `coarse_values`: one per coarse cell; Bug otherwise.
  Interpolator(const ConservativeRemapping& remapping, std::span<const float> coarse_values,
               Kind kind = Kind::scalar);

  /// Values along one fine row. `scratch` holds at least scratch_size() floats.
  void row(int fine_row, std::span<float> out, std::span<float> scratch) const;
  [[nodiscard]] std::size_t scratch_size() const noexcept { return padded_nx_; }

 private:
  static constexpr int kPad = 2;
  struct Taps {
    int first;
    std::array<float, 4> weight;
  };
  static Taps taps(double position, int count, bool wraps);
  int padded_nx_, padded_ny_;
  std::vector<float> padded_;
  std::vector<Taps> column_taps_, row_taps_;
};

}  // namespace geo
