#pragma once

#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_resume.hpp"

namespace geo::io {

/// Takes out of an open folder, and out of its manifest, what the run is about to replace: stages
/// that do not stay, islands of another planet, what was made from all together. An island that was
/// made by command and has the name of the run's own becomes a further one. Throws IoError.
void clear_for_run(const StageFolder& at, const RunPlan& plan, Manifest& manifest);

}  // namespace geo::io
