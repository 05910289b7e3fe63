#pragma once

#include <algorithm>
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

/// The place that a unit vector points at.
[[nodiscard]] inline Centre place_of(const Vector3& unit_vector) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return {kDegrees * std::asin(std::clamp(unit_vector[2], -1.0, 1.0)),
          kDegrees * std::atan2(unit_vector[1], unit_vector[0])};
}

}  // namespace geo
