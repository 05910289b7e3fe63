#pragma once

#include <cstdint>
#include <vector>

#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// Moves the plates of a mesh rigidly for `time_myr` (Tectonica blueprint, section 2.3). A place
/// belongs to the plate that arrives there; where several arrive, to the more buoyant one; where
/// none does, new crust joins the plate that was there. A majority filter over the eight
/// neighbours follows.
void move_plates(const CubedSphere& mesh, const std::vector<Plate>& plates, double time_myr,
                 std::vector<std::int16_t>& plate);

}  // namespace geo
