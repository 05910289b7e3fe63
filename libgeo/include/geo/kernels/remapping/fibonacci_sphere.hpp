#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/vector3.hpp"

namespace geo {

/// The Fibonacci lattice: n points spread nearly evenly over the sphere along a spiral,
///   longitude_i = 2 pi frac(i / golden), z_i = 1 - (2 i + 1) / n,  i = 0 .. n - 1.
/// Each point stands for the same area, 4 pi / n. Index 0 is next to the north pole.
///
/// The nearest point of any place is found in constant time from the lattice's own geometry: about
/// a latitude the points form a grid whose two basis vectors are steps of consecutive Fibonacci
/// numbers (Keinert et al. 2015). Here the corners of the grid cell around a
/// place only start a descent over the steps that are short at that latitude, so that the answer is
/// exact at the poles as well and does not hang on round-off of the inverse.
class FibonacciSphere {
 public:
  /// Throws ConfigurationError unless 32 <= samples <= 16 000 000.
  explicit FibonacciSphere(std::int32_t samples);

  [[nodiscard]] std::int32_t size() const noexcept {
    return static_cast<std::int32_t>(position_.size());
  }
  [[nodiscard]] const Vector3& position(std::int32_t sample) const { return position_[sample]; }
  [[nodiscard]] std::span<const Vector3> positions() const noexcept { return position_; }
  /// Solid angle that a sample stands for, sr.
  [[nodiscard]] double area_sr() const noexcept { return area_sr_; }
  /// Mean distance between adjacent samples, radians: that of a hexagonal grid.
  [[nodiscard]] double spacing() const noexcept { return spacing_; }
  /// The nearest sample to a unit vector; of two equally near ones that of the lower index.
  [[nodiscard]] std::int32_t nearest(const Vector3& unit) const;
  /// Differences of indices that lead to the neighbours of a sample, without sign: the Fibonacci
  /// numbers whose step is short at its latitude. Near the poles, where they do not suffice, empty.
  [[nodiscard]] std::span<const std::int32_t> steps(std::int32_t sample) const;

  /// So many samples at either pole count as near it.
  static constexpr std::int32_t kPolar = 96;

 private:
  /// Lattice about one latitude: steps to the neighbours and the inverse of its basis.
  struct Zone {
    std::int32_t first, second;  // consecutive Fibonacci numbers
    double longitude_1, z_1;     // of the step `first`
    double longitude_2, z_2;     // of the step `second`
    double least_s2;             // 1 - z^2 from which on it holds
    std::array<std::int32_t, 5> steps;
  };
  [[nodiscard]] int zone(double z) const;
  [[nodiscard]] std::int32_t nearest_by_descent(const Vector3& unit, std::int32_t start) const;
  [[nodiscard]] std::int32_t nearest_polar(const Vector3& unit) const;

  double area_sr_, spacing_, inner2_;
  std::vector<Vector3> position_;
  std::vector<Zone> zones_;
  double cap_z_;  // |z| from which the nearest sample is among the polar ones
};

}  // namespace geo
