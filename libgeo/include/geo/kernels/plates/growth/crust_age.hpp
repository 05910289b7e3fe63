#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// Time since each cell of a mesh left the ridge that made it, Myr: over the ridge points of its
/// own plate the least of distance / (half the spreading rate), lengthened up to two and a half
/// times where the way turns aside from the direction of spreading, so that floor belongs to the
/// stretch of ridge it came from. Beyond about `oldest_myr` the age is drawn in smoothly, oldest
/// tanh(a / oldest), since floor of that age has been subducted; plates without a ridge are
/// `oldest_myr` old. Distances are chords of the unit sphere. Throws Bug unless `plate` has one
/// value per cell of the mesh.
std::vector<float> ocean_age_myr(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                                 std::span<const BoundaryPoint> boundaries,
                                 std::span<const Vector3> rotation_rad_myr, double oldest_myr,
                                 double radius_km);

}  // namespace geo
