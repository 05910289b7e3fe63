#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/configuration.hpp"

namespace terrane {

/// One run of a sweep: what it is called and what differs from the others.
struct SweepRun {
  std::string name;
  std::vector<std::pair<std::string, std::string>> values;  ///< parameter and text
};

/// What is swept and how.
struct SweepRequest {
  ConfigurationSources sources;  ///< what all runs share
  std::vector<SweepRun> runs;
  std::filesystem::path folder;
  std::string to;
  int jobs = 1;              ///< runs at the same time
  int threads = 1;           ///< of each
  bool all_files = false;    ///< with ParaView files, maps and report
  bool scores_only = false;  ///< the files of a run go when it is scored
  bool overwrite = false;
  bool json_progress = false;
  bool quiet = false;
};

/// The runs that a table asks for (a column for each parameter, a row for each run; column `run`
/// gives names), each with every seed where there are any. Either may be missing. Throws
/// ConfigurationError, InputError that name the row.
std::vector<SweepRun> runs_of(const std::filesystem::path& table, const std::string& seeds);

/// Refuses a run whose values no run could have, before the first begins.
void check_runs(const SweepRequest& request);

/// Runs them all, each in a process and a folder of its own, scores them, and keeps the table
/// FOLDER/sweep.csv up to date. Runs that are done are not done again. One that fails does not stop
/// the others; the error of the first is thrown in the end. Throws Interrupted on a signal.
void sweep(const SweepRequest& request);

}  // namespace terrane
