#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// Trenches and forebulges where floor subducts, as the relief of a frame shows them. The samples
/// of a drift are farther apart than a trench is wide: a profile (`bent_plate`) is laid along the
/// boundary instead, as deep as the age of the floor and the rate of subduction there have it
/// (`trench_share`).
class SphereTrenches {
 public:
  /// `overrides` tells of each boundary whether its own plate stays up; `slab_m` is the depth below
  /// the floor where floor of 100 Myr subducts at 100 mm/yr. With 0 there are none.
  SphereTrenches(const SphereTectonics& model, std::span<const SphereBoundary> boundaries,
                 std::span<const std::uint8_t> overrides, double slab_m, double radius_km);

  /// Mean over a cell so wide, m, negative down; 0 far from any trench.
  [[nodiscard]] double elevation_m(const SphereMesh::Place& place, double cell_km) const;

 private:
  std::vector<float> across_km_;  // of each sample near a trench, positive on the overriding plate
  std::vector<float> depth_m_;    // of the nearest trench to each sample, 0 far from any
};

}  // namespace geo
