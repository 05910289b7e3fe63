#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/configuration.hpp"
#include "apps/log.hpp"
#include "apps/memory/memory.hpp"
#include "apps/memory/memory_cap.hpp"
#include "apps/memory_option.hpp"
#include "apps/progress.hpp"
#include "apps/ranks/rank_messages.hpp"
#include "apps/ranks/ranks.hpp"
#include "apps/signals.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/run/run_session.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

/// The command line of `run` as it was typed.
struct RunOptions {
  ConfigurationSources sources;
  std::string folder = "out", from, to, threads;
  MemoryOption memory;
  bool resume = false, allow_other_build = false, overwrite = false, dry_run = false;
  bool quiet = false, log_json = false, json_progress = false, no_vtk = false, no_maps = false;
};

/// A run that goes on in a folder starts from the configuration which that folder holds, unless
/// another is given. Returns whether it did.
bool configure(Configuration& configuration, const RunOptions& options) {
  ConfigurationSources sources = options.sources;
  const fs::path kept = fs::path(options.folder) / "config.toml";
  const bool goes_on = options.resume || (options.overwrite && !options.from.empty());
  const bool takes_kept =
      sources.config.empty() && sources.preset.empty() && goes_on && fs::exists(kept);
  if (takes_kept) sources.config = kept.string();
  sources.is_kept = takes_kept;
  configuration.take(sources);
  if (options.no_vtk) configuration.settings.vtk = false;
  if (options.no_maps) configuration.settings.maps = false;
  return takes_kept;
}

void print_prediction(const geo::io::RunSession& session, const RunOptions& options, int threads) {
  const auto prediction = session.prediction(geo::io::measure_machine(threads));
  double seconds = prediction.seconds;
  const auto& grid = session.grid();
  fmt::print("grid    {} x {}, {} cells\n", grid.nx(), grid.ny(), grid.size());
  fmt::print("stages  {}\n", fmt::join(session.stages_to_run(), " "));
  if (const RankMessages* const ranks = other_ranks()) {
    const double each = options.memory.bytes_of_rank(ranks->count(), prediction.memory_bytes);
    fmt::print("memory  at most {} in each of {} ranks\n", shown_bytes(each), ranks->count());
  } else if (!options.memory.is_given()) {
    fmt::print("memory  about {}\n", shown_bytes(prediction.memory_bytes));
  } else {
    const auto taken =
        memory_under_cap(options.memory.bytes(), prediction.memory_bytes, available_memory_bytes());
    seconds *= taken.times_as_long;
    fmt::print("memory  about {}\n", shown_bytes(taken.resident_bytes));
    fmt::print("scratch about {} in {}\n", shown_bytes(taken.scratch_bytes),
               options.memory.scratch_folder(options.folder));
  }
  fmt::print("time    about {} on {} thread{}\n", shown_seconds(seconds), threads,
             threads == 1 ? "" : "s");
  fmt::print("files   about {} in {}\n", shown_bytes(prediction.disk_bytes), options.folder);
}

/// Columns of the largest planet, twice as wide as high, on which the run fits into so much memory;
/// 0 where it fits on none, because of an island's own cells.
int columns_within(const geo::io::RunSession& session, double bytes) {
  constexpr int kStep = 32;
  const auto wants_bytes = [&](int columns) {
    return session.prediction_on(0.5 * columns * columns, {}).memory_bytes;
  };
  const double most = std::sqrt(2.0 * static_cast<double>(session.grid().size()));
  int columns = static_cast<int>(most / kStep) * kStep;
  while (columns > 0 && wants_bytes(columns) > bytes) columns -= kStep;
  return columns;
}

/// A run that the machine cannot hold would end somewhere in its middle, or hold up everybody else.
void refuse_beyond_memory(const geo::io::RunSession& session) {
  const double wanted = session.prediction({}).memory_bytes, there = available_memory_bytes();
  if (wanted <= there) return;
  // What others take changes from one moment to the next.
  constexpr double kOurs = 0.75, kGibibyte = 0x1p30;
  const int columns = columns_within(session, kOurs * there);
  const std::string fewer =
      columns > 0 ? fmt::format("fewer cells, such as --grid {}x{}", columns, columns / 2)
                  : "an island of fewer cells, island.nx times island.ny";
  throw geo::ConfigurationError(fmt::format(
      "a run on {} x {} cells wants about {} of memory, and there are {} (--memory {:.0f}GiB would "
      "keep it within less, mpirun would share it among machines): must be {}",
      session.grid().nx(), session.grid().ny(), shown_bytes(wanted), shown_bytes(there),
      std::max(1.0, std::floor(kOurs * there / kGibibyte)), fewer));
}

void run(const RunOptions& options) {
  set_log_style({.json = options.log_json || options.json_progress, .quiet = options.quiet});
  const int threads = use_threads(options.threads);
  static_cast<void>(options.memory.bytes());
  RankMessages* const ranks = options.dry_run ? nullptr : other_ranks();
  std::unique_ptr<MemoryCap> cap;
  if (!options.dry_run && ranks == nullptr) cap = options.memory.cap(options.folder);
  Configuration configuration;
  const bool folders_configuration = configure(configuration, options);
  geo::io::RunSession session(configuration.run(), configuration.stage_numbers(),
                              {.folder = options.folder,
                               .from = options.from,
                               .to = options.to,
                               .resume = options.resume,
                               .allow_other_build = options.allow_other_build,
                               .folders_configuration = folders_configuration,
                               .overwrite = options.overwrite,
                               .threads = threads});
  session.prepare();
  if (options.dry_run) print_prediction(session, options, threads);
  if (!options.memory.is_given() && other_ranks() == nullptr) refuse_beyond_memory(session);
  if (options.dry_run) return;
  const double wanted = session.prediction({}).memory_bytes;
  if (cap != nullptr) cap->expect(wanted);
  if (ranks != nullptr) {
    cap = std::make_unique<MemoryCap>(options.memory.bytes_of_rank(ranks->count(), wanted), *ranks,
                                      wanted);
  }

  Progress progress(options.json_progress               ? ProgressStyle::json
                    : options.quiet || options.log_json ? ProgressStyle::none
                                                        : ProgressStyle::bar);
  geo::io::RunEvents events;
  events.stage_begins = [&](std::string_view stage, double cells) {
    give_back_memory();
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
  if (cap) {
    const std::string kept = shown_bytes(cap->scratch_bytes());
    log_info(fmt::format("at most {} of memory, {}", shown_bytes(peak_resident_bytes()),
                         ranks == nullptr
                             ? kept + " in the scratch file"
                             : fmt::format("{} shared with the other ranks, {} exchanged with them",
                                           kept, shown_bytes(cap->exchanged_bytes()))));
  }
  log_info(fmt::format("the files are in {}", options.folder));
}

/// What planet is to be made.
void add_planet_options(CLI::App& command, ConfigurationSources& from) {
  command.add_option("--preset", from.preset, "Start from a built-in configuration")
      ->type_name("NAME");
  command.add_option("--seed", from.seed, "Seed of every random number")->type_name("N");
  command.add_option("--set", from.assignments, "Set one parameter; may be repeated")
      ->type_name("section.key=value")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);  // a configuration may follow
  command.add_option("--grid", from.grid, "Cells of the grid")->type_name("WIDTHxHEIGHT");
  command
      .add_option("--topology", from.topology,
                  "sphere, or torus: a tile whose opposite sides meet; without --preset and a "
                  "file, preset raster")
      ->type_name("sphere|torus");
  command
      .add_option("--turn", from.turn,
                  "Lay the planet out with its place LAT,LON at the north pole and the prime "
                  "meridian ANGLE degrees further east")
      ->type_name("LAT,LON,ANGLE");
}

/// What it is made from.
void add_input_options(CLI::App& command, ConfigurationSources& from) {
  command
      .add_option("--dem", from.dem,
                  "A DEM takes the place of plates and isostasy; without --preset, preset "
                  "earth-dem")
      ->type_name("FILE[:VARIABLE]");
  command
      .add_option("--dem-range", from.dem_range,
                  "Heights of black and white in a grey PNG, m, such as --dem-range=-11000,9000 "
                  "(default: what the JSON beside it says)")
      ->type_name("MIN,MAX");
  command
      .add_option("--dem-window", from.dem_window,
                  "Where the edges of a PNG lie, degrees (default: the whole planet)")
      ->type_name("W,S,E,N");
  command
      .add_option("--exemplars", from.exemplars,
                  "Folder of DEMs (NetCDF, GeoTIFF, m) that the island's terrain is made "
                  "like")
      ->type_name("DIR");
}

/// Which stages are run.
void add_stage_options(CLI::App& command, RunOptions& o) {
  command
      .add_option("--from", o.from,
                  "First stage. In a new folder it starts from the DEM itself; with "
                  "--overwrite the folder's earlier stages stay")
      ->type_name("STAGE");
  command.add_option("--to", o.to, "Last stage")->type_name("STAGE");
  command.add_flag("--resume", o.resume, "Go on after the last complete stage of the folder");
  command.add_flag("--allow-other-build", o.allow_other_build,
                   "With --resume or --from: go on behind stages that another build of terrane "
                   "wrote; the manifest keeps that it was allowed");
  command.add_flag("--overwrite", o.overwrite, "Replace the run that the folder holds");
}

/// How the run goes, and what it writes and says.
void add_manner_options(CLI::App& command, RunOptions& o) {
  command.add_option("--threads", o.threads, "Threads (default: as many as there are cores)")
      ->type_name("N");
  add_memory_options(command, o.memory, "the run (under mpirun each of its ranks)");
  command.add_flag("--no-vtk", o.no_vtk, "Write no files for ParaView");
  command.add_flag("--no-maps", o.no_maps, "Draw no maps and no report");
  command.add_flag("--dry-run", o.dry_run,
                   "Check everything, predict memory and time, write "
                   "nothing");
  command.add_flag("--quiet", o.quiet, "Say nothing but warnings and errors");
  command.add_flag("--log-json", o.log_json, "Log one JSON object a line");
  command.add_flag("--json-progress", o.json_progress,
                   "For programs that watch: progress and log as one JSON object a line on stderr");
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand(
      "run", "Runs the pipeline and writes one NetCDF and one VTK file per stage");
  const auto options = std::make_shared<RunOptions>();
  RunOptions& o = *options;
  command.add_option("CONFIG", o.sources.config, "Configuration file (TOML)");
  command.add_option("-o", o.folder, "Folder for the files of the run (default: out)")
      ->type_name("DIR");
  add_planet_options(command, o.sources);
  add_input_options(command, o.sources);
  add_stage_options(command, o);
  add_manner_options(command, o);
  command.callback([&action, options] { action = [options] { run(*options); }; });
}

}  // namespace terrane
