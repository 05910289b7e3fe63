#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_resume.hpp"

namespace geo::io {

/// One background job: the files of a stage, then its entry in the manifest.
struct StageJob {
  Snapshot snapshot;
  Provenance provenance;
  std::filesystem::path netcdf, vti, csv;
  StepTable steps;
  std::vector<TextTable> tables;
  StageRecord record;

  /// Fields leave the snapshot as soon as they are in all files.
  void write(const RunSettings& settings);

 private:
  void write_table(const std::filesystem::path& path, const std::string& text);
};

/// What stands in the files of a stage about where they come from.
Provenance provenance_of(const RunConfiguration& run, int position, const std::string& config);

/// The files of a stage that has just finished.
StageJob job_of(const StageFolder& at, int position, const std::string& config, const State& state,
                const Context& context, double seconds);

}  // namespace geo::io
