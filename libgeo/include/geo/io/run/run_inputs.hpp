#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geo/core/initial_conditions.hpp"
#include "geo/io/run/run_plan.hpp"

namespace geo::io {

/// What a run begins with besides its settings, read and checked before a cell is computed.
struct RunInputs {
  std::optional<State> state;
  std::vector<PlateOutline> plates;
  std::shared_ptr<const PlateReconstruction> reconstruction;
  std::shared_ptr<const GivenElevation> initial_elevation;
  std::shared_ptr<const ExemplarLibrary> exemplars, planet_exemplars;
  std::vector<std::string> warnings;  ///< of what was given
};

/// Reads all that the plan's stages begin with: the DEM or the bare planet (or `loaded`, what
/// earlier stages left), given fields, initial conditions, given exemplars. Settles run.grid and
/// dem.variable in the settings, and leaves the island out of the plan where there is no place for
/// one. `on_grid` is told the grid before its values are read, so that a run too large ends early.
/// Throws ConfigurationError, InputError, IoError.
RunInputs read_inputs(const RunConfiguration& run, RunPlan& plan, std::optional<State> loaded,
                      const std::function<void(const Grid&)>& on_grid);

/// Grows the exemplars that stages ahead are to be made like, as far as none were given.
void find_exemplars(RunInputs& inputs, const RunConfiguration& run, const RunPlan& plan);

/// What the pipeline gets of it. Who listens is left to the caller.
Context context_of(const RunInputs& inputs, const RunConfiguration& run, const RunPlan& plan);

}  // namespace geo::io
