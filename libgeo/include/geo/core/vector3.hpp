#pragma once

#include <array>
#include <cmath>

namespace geo {

/// A position on the unit sphere, a direction, or an axis of rotation.
using Vector3 = std::array<double, 3>;

[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// a + scale * b
[[nodiscard]] inline Vector3 add(const Vector3& a, const Vector3& b, double scale = 1.0) {
  return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}
[[nodiscard]] inline Vector3 scaled(const Vector3& a, double scale) {
  return {scale * a[0], scale * a[1], scale * a[2]};
}
[[nodiscard]] inline double length(const Vector3& a) { return std::sqrt(dot(a, a)); }
/// The unit vector along `a`; `a` itself when it is zero.
[[nodiscard]] inline Vector3 normalised(const Vector3& a) {
  const double size = length(a);
  return size > 0.0 ? scaled(a, 1.0 / size) : a;
}
/// Angle between two unit vectors, exact also where it is small.
[[nodiscard]] inline double angle_between(const Vector3& a, const Vector3& b) {
  return 2.0 * std::asin(std::fmin(1.0, 0.5 * length(add(a, b, -1.0))));
}
/// `r` turned about `rotation` by its length, radians (Rodrigues' formula).
[[nodiscard]] inline Vector3 rotated(const Vector3& r, const Vector3& rotation) {
  const double angle = length(rotation);
  if (angle == 0.0) return r;
  const Vector3 axis = scaled(rotation, 1.0 / angle);
  const double c = std::cos(angle), s = std::sin(angle);
  const Vector3 turned = add(scaled(r, c), cross(axis, r), s);
  return add(turned, axis, dot(axis, r) * (1.0 - c));
}
/// The part of `a` in the tangent plane at the unit vector `at`.
[[nodiscard]] inline Vector3 tangent(const Vector3& a, const Vector3& at) {
  return add(a, at, -dot(a, at));
}

}  // namespace geo
