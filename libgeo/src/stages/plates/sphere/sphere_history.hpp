#pragma once

#include <vector>

#include "geo/core/stage.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// What is told of plates by their numbers: how each has turned, whose it was and what has become
/// of it.
class SphereHistory {
 public:
  explicit SphereHistory(const Grid& grid) : grid_(&grid) {}

  /// How plates turn in the step that is about to be made.
  void enter(const SphereTectonics& model);

  /// `rotations`: the Euler pole and the rate of each plate in each step of its life, in the frame
  /// of latitude and longitude.
  [[nodiscard]] TextTable rotations(const SphereState& end) const;
  /// `lives`: a row for each plate there has been.
  [[nodiscard]] static TextTable lives(const SphereState& end);

 private:
  struct Turn {
    std::int16_t plate;
    double from_myr, to_myr;
    Vector3 rotation_rad_myr;
  };
  const Grid* grid_;
  std::vector<Turn> turns_;
};

}  // namespace geo
