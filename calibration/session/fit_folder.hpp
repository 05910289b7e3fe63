#pragma once

#include "calibration/calibrate.hpp"
#include "calibration/checkpoint.hpp"
#include "calibration/target.hpp"
#include "geo/io/run/run_folder.hpp"

namespace geo::calibration {

/// What a fit starts from in its folder: an empty checkpoint or, with `resume`, the one that the
/// folder holds. One that had run out of iterations goes on if there are more now. Throws
/// ConfigurationError where the folder holds a run, or a fit that the request does not replace or
/// cannot go on with.
[[nodiscard]] Checkpoint begin_or_resume(const Request& request, const Target& target,
                                         const io::RunFolder& folder);

}  // namespace geo::calibration
