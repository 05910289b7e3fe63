#pragma once

#include <optional>
#include <span>
#include <string>

#include "geo/core/state.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_folder.hpp"
#include "geo/io/run/run_plan.hpp"
#include "geo/io/run/run_request.hpp"

namespace geo::io {

// What a folder holds of an earlier run, and how this one goes on from there. Nothing is written.

/// Where the stages of a run lie: `numbers` are their places in the full order, by which files are
/// named.
struct StageFolder {
  const RunFolder& folder;
  const RunConfiguration& run;
  std::span<const int> numbers;

  /// "03-erosion.nc" of the stage at a position; `extension` with its dot.
  [[nodiscard]] std::filesystem::path file_of(int position, std::string_view extension) const {
    return folder.stage_file(numbers[position], run.name_of(position), extension);
  }
};

/// Every parameter of a run as it is used, as the file of its configuration.
std::string resolved_config(const RunConfiguration& run);

/// Settles where a run begins in its folder: anew; with --resume behind the complete stages, with
/// the settings that were left open as they were; with --from and --overwrite behind earlier stages
/// that stay. Changes the plan's begin, first and last, and the settings of grid, DEM, from and
/// to. Returns what the manifest tells of the stages that stay. Throws ConfigurationError where the
/// configuration does not fit what is there, InputError where somebody has changed it.
Manifest settle_in_folder(const StageFolder& at, const RunRequest& request, RunPlan& plan);

/// Fields of the complete stages before `plan.first` that stages ahead still read; none without
/// such stages. Throws InputError, IoError.
std::optional<State> read_complete_stages(const StageFolder& at, const RunPlan& plan);

}  // namespace geo::io
