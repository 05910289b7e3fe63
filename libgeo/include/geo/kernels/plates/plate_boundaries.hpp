#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// Relative motion across a boundary, mm/yr; of closing and opening one is zero.
struct RelativeMotion {
  double closing, opening, shear;
};
/// Motion of `other` as seen from `own`, split along the unit tangent `towards` that points from
/// one to the other.
[[nodiscard]] RelativeMotion relative_motion(const Vector3& own_mm_yr, const Vector3& other_mm_yr,
                                             const Vector3& towards, const Vector3& at);

/// The table of Tectonica blueprint 2.4, with scale = max(1.2 cm/yr, 1.25 plate speed):
/// convergent if closing > 0.14 scale, >= 0.95 opening and >= 0.75 shear; divergent likewise;
/// transform if shear > 0.18 scale; else interior.
[[nodiscard]] BoundaryType classify(const RelativeMotion& motion, double plate_speed_cm_yr);

/// A cell of the mesh that touches another plate.
struct BoundaryPoint {
  std::int32_t cell;
  std::int16_t plate, other;
  Vector3 towards;  ///< tangent to the sphere, normal to the boundary, to the other plate
  RelativeMotion motion;
  BoundaryType type;
  double strength;  ///< dominant component over the largest on the planet, 0 to 1
};

/// All boundary cells of a mesh, by cell. The boundary's direction is taken over about
/// `smoothing_km`, and so is the motion of each pair of plates, so that the steps of the mesh do
/// not turn a trench into a chain of transforms. On planets so small that this is more than
/// kWidestSmoothing_rad, over that: further off lie other boundaries. Throws Bug unless `plate` has
/// one value per cell of the mesh.
inline constexpr double kWidestSmoothing_rad = 0.35;
std::vector<BoundaryPoint> find_boundaries(const CubedSphere& mesh,
                                           std::span<const std::int16_t> plate,
                                           std::span<const Vector3> rotation_rad_myr,
                                           double plate_speed_cm_yr, double smoothing_km,
                                           double radius_km);

/// Crust that opening boundaries make and closing ones consume, km2/yr.
struct CrustBudget {
  double created, consumed;
};
/// Fluxes of the relative motion through the sides of cells between plates. The flux of a rotation
/// Ω through an arc of a great circle from a to b is exactly R² Ω . (b - a), so that the steps of a
/// staircase add up to what the smooth line has, whatever its direction; and what plates that fill
/// the sphere make in one place they consume in another: both sums agree to round-off. A side
/// counts as created where the boundary, taken over its smoothing, opens, else as consumed.
[[nodiscard]] CrustBudget crust_budget(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                                       std::span<const BoundaryPoint> boundaries,
                                       std::span<const Vector3> rotation_rad_myr, double radius_km);

/// The nearest of some cells of a mesh to every cell, by great circle.
struct NearestCells {
  std::vector<std::int32_t> source;  ///< position in `sources`; -1 beyond the reach
  std::vector<float> angle;          ///< radians
};
NearestCells nearest_cells(const CubedSphere& mesh, std::span<const std::int32_t> sources,
                           double reach_rad = 4.0);

}  // namespace geo
