#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/configuration.hpp"
#include "apps/log.hpp"
#include "apps/memory_option.hpp"
#include "apps/signals.hpp"
#include "apps/thread_count.hpp"
#include "calibration/calibrate.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/presets.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  std::string config, preset, target, folder = "calibration", threads;
  std::vector<std::string> assignments;
  MemoryOption memory;
  bool resume = false, overwrite = false, allow_other_build = false, quiet = false,
       log_json = false;
};

/// Defaults, then preset, then file, then the command line. Returns what it is called.
std::string configure(Configuration& configuration, const CalibrateOptions& options) {
  const auto& parameters = configuration.all_parameters();
  std::string name = "defaults";
  if (!options.preset.empty()) {
    geo::io::apply_toml(geo::io::find_preset(options.preset).toml, "preset " + options.preset,
                        parameters, &configuration.settings.events);
    name = "preset " + options.preset;
  }
  if (!options.config.empty()) {
    geo::io::apply_config_file(options.config, parameters, &configuration.settings.events);
    name = fs::path(options.config).filename().string();
  }
  for (const std::string& assignment : options.assignments) {
    geo::io::apply_assignment(assignment, parameters);
  }
  return name;
}

/// One line for each iteration, and how long the others may take.
class Log {
 public:
  explicit Log(const geo::calibration::Settings& settings) : settings_(settings) {}
  void operator()(const geo::calibration::Iteration& iteration) {
    seconds_ += iteration.seconds;
    ++count_;
    const double left =
        seconds_ / count_ *
        static_cast<double>(settings_.iterations - iteration.number +
                            (settings_.starts - 1 - iteration.start) * settings_.iterations);
    log_info(fmt::format(
        "start {} iteration {}: cost {:.6g}, distance {:.1f} m, step {:.2g}{}; at "
        "most {} more",
        iteration.start + 1, iteration.number, iteration.cost, iteration.wasserstein_m,
        iteration.step, iteration.accepted ? "" : " (no better place found)", shown_seconds(left)));
  }

 private:
  const geo::calibration::Settings& settings_;
  double seconds_ = 0.0;
  int count_ = 0;
};

void print_result(const geo::calibration::Result& result) {
  for (const auto& parameter : result.parameters) {
    fmt::print("{} = {:.6g} +- {:.2g} {} (began at {:.6g})\n", parameter.name, parameter.fitted,
               parameter.standard_error, parameter.units, parameter.start);
  }
  const auto line = [](const char* what, const std::vector<geo::calibration::SeedMisfit>& seeds) {
    if (seeds.empty()) return;
    fmt::print("distance, {}: {:.1f} m before, {:.1f} m after\n", what, mean_before_m(seeds),
               mean_after_m(seeds));
  };
  line("fitted planets", result.fitted);
  line("held-out planets", result.held_out);
  line("fitted planets on the held-out grid", result.held_out_resolution);
}

void run(const CalibrateOptions& options) {
  set_log_style({.json = options.log_json, .quiet = options.quiet});
  if (options.target.empty()) {
    throw geo::ConfigurationError(
        "--target is missing: must be earth, earth-statistical, a CSV file or a NetCDF DEM");
  }
  use_threads(options.threads);
  const auto cap = options.memory.cap(options.folder);
  Configuration configuration;
  const std::string name = configure(configuration, options);
  Log log(configuration.calibration);
  geo::calibration::Result result;
  try {
    result = geo::calibration::calibrate({.target = options.target,
                                          .preset_or_config = name,
                                          .folder = options.folder,
                                          .configuration = configuration.parameters(),
                                          .events = configuration.settings.events,
                                          .settings = configuration.calibration,
                                          .resume = options.resume,
                                          .overwrite = options.overwrite,
                                          .allow_other_build = options.allow_other_build},
                                         {.info = [](std::string_view text) { log_info(text); },
                                          .iteration = [&](const auto& step) { log(step); },
                                          .stop = &stop_requested()});
  } catch (const geo::Interrupted&) {
    throw geo::Error(
        geo::ErrorKind::interrupted,
        fmt::format("interrupted; terrane calibrate --resume -o {} with the same configuration and "
                    "target goes on after the last complete iteration",
                    options.folder));
  }
  print_result(result);
  const std::string failure = failure_of(result);
  for (const std::string& warning : result.warnings) {
    if (warning != failure) log_warning(warning);
  }
  log_info(fmt::format("the files are in {}", options.folder));
  if (!failure.empty()) {
    throw geo::Error(geo::ErrorKind::unreached,
                     fmt::format("{}; the best found is in {}", failure, options.folder));
  }
}

}  // namespace

void add_calibrate_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "calibrate", "Fits parameters so that planets have the hypsometry of a target");
  const auto options = std::make_shared<CalibrateOptions>();
  CalibrateOptions& o = *options;
  command->add_option("CONFIG", o.config,
                      "Configuration file (TOML); [calibration] says what is fitted and how");
  command
      ->add_option("--target", o.target,
                   "earth, earth-statistical, a CSV file of quantiles or bins, or a DEM in "
                   "NetCDF")
      ->type_name("FILE[:VARIABLE]");
  command->add_option("-o", o.folder, "Folder for the results (default: calibration)")
      ->type_name("DIR");
  command->add_option("--preset", o.preset, "Start from a built-in configuration")
      ->type_name("NAME");
  command->add_option("--set", o.assignments, "Set one parameter; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);  // a configuration may follow
  command->add_flag("--resume", o.resume, "Go on after the last complete iteration of the folder");
  command->add_flag("--allow-other-build", o.allow_other_build,
                    "With --resume: go on with what another build of terrane began; "
                    "calibration.json keeps which ones");
  command->add_flag("--overwrite", o.overwrite, "Replace the calibration that the folder holds");
  command->add_option("--threads", o.threads, "Threads (default: as many as there are cores)")
      ->type_name("N");
  add_memory_options(*command, o.memory, "the fit");
  command->add_flag("--quiet", o.quiet, "Say nothing but warnings and errors");
  command->add_flag("--log-json", o.log_json, "Log one JSON object a line");
  command->callback([&action, options] { action = [options] { run(*options); }; });
}

}  // namespace terrane
