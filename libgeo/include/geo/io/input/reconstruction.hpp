#pragma once

#include <string>
#include <vector>

#include "geo/kernels/plates/plate_reconstruction.hpp"

namespace geo::io {

/// The plates with which a drift begins, and what drives them.
struct GivenReconstruction {
  std::vector<PlateOutline> plates;  ///< where their crust is today
  PlateReconstruction motion;
};

/// A reconstruction of GPlates: static polygons (read_dated_outlines) and rotations
/// (read_rotations).
///
/// The drift begins at `start_ma`, or, where that is 0, `drift_myr` before the youngest rotation.
/// Its first plates are those with polygons that are valid then, by their numbers in the order in
/// which these come in the file; polygons of other plates that begin before its end are plates that
/// appear then.
///
/// Throws InputError, in one line that names the file and the feature or the line: whatever the two
/// readers refuse; rotations that do not reach over the whole drift; fewer than 2 or more than 1000
/// plates; polygons of a plate without rotations at the time of the first of them. Plates without
/// polygons serve as links of the circuit. IoError when a file cannot be read.
[[nodiscard]] GivenReconstruction read_reconstruction(const std::string& polygons,
                                                      const std::string& rotations, double start_ma,
                                                      double drift_myr);

}  // namespace geo::io
