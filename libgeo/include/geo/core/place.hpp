#pragma once

#include <cmath>
#include <numbers>

#include "geo/core/grid.hpp"
#include "geo/core/vector3.hpp"

namespace geo {

/// The unit vector from the planet's middle to a place: x towards 0 N 0 E, z towards the north
/// pole.
[[nodiscard]] inline Vector3 unit_vector_of(const Centre& place) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double latitude = place.latitude_deg * kRadians, longitude = place.longitude_deg * kRadians;
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
          std::sin(latitude)};
}

}  // namespace geo
