#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "geo/core/vector3.hpp"
#include "geo/kernels/plates/sphere/sphere_state.hpp"

namespace geo {

/// A change of which crust is whose, told by places, so that other samples can take part in it.
/// Plates are numbers in SphereState::plates at that time.
struct PlateChange {
  /// A plate breaks; a terrane of it comes to another plate, with what a collision does.
  enum class Kind : std::int8_t { split, collision } kind;
  int plate;
  /// The part of the plate that crust at a place (unit vector, in the frame of the plate) is in, by
  /// its type; for a collision 1 in the terrane, else 0.
  std::function<int(const Vector3& place, bool continental)> part_at;
  /// The plate that each part becomes, or -1: none. For a collision what part 1 becomes, or -1 when
  /// it keeps its number because its plate goes with it.
  std::vector<int> becomes;
  int upper = -1;            ///< plate with which a terrane has collided
  double speed_mm_yr = 0.0;  ///< at which they met
};

/// What other samples need to know of a step to repeat it.
struct PlateStep {
  std::vector<PlatePair> met;        ///< which plate stays up, as decided when they met
  std::vector<PlateChange> changes;  ///< in their order
  // After the changes, before the crust was resampled, if it was.
  std::vector<SpherePlate> plates;
  std::vector<PlatePair> pairs;
};

}  // namespace geo
