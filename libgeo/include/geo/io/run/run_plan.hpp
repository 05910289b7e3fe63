#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/pipeline.hpp"
#include "geo/core/planet.hpp"
#include "geo/io/config/run_settings.hpp"

namespace geo::io {

/// All that a run is configured by. Must outlive what is made of it.
struct RunConfiguration {
  const Pipeline& pipeline;
  RunSettings& settings;  ///< run.grid, run.from and run.to are resolved in it
  const Planet& planet;
  std::span<const Parameter> parameters;  ///< bound to settings, planet and stages

  [[nodiscard]] Stage& stage(int position) const { return *pipeline.stages()[position]; }
  [[nodiscard]] std::string_view name_of(int position) const {
    return pipeline.stages()[position]->info().name;
  }
};

/// Which stages a run has, by their positions in the pipeline: `begin` to `last` make the run,
/// those from `first` on are still to be computed.
struct RunPlan {
  int begin = 0, first = 0, last = 0;
  std::string note;  ///< why a stage of the pipeline is left out; empty when none is
};

/// Position of a stage. ConfigurationError that begins with `asked_by` and names what is near.
int position_of(const Pipeline& pipeline, const std::string& stage, std::string_view asked_by);

/// From `from` (as configured where it is empty; a real DEM takes the place of the stages that
/// would make one) to `to` (likewise). Throws ConfigurationError.
RunPlan plan_run(const RunConfiguration& run, const std::string& from, const std::string& to);

/// The stage that a run from a DEM begins with.
int first_stage_of_input(const RunConfiguration& run);

/// A part of a planet has no island of its own: the plan ends before it. Throws ConfigurationError
/// when the island is what was asked for.
void leave_out_island(RunPlan& plan, const RunConfiguration& run, const Grid& grid);

/// Whether a stage still to be computed reads the field.
bool is_still_read(const Pipeline& pipeline, const RunPlan& plan, const FieldSpec& spec);
/// Whether one of them reads an elevation that none before it writes.
bool needs_elevation(const Pipeline& pipeline, const RunPlan& plan);
/// Whether the run as a whole has the stages in which its events change something.
bool events_are_felt(const RunConfiguration& run, const RunPlan& plan);
/// Whether a stage of the run as a whole takes its heights from the hypsography.
bool follows_hypsography(const RunConfiguration& run, const RunPlan& plan);
/// The keys of [fields] by which the stage at a position reads something.
std::vector<std::string> given_fields_of(const RunConfiguration& run, int position);

}  // namespace geo::io
