#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/vector3.hpp"

namespace geo {

/// How a sphere is cut by great circles.
struct CircleCuts {
  std::int64_t circles = 1000;
  double steepness = 300.0;  ///< k, per radian of distance from a circle
  double offset = 0.0;       ///< most that a circle's plane lies off the centre, in radii
};

/// Great-circle noise (Elias; Bourke) with smooth steps (tectonics.js): on one side of
/// each of n random circles the ground rises,
///   h(x) = 2 / sqrt(n) * ( sum_i H(a_i . x + b_i) - n / 2 ),  H(t) = 1 / (1 + exp(-2 k t)),
/// with a_i uniform on the sphere and b_i uniform within the offset. Zero mean and unit deviation
/// over all noises. For many circles a Brownian surface (Mandelbrot 1975): heights at a distance d
/// much longer than 1/k differ by a deviation that grows with sqrt(d). Without an offset heights
/// at antipodes are each other's negative.
///
/// H is summed in whole units of 2^-22: a place has the same value in whatever company it is read.
/// Circles that pass a block of places by, farther than H can tell from a step, cost one product
/// for all of them together, so that a whole grid costs cells * n * (1/k + size of a block).
class GreatCircles {
 public:
  /// Throws ConfigurationError for less than one circle or a steepness that is not positive.
  GreatCircles(const CircleCuts& cuts, std::uint64_t seed, std::string_view stream);

  /// Values at unit vectors, fast where these lie near each other. `values` has one for each.
  void read(std::span<const Vector3> places, std::span<float> values) const;

 private:
  struct Circle {
    Vector3 axis;
    double offset;
  };
  struct Scaled {
    float x, y, z, shift;  // of the power of two in H
  };
  std::vector<Circle> circles_;
  std::vector<Scaled> scaled_;
  double width_;  // distance from a circle beyond which H is a step
};

/// The noise in every cell of a sphere, one float each, on all threads.
void great_circle_noise(const Grid& grid, const GreatCircles& circles, std::span<float> values);
/// The same at many places, in any order.
[[nodiscard]] std::vector<float> great_circle_noise_at(const GreatCircles& circles,
                                                       std::span<const Vector3> places);

}  // namespace geo
