#include "geo/kernels/remapping/cubed_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

// The cube stands askew, so that none of its edges lies along the equator, a meridian or a pole.
const Vector3 kAskew = scaled(normalised({0.31, 0.74, 0.59}), 0.83);

/// Solid angle between the middle of a face and the point (x, y) of the plane at distance 1.
double corner_solid_angle(double x, double y) {
  return std::atan2(x * y, std::sqrt(1.0 + x * x + y * y));
}

}  // namespace

CubedSphere::CubedSphere(int cells_per_edge)
    : n_(cells_per_edge), spacing_(std::sqrt(4.0 * kPi / size())) {
  position_.resize(size());
  neighbours_.resize(size());
  area_sr_.resize(static_cast<std::size_t>(n_) * n_);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < n_; ++j) {
    const double y0 = std::tan(angle(j)), y1 = std::tan(angle(j + 1));
    for (int i = 0; i < n_; ++i) {
      const double x0 = std::tan(angle(i)), x1 = std::tan(angle(i + 1));
      area_sr_[j * n_ + i] = corner_solid_angle(x1, y1) - corner_solid_angle(x0, y1) -
                             corner_solid_angle(x1, y0) + corner_solid_angle(x0, y0);
      for (int face = 0; face < 6; ++face) {
        position_[(face * n_ + j) * n_ + i] = on_face(face, angle(i + 0.5), angle(j + 0.5));
      }
    }
  }
  constexpr std::array<int, kNeighbours> kAlong{0, 1, 1, 1, 0, -1, -1, -1};
  constexpr std::array<int, kNeighbours> kAcross{1, 1, 0, -1, -1, -1, 0, 1};
#pragma omp parallel for schedule(static)
  for (std::int32_t cell = 0; cell < size(); ++cell) {
    const int face = cell / (n_ * n_), j = cell / n_ % n_, i = cell % n_;
    const bool inside = i > 0 && i < n_ - 1 && j > 0 && j < n_ - 1;
    for (int k = 0; k < kNeighbours; ++k) {
      if (inside) {
        neighbours_[cell][k] = cell + kAcross[k] * n_ + kAlong[k];
        continue;
      }
      neighbours_[cell][k] =
          locate(on_face(face, angle(i + kAlong[k] + 0.5), angle(j + kAcross[k] + 0.5)));
    }
  }
}

double CubedSphere::angle(double index) const { return -0.25 * kPi + 0.5 * kPi / n_ * index; }

std::array<CubedSphere::Side, CubedSphere::kSides> CubedSphere::sides(std::int32_t cell) const {
  const int face = cell / (n_ * n_), j = cell / n_ % n_, i = cell % n_;
  constexpr std::array<int, kSides> kAlong{0, 1, 1, 0}, kAcross{0, 0, 1, 1};
  constexpr std::array<double, kSides> kOutX{0.5, 1.01, 0.5, -0.01}, kOutY{-0.01, 0.5, 1.01, 0.5};
  const bool mirrored = face % 2 == 1;  // seen from outside, the far faces run the other way
  std::array<Side, kSides> all;
  for (int k = 0; k < kSides; ++k) {
    const int next = (k + 1) % kSides;
    Side& side = all[mirrored ? kSides - 1 - k : k];
    side.beyond = locate(on_face(face, angle(i + kOutX[k]), angle(j + kOutY[k])));
    side.from = on_face(face, angle(i + kAlong[k]), angle(j + kAcross[k]));
    side.to = on_face(face, angle(i + kAlong[next]), angle(j + kAcross[next]));
    if (mirrored) std::swap(side.from, side.to);
  }
  return all;
}

Vector3 CubedSphere::on_face(int face, double u, double v) const {
  const double x = std::tan(u), y = std::tan(v);
  Vector3 p{};
  p[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
  p[(face / 2 + 1) % 3] = x;
  p[(face / 2 + 2) % 3] = y;
  return rotated(normalised(p), kAskew);
}

std::int32_t CubedSphere::locate(const Vector3& unit) const {
  static const Vector3 kBack = scaled(kAskew, -1.0);
  static const std::array<Vector3, 3> kColumns{rotated({1, 0, 0}, kBack), rotated({0, 1, 0}, kBack),
                                               rotated({0, 0, 1}, kBack)};
  Vector3 p{};
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 3; ++c) p[c] += kColumns[k][c] * unit[k];
  }
  int axis = 0;
  for (int c = 1; c < 3; ++c) {
    if (std::abs(p[c]) > std::abs(p[axis])) axis = c;
  }
  const int face = 2 * axis + (p[axis] > 0.0 ? 0 : 1);
  const double scale = 1.0 / std::abs(p[axis]);
  const auto index = [&](double tangent) {
    const double along = (std::atan(tangent * scale) + 0.25 * kPi) / (0.5 * kPi) * n_;
    return std::clamp(static_cast<int>(along), 0, n_ - 1);
  };
  return (face * n_ + index(p[(axis + 2) % 3])) * n_ + index(p[(axis + 1) % 3]);
}

}  // namespace geo
