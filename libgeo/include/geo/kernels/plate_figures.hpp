#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Kinds of plate boundary as Bird (2003) tells them apart; his ocean-continent and oceanic
/// convergence are one here.
enum class BoundaryKind : int {
  ocean_ridge,
  continental_rift,
  ocean_transform,
  continental_transform,
  subduction,  ///< convergent with ocean floor on at least one side
  collision,   ///< convergent between continents
};
inline constexpr int kBoundaryKinds = 6;

/// Fields of plates, one value per cell.
struct PlateFields {
  std::span<const std::int16_t> plate_id;
  std::span<const std::int8_t> boundary_type;  ///< of cells near boundaries, else interior
  std::span<const float> continental_fraction;
  std::span<const float> velocity_east_mm_yr, velocity_north_mm_yr;
};

struct BoundaryFigures {
  std::array<double, kBoundaryKinds> length_m{};
  /// Mean speed at which the plates part, across the boundary and by its length; negative where
  /// they approach. 0 where there is no such boundary.
  std::array<double, kBoundaryKinds> opening_mm_yr{};
  double untyped_m = 0.0;  ///< where no cell nearby has a boundary type

  [[nodiscard]] double total_m() const;
};

/// Lengths of plate boundaries on the whole planet. A raster outline is a staircase, too long by up
/// to 41 %, and finer rasters show more wiggles; so plates are looked at in cells of half a degree
/// (the step of Bird's digitised boundaries; their own where they are coarser), and the length is
/// the total variation of each plate's indicator, smoothed 1:2:1 both ways,
///   L = 1/2 sum_p integral |grad 1_p| dA,
/// within 2.5 % of the truth for a straight line in any direction. Type and continental crust come
/// from the cells of the same neighbourhood, the rate from the relative velocity of the two plates
/// along the gradient. Shapes must fit the grid (InputError). Cost: linear.
BoundaryFigures measure_boundaries(const Grid& grid, const PlateFields& plates);

/// Shares of the area that the plates cover, the largest first.
std::vector<double> plate_shares(const Grid& grid, std::span<const std::int16_t> plate_id);

/// Root mean square speed over the planet in the frame in which the surface has no net rotation:
///   W = (3 / 8 pi) integral r x v dOmega, v' = v - W x r   (Solomon & Sleep 1974).
/// Velocities in mm/yr, one per cell of a sphere.
double speed_without_net_rotation(const Grid& grid, std::span<const float> velocity_east,
                                  std::span<const float> velocity_north);

}  // namespace geo
