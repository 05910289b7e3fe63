#pragma once

#include "geo/core/vector3.hpp"

namespace geo {

/// East and north at a place, in the plane that touches the sphere there.
struct TangentFrame {
  Vector3 east, north;
};

/// At a unit vector, z to the north pole. At the poles, where every direction is south or north,
/// east is that of longitude 0.
[[nodiscard]] inline TangentFrame tangent_frame(const Vector3& unit) {
  const double across = std::hypot(unit[0], unit[1]);
  const Vector3 east =
      across > 0.0 ? Vector3{-unit[1] / across, unit[0] / across, 0.0} : Vector3{0.0, 1.0, 0.0};
  return {east, cross(unit, east)};
}

}  // namespace geo
