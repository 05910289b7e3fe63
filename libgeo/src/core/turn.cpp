#include "geo/core/turn.hpp"

#include <cmath>
#include <numbers>

#include "geo/core/vector3.hpp"

namespace geo {
namespace {

/// A rotation as a unit quaternion.
struct Quaternion {
  double w;
  Vector3 v;

  Quaternion operator*(const Quaternion& o) const {
    return {w * o.w - dot(v, o.v), add(add(scaled(o.v, w), v, o.w), cross(v, o.v))};
  }
};

Quaternion about(const Vector3& axis, double angle_deg) {
  const double half = 0.5 * angle_deg * std::numbers::pi / 180.0;
  return {std::cos(half), scaled(axis, std::sin(half))};
}

}  // namespace

std::array<double, 3> turn_to_pole(const Centre& pole, double angle_deg) {
  constexpr Vector3 kY{0.0, 1.0, 0.0}, kZ{0.0, 0.0, 1.0};
  const Quaternion q = about(kZ, pole.longitude_deg) * about(kY, 90.0 - pole.latitude_deg) *
                       about(kZ, angle_deg - pole.longitude_deg);
  const double sine = length(q.v);
  if (sine < 1e-15) return {};
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  return scaled(q.v, sign * 2.0 * std::atan2(sine, sign * q.w) / sine);
}

}  // namespace geo
