#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/run_events.hpp"
#include "geo/io/run/run_plan.hpp"

namespace geo::io {

/// What a stage of a run in memory made.
struct StageInMemory {
  Snapshot snapshot;
  double seconds = 0.0;
  Budget budget;
  StepTable steps;
  std::vector<TextTable> tables;
  std::vector<EventRecord> events;
  std::vector<std::string> warnings;
};

/// Runs the pipeline from stage `from` to `to` (as configured where empty) and keeps what each
/// stage writes; no file is written. `initial` holds fields to begin with, such as an elevation in
/// place of that of `dem.file`; like that one they are laid out with `run.turn`. The same bits as
/// in the files of a `RunSession`. Throws ConfigurationError, InputError, IoError, and Interrupted
/// when `events.stop` was set.
std::vector<StageInMemory> run_in_memory(const RunConfiguration& run, const std::string& from,
                                         const std::string& to, const RunEvents& events,
                                         std::optional<State> initial = {});

/// One more island, as the configuration says, from what the stages of a planet made. Throws
/// ConfigurationError when they lack a field that an island is made from.
StageInMemory island_in_memory(const RunConfiguration& run, const std::vector<Snapshot>& planet,
                               const RunEvents& events);

}  // namespace geo::io
