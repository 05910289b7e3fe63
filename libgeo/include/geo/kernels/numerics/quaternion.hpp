#pragma once

#include <array>
#include <cmath>

#include "geo/core/vector3.hpp"

namespace geo {

/// Rows of a rotation matrix.
using Matrix3 = std::array<Vector3, 3>;

[[nodiscard]] inline Vector3 times(const Matrix3& m, const Vector3& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}
/// The transpose times a vector: for a rotation, the way back.
[[nodiscard]] inline Vector3 back(const Matrix3& m, const Vector3& v) {
  return {m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2],
          m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
          m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2]};
}
/// transpose(a) times b: from the frame of b into that of a.
[[nodiscard]] inline Matrix3 back_times(const Matrix3& a, const Matrix3& b) {
  Matrix3 product;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      product[i][j] = a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j];
    }
  }
  return product;
}

/// frame m frame^T for a symmetric m: a tensor carried along by a rotation.
[[nodiscard]] inline Matrix3 carried(const Matrix3& frame, const Matrix3& m) {
  Matrix3 out;
  for (int c = 0; c < 3; ++c) {
    Vector3 axis{};
    axis[c] = 1.0;
    out[c] = times(frame, times(m, back(frame, axis)));
  }
  return out;
}

/// A rotation as a unit quaternion: scalar and vector part.
struct Quaternion {
  double w = 1.0;
  Vector3 v{};

  /// Rotation by the length of the vector, radians, about its direction.
  [[nodiscard]] static Quaternion about(const Vector3& rotation) {
    const double angle = length(rotation);
    if (angle == 0.0) return {};
    return {std::cos(0.5 * angle), scaled(rotation, std::sin(0.5 * angle) / angle)};
  }
  /// This rotation after `first`, normalised.
  [[nodiscard]] Quaternion after(const Quaternion& first) const {
    Quaternion q{w * first.w - dot(v, first.v),
                 add(add(scaled(first.v, w), v, first.w), cross(v, first.v))};
    const double size = std::sqrt(q.w * q.w + dot(q.v, q.v));
    q.w /= size;
    q.v = scaled(q.v, 1.0 / size);
    return q;
  }
  [[nodiscard]] Matrix3 matrix() const {
    const auto& [x, y, z] = v;
    return {{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
             {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
             {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}};
  }
};

}  // namespace geo
