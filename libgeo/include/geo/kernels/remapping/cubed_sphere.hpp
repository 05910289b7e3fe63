#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/vector3.hpp"

namespace geo {

/// A mesh of 6 n² nearly equal cells over the sphere: the equiangular cubed sphere (Ronchi et al.
/// 1996). It has no poles and does not depend on the grid of a run, so what grows on it is the same
/// planet at any resolution and anywhere on the globe. Its six faces stand askew to the axis.
///
/// The largest cell is 1.4 times the smallest. Finding the cell of a position takes constant time.
class CubedSphere {
 public:
  static constexpr int kNeighbours = 8;

  explicit CubedSphere(int cells_per_edge);

  [[nodiscard]] int cells_per_edge() const noexcept { return n_; }
  [[nodiscard]] std::int32_t size() const noexcept { return 6 * n_ * n_; }
  /// Centre of a cell, a unit vector.
  [[nodiscard]] const Vector3& position(std::int32_t cell) const { return position_[cell]; }
  [[nodiscard]] std::span<const Vector3> positions() const { return position_; }
  /// Solid angle of a cell, sr; all add up to 4 pi.
  [[nodiscard]] double area_sr(std::int32_t cell) const { return area_sr_[cell % (n_ * n_)]; }
  /// The cell that holds a position.
  [[nodiscard]] std::int32_t locate(const Vector3& unit) const;
  /// The eight cells around; at the corners of the cube, where three faces meet, one is repeated.
  [[nodiscard]] const std::array<std::int32_t, kNeighbours>& neighbours(std::int32_t cell) const {
    return neighbours_[cell];
  }
  /// A side of a cell: an arc of a great circle, with the cell to the left of its way.
  struct Side {
    std::int32_t beyond;  ///< the cell on its right
    Vector3 from, to;     ///< the corners it runs between, unit vectors
  };
  static constexpr int kSides = 4;
  /// The sides of a cell, counter-clockwise seen from outside. They close, and the cell beyond a
  /// side has the same one, run the other way (up to round-off along the edges of the cube).
  [[nodiscard]] std::array<Side, kSides> sides(std::int32_t cell) const;
  /// Mean distance between centres of adjacent cells, radians.
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

 private:
  [[nodiscard]] Vector3 on_face(int face, double u, double v) const;
  /// Angle from the middle of a face to `index` cells from its edge.
  [[nodiscard]] double angle(double index) const;

  int n_;
  double spacing_;
  std::vector<Vector3> position_;
  std::vector<double> area_sr_;  // of one face
  std::vector<std::array<std::int32_t, kNeighbours>> neighbours_;
};

}  // namespace geo
