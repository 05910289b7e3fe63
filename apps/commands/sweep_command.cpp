#include <fmt/core.h>
#include <omp.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <memory>
#include <string>

#include "apps/log.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "sweep.hpp"

namespace terrane {
namespace {

struct SweepOptions {
  SweepRequest request;
  std::string table, seeds, jobs;
};

int jobs_of(const std::string& text) {
  constexpr int kMost = 1024;
  int jobs = 1;
  if (text.empty()) return jobs;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), jobs);
  if (error != std::errc() || stop != text.data() + text.size() || jobs < 1 || jobs > kMost) {
    throw geo::ConfigurationError(
        fmt::format("-j {}: must be a whole number from 1 to {}", text, kMost));
  }
  return jobs;
}

void run(const SweepOptions& options) {
  SweepRequest request = options.request;
  set_log_style({.json = request.json_progress, .quiet = request.quiet});
  if (options.table.empty() && options.seeds.empty()) {
    throw geo::ConfigurationError(
        "sweep: what is to be swept? Give a table of parameters, --seeds FIRST..LAST, or both");
  }
  request.runs = runs_of(options.table, options.seeds);
  request.jobs = jobs_of(options.jobs);
  request.threads = std::max(1, use_threads() / request.jobs);
  check_runs(request);
  try {
    sweep(request);
  } catch (const geo::Interrupted&) {
    throw geo::Error(geo::ErrorKind::interrupted,
                     "interrupted; the same command goes on with the runs that are left");
  }
}

}  // namespace

void add_sweep_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "sweep",
      "Runs many planets, of many seeds or a table of parameters, and tabulates their scores");
  const auto options = std::make_shared<SweepOptions>();
  SweepRequest& r = options->request;
  r.folder = "sweep";
  command->add_option(
      "TABLE", options->table,
      "Comma-separated values: a column for each parameter (section.key), a row for "
      "each run; a column named run gives names");
  command
      ->add_option("--seeds", options->seeds,
                   "Seeds of the runs; with a table every row has every seed")
      ->type_name("FIRST..LAST");
  command->add_option("-o", r.folder, "Folder for the runs and sweep.csv (default: sweep)")
      ->type_name("DIR");
  command->add_option("-j", options->jobs, "Runs at the same time (default: 1)")->type_name("N");
  command->add_option("--preset", r.sources.preset, "Start from a built-in configuration")
      ->type_name("NAME");
  command->add_option("--config", r.sources.config, "Configuration file (TOML) of all runs")
      ->type_name("FILE");
  command
      ->add_option("--set", r.sources.assignments, "Set one parameter of all runs; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--grid", r.sources.grid, "Cells of the grid")->type_name("WIDTHxHEIGHT");
  command->add_option("--dem", r.sources.dem, "A DEM takes the place of plates and isostasy")
      ->type_name("FILE[:VARIABLE]");
  command->add_option("--to", r.to, "Last stage")->type_name("STAGE");
  command->add_flag("--all-files", r.all_files, "Write files for ParaView, maps and reports too");
  command->add_flag("--scores-only", r.scores_only,
                    "Remove the files of each run when it has been scored");
  command->add_flag("--overwrite", r.overwrite, "Do all runs again");
  command->add_flag("--quiet", r.quiet, "Say nothing but warnings and errors");
  command->add_flag("--json-progress", r.json_progress,
                    "For programs that watch: one JSON object on stderr when a run begins or ends");
  command->callback([&action, options] { action = [options] { run(*options); }; });
}

}  // namespace terrane
