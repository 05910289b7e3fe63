#pragma once

#include <string>
#include <vector>

#include "geo/core/initial_conditions.hpp"
#include "geo/kernels/plates/rotation_model.hpp"

namespace geo {

/// A plate that is cut out of others after the drift has begun.
struct LaterPlate {
  int number = 0;        ///< in the rotations
  double from_ma = 0.0;  ///< when it appears
  PlateOutline outline;  ///< of its crust where that is today; its pole and rate do not count
};

/// What a reconstruction tells of the plates of a drift (Cox & Hart 1986, chapter 7): where their
/// crust was, and how it has moved.
///
/// The drift begins with the plates of Context::plates, whose outlines are where their crust is
/// today, as static polygons of GPlates are: at the beginning they lie at the place that
/// `rotations` tell. After t Myr its age is start_ma - t.
struct PlateReconstruction {
  std::string source;  ///< of the rotations, for messages
  RotationModel rotations;
  double start_ma = 0.0;          ///< at the beginning of the drift
  double youngest_ma = 0.0;       ///< of all rotations
  std::vector<int> first;         ///< numbers in the rotations of the plates of Context::plates
  std::vector<LaterPlate> later;  ///< oldest first
};

}  // namespace geo
