#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/plates/sphere/sphere_mesh.hpp"

namespace geo {

/// A sample that touches another plate.
struct SphereBoundary {
  std::int32_t sample;
  std::int16_t plate, other;
  Vector3 towards;  ///< tangent to the sphere, normal to the boundary, to the other plate
  RelativeMotion motion;
  BoundaryType type;
  double strength;  ///< dominant component over the largest on the planet, 0 to 1
};

/// All boundary samples, by sample, for plates that fill the lattice. Directions are taken over
/// about `smoothing_km` along the boundary of each pair of plates; types as `classify` has them.
std::vector<SphereBoundary> find_sphere_boundaries(const SphereMesh& mesh,
                                                   std::span<const std::int16_t> plate,
                                                   std::span<const Vector3> rotation_rad_myr,
                                                   double plate_speed_cm_yr, double smoothing_km,
                                                   double radius_km);

/// Of each sample the number of the nearest of some samples within a reach, or -1 (great circles,
/// handed from sample to sample).
std::vector<std::int32_t> nearest_samples(const SphereMesh& mesh,
                                          std::span<const std::int32_t> sources, double reach_rad);

}  // namespace geo
