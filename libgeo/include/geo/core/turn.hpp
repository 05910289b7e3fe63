#pragma once

#include <array>

#include "geo/core/grid.hpp"

namespace geo {

/// The turn of `Grid::sphere` that lays a planet out with another pole: its place `pole` comes to
/// the north pole, by a tilt along that place's meridian, and the meridian `angle_deg` east of what
/// the tilt leaves at longitude 0 becomes the prime one. (90, any, 0) turns nothing.
[[nodiscard]] std::array<double, 3> turn_to_pole(const Centre& pole, double angle_deg);

}  // namespace geo
