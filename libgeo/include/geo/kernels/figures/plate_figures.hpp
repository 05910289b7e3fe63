#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Kinds of plate boundary as Bird (2003) tells them apart, by the direction of the relative motion
/// however slow it is; his ocean-continent and oceanic convergence are one here. Rifts and
/// transforms are continental where the crust of both sides is continental on average.
enum class BoundaryKind : int {
  ocean_ridge,
  continental_rift,
  ocean_transform,        ///< motion within 25 degrees of the boundary
  continental_transform,  ///< likewise
  subduction,             ///< convergent with ocean floor on at least one side
  collision,              ///< convergent between continents
};
inline constexpr int kBoundaryKinds = 6;

/// Fields of plates, one value per cell.
struct PlateFields {
  std::span<const std::int16_t> plate_id;
  std::span<const float> continental_fraction;
  std::span<const float> velocity_east_mm_yr, velocity_north_mm_yr;
};

struct BoundaryFigures {
  std::array<double, kBoundaryKinds> length_m{};
  /// Mean speed at which the plates part, across the boundary and by its length; negative where
  /// they approach. 0 where there is no such boundary.
  std::array<double, kBoundaryKinds> opening_mm_yr{};
  double at_rest_m = 0.0;  ///< between plates that do not move against each other

  [[nodiscard]] double total_m() const;
};

/// Lengths of plate boundaries on the whole planet. A raster outline is a staircase, too long by up
/// to 41 %, and finer rasters show more wiggles; so plates are looked at in cells of half a degree
/// (the step of Bird's digitised boundaries; their own where they are coarser), and the length is
/// the total variation of each plate's indicator, smoothed 1:2:1 both ways,
///   L = 1/2 sum_p integral |grad 1_p| dA,
/// within 2.5 % of the truth for a straight line in any direction. Continental crust comes from the
/// cells of the same neighbourhood, kind and rate from the relative velocity of the two plates
/// across the boundary, which is that along the gradient, and along it; the kind is right on 95 %
/// of a straight line in any direction. For Earth's plates (Bird's outlines and poles) it gives
/// lengths within the tolerances of the scorecard. Shapes must fit the grid (InputError). Cost:
/// linear.
BoundaryFigures measure_boundaries(const Grid& grid, const PlateFields& plates);

/// Shares of the area that the plates cover, the largest first.
std::vector<double> plate_shares(const Grid& grid, std::span<const std::int16_t> plate_id);

/// Root mean square speed over the planet in the frame in which the surface has no net rotation:
///   W = (3 / 8 pi) integral r x v dOmega, v' = v - W x r   (Solomon & Sleep 1974).
/// Velocities in mm/yr, one per cell of a sphere.
double speed_without_net_rotation(const Grid& grid, std::span<const float> velocity_east,
                                  std::span<const float> velocity_north);

}  // namespace geo
