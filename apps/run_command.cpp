#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "configuration.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/presets.hpp"
#include "geo/io/run/run_session.hpp"
#include "log.hpp"
#include "progress.hpp"
#include "signals.hpp"
#include "thread_count.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

/// The command line of `run` as it was typed.
struct RunOptions {
  std::string config, folder = "out", preset, seed, grid, topology, dem, dem_range, dem_window,
                      exemplars, from, to, threads;
  std::vector<std::string> assignments;
  bool resume = false, allow_other_build = false, overwrite = false, dry_run = false;
  bool quiet = false, log_json = false, json_progress = false, no_vtk = false, no_maps = false;
};

/// A path that the configuration gives is relative to where the configuration file lies.
void anchor_paths(geo::io::RunSettings& settings, const fs::path& folder) {
  for (std::string* path : {&settings.dem_file, &settings.exemplars}) {
    if (!path->empty()) *path = fs::absolute(folder / *path).lexically_normal().string();
  }
}

void set_option(const Configuration& configuration, std::string_view option, std::string_view name,
                const std::string& text) {
  if (text.empty()) return;
  try {
    geo::find_parameter(configuration.parameters(), name)->set_text(text);
  } catch (const geo::ConfigurationError& error) {
    throw geo::ConfigurationError(fmt::format("{}: {}", option, error.what()));
  }
}

/// Refuses stages that a torus has no meaning for, before anything is computed.
void check_topology(const Configuration& configuration) {
  if (configuration.settings.topology != "torus") return;
  using Wanted = std::pair<std::string_view, std::string>;
  for (const auto& [name, value] :
       {Wanted{"plates.model", "raster"}, Wanted{"isostasy.crust", "simulated"}}) {
    const geo::Parameter* row = geo::find_parameter(configuration.parameters(), name);
    if (row->value() == geo::ParameterValue(value)) continue;
    throw geo::ConfigurationError(
        fmt::format("run.topology = torus: {} must be {}, as in preset raster", name, value));
  }
}

/// Defaults, then preset, then file, then the command line. A run that goes on in a folder starts
/// from the configuration which that folder holds, unless another is given. Returns whether it did.
bool configure(Configuration& configuration, const RunOptions& options) {
  const auto& parameters = configuration.all_parameters();
  auto& settings = configuration.settings;
  fs::path file = options.config;
  const fs::path kept = fs::path(options.folder) / "config.toml";
  const bool goes_on = options.resume || (options.overwrite && !options.from.empty());
  const bool takes_kept = file.empty() && options.preset.empty() && goes_on && fs::exists(kept);
  if (takes_kept) file = kept;
  // A real relief on the command line is taken as it is, not worn down as a new one, unless a
  // preset or the file says so.
  const bool bare = options.preset.empty() && !takes_kept;
  const bool bare_relief = bare && !options.dem.empty();
  // A torus has one model of plates.
  const bool bare_torus = bare && file.empty() && options.topology == "torus";
  const std::string preset = bare_relief ? "earth-dem" : bare_torus ? "raster" : options.preset;
  if (!preset.empty()) {
    geo::io::apply_toml(geo::io::find_preset(preset).toml, "preset " + preset, parameters,
                        &settings.events);
  }
  if (!file.empty()) {
    geo::io::apply_config_file(file, parameters, &settings.events);
    anchor_paths(settings, file.parent_path());
  }
  if (!options.dem.empty()) {
    const auto [path, variable] = geo::io::split_dem(options.dem);
    settings.dem_file = path.string();
    settings.dem_variable = variable;
  }
  for (const std::string& assignment : options.assignments) {
    geo::io::apply_assignment(assignment, parameters);
  }
  if (!options.exemplars.empty()) {
    settings.exemplars = options.exemplars;
    set_option(configuration, "--exemplars", "island.detail", "exemplars");
  }
  anchor_paths(settings, fs::current_path());
  set_option(configuration, "--seed", "run.seed", options.seed);
  set_option(configuration, "--grid", "run.grid", options.grid);
  set_option(configuration, "--dem-range", "dem.range", options.dem_range);
  set_option(configuration, "--dem-window", "dem.window", options.dem_window);
  set_option(configuration, "--topology", "run.topology", options.topology);
  check_topology(configuration);
  if (options.no_vtk) settings.vtk = false;
  if (options.no_maps) settings.maps = false;
  return takes_kept;
}

void print_prediction(const geo::io::RunSession& session, const RunOptions& options, int threads) {
  const auto prediction = session.prediction(geo::io::measure_machine(threads));
  const auto& grid = session.grid();
  fmt::print("grid    {} x {}, {} cells\n", grid.nx(), grid.ny(), grid.size());
  fmt::print("stages  {}\n", fmt::join(session.stages_to_run(), " "));
  fmt::print("memory  about {}\n", shown_bytes(prediction.memory_bytes));
  fmt::print("time    about {} on {} thread{}\n", shown_seconds(prediction.seconds), threads,
             threads == 1 ? "" : "s");
  fmt::print("files   about {} in {}\n", shown_bytes(prediction.disk_bytes), options.folder);
}

void run(const RunOptions& options) {
  set_log_style({.json = options.log_json || options.json_progress, .quiet = options.quiet});
  const int threads = use_threads(options.threads);
  Configuration configuration;
  const bool folders_configuration = configure(configuration, options);
  geo::io::RunSession session(configuration.pipeline, configuration.stage_numbers(),
                              configuration.settings, configuration.planet,
                              configuration.parameters(),
                              {.folder = options.folder,
                               .from = options.from,
                               .to = options.to,
                               .resume = options.resume,
                               .allow_other_build = options.allow_other_build,
                               .folders_configuration = folders_configuration,
                               .overwrite = options.overwrite,
                               .threads = threads});
  session.prepare();
  if (options.dry_run) return print_prediction(session, options, threads);

  Progress progress(options.json_progress               ? ProgressStyle::json
                    : options.quiet || options.log_json ? ProgressStyle::none
                                                        : ProgressStyle::bar);
  geo::io::RunEvents events;
  events.stage_begins = [&](std::string_view stage, double cells) {
    progress.begin(stage, cells);
    progress.update(0.0);
  };
  events.stage_ends = [&](std::string_view stage, double seconds) {
    progress.end(stage, seconds);
    log_info(fmt::format("{:<10} {}", stage, shown_seconds(seconds)));
  };
  events.progress = [&](double fraction) { progress.update(fraction); };
  events.info = [&](std::string_view message) {
    progress.clear();
    log_info(message);
  };
  events.warning = [&](std::string_view message) {
    progress.clear();
    log_warning(message);
  };
  events.stop = &stop_requested();
  try {
    session.execute(events);
  } catch (const geo::Interrupted&) {
    throw geo::Error(geo::ErrorKind::interrupted,
                     fmt::format("interrupted; terrane run --resume -o {} goes on after the last "
                                 "complete stage",
                                 options.folder));
  }
  log_info(fmt::format("the files are in {}", options.folder));
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "run", "Runs the pipeline and writes one NetCDF and one VTK file per stage");
  const auto options = std::make_shared<RunOptions>();
  RunOptions& o = *options;
  command->add_option("CONFIG", o.config, "Configuration file (TOML)");
  command->add_option("-o", o.folder, "Folder for the files of the run (default: out)")
      ->type_name("DIR");
  command->add_option("--preset", o.preset, "Start from a built-in configuration")
      ->type_name("NAME");
  command->add_option("--seed", o.seed, "Seed of every random number")->type_name("N");
  command->add_option("--set", o.assignments, "Set one parameter; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);  // a configuration may follow
  command->add_option("--grid", o.grid, "Cells of the grid")->type_name("WIDTHxHEIGHT");
  command
      ->add_option("--topology", o.topology,
                   "sphere, or torus: a tile whose opposite sides meet; without --preset and a "
                   "file, preset raster")
      ->type_name("sphere|torus");
  command
      ->add_option("--dem", o.dem,
                   "A real relief takes the place of plates and isostasy; without --preset, preset "
                   "earth-dem")
      ->type_name("FILE[:VARIABLE]");
  command
      ->add_option("--dem-range", o.dem_range,
                   "Heights of black and white in a grey PNG, m, such as --dem-range=-11000,9000 "
                   "(default: what the JSON beside it says)")
      ->type_name("MIN,MAX");
  command
      ->add_option("--dem-window", o.dem_window,
                   "Where the edges of a PNG lie, degrees (default: the whole planet)")
      ->type_name("W,S,E,N");
  command
      ->add_option("--exemplars", o.exemplars,
                   "Folder of real reliefs (NetCDF, GeoTIFF, m) that the island's terrain is made "
                   "like")
      ->type_name("DIR");
  command
      ->add_option("--from", o.from,
                   "First stage. In a new folder it starts from the relief itself; with "
                   "--overwrite the folder's earlier stages stay")
      ->type_name("STAGE");
  command->add_option("--to", o.to, "Last stage")->type_name("STAGE");
  command->add_flag("--resume", o.resume, "Go on after the last complete stage of the folder");
  command->add_flag("--allow-other-build", o.allow_other_build,
                    "With --resume or --from: go on behind stages that another build of terrane "
                    "wrote; the manifest keeps that it was allowed");
  command->add_flag("--overwrite", o.overwrite, "Replace the run that the folder holds");
  command->add_option("--threads", o.threads, "Threads (default: as many as there are cores)")
      ->type_name("N");
  command->add_flag("--no-vtk", o.no_vtk, "Write no files for ParaView");
  command->add_flag("--no-maps", o.no_maps, "Draw no maps and no report");
  command->add_flag("--dry-run", o.dry_run,
                    "Check everything, predict memory and time, write "
                    "nothing");
  command->add_flag("--quiet", o.quiet, "Say nothing but warnings and errors");
  command->add_flag("--log-json", o.log_json, "Log one JSON object a line");
  command->add_flag(
      "--json-progress", o.json_progress,
      "For programs that watch: progress and log as one JSON object a line on stderr");
  command->callback([&action, options] { action = [options] { run(*options); }; });
}

}  // namespace terrane
