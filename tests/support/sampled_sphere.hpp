#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "geo/kernels/plates/sphere/sphere_mesh.hpp"

namespace geo::test {

constexpr double kRadius_km = 6370.0;
constexpr double kKmPerDegree = kRadius_km * std::numbers::pi / 180.0;

/// A sphere of n samples and what joins them; stays where it is, as the mesh refers to the samples.
struct SampledSphere {
  explicit SampledSphere(std::int32_t n) : samples(n), mesh(samples) {}
  SampledSphere(const SampledSphere&) = delete;
  SampledSphere& operator=(const SampledSphere&) = delete;

  FibonacciSphere samples;
  SphereMesh mesh;
};

inline double longitude_deg(const Vector3& at) {
  return std::atan2(at[1], at[0]) * 180.0 / std::numbers::pi;
}
inline double latitude_deg(const Vector3& at) {
  return std::asin(at[2]) * 180.0 / std::numbers::pi;
}

}  // namespace geo::test
