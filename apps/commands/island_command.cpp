#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <charconv>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/configuration.hpp"
#include "apps/log.hpp"
#include "apps/memory_option.hpp"
#include "apps/progress.hpp"
#include "apps/signals.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/run/island_session.hpp"

namespace terrane {
namespace {

struct IslandOptions {
  std::string folder, center, size, cell, detail, exemplars;
  MemoryOption memory;
  bool no_maps = false, allow_other_build = false;
  bool quiet = false;
};

void set(const Configuration& configuration, std::string_view name, const std::string& text) {
  geo::find_parameter(configuration.parameters(), name)->set_text(text);
}

/// "1024,512".
void set_size(const Configuration& configuration, const std::string& text) {
  const auto comma = text.find(',');
  if (comma == std::string::npos) {
    throw geo::ConfigurationError(
        fmt::format("--size {}: must be columns and rows, such as 1024,512", text));
  }
  set(configuration, "island.nx", text.substr(0, comma));
  set(configuration, "island.ny", text.substr(comma + 1));
}

void make_island(const IslandOptions& options) {
  set_log_style({.json = false, .quiet = options.quiet});
  use_threads();
  const geo::io::RunFolder folder(options.folder);
  if (options.folder.empty()) {
    throw geo::ConfigurationError("island: give the folder of a run: terrane island DIR");
  }
  if (!std::filesystem::exists(folder.manifest())) {
    throw geo::ConfigurationError(
        fmt::format("island: {} holds no run: give the folder of one", options.folder));
  }
  const auto cap = options.memory.cap(options.folder);
  Configuration configuration;
  geo::io::apply_config_file(folder.config(), configuration.parameters(),
                             &configuration.settings.events);
  if (!options.center.empty()) set(configuration, "island.center", options.center);
  if (!options.size.empty()) set_size(configuration, options.size);
  if (!options.cell.empty()) set(configuration, "island.cell_m", options.cell);
  if (!options.exemplars.empty()) {
    configuration.settings.exemplars = std::filesystem::absolute(options.exemplars).string();
    set(configuration, "island.detail", "exemplars");
  }
  if (!options.detail.empty()) set(configuration, "island.detail", options.detail);
  if (options.no_maps) configuration.settings.maps = false;

  geo::io::IslandSession session(configuration.pipeline, configuration.stage_numbers().back(),
                                 configuration.settings, configuration.planet,
                                 configuration.parameters(), options.folder);
  session.prepare(options.allow_other_build);
  Progress progress(options.quiet ? ProgressStyle::none : ProgressStyle::bar);
  geo::io::RunEvents events;
  events.stage_begins = [&](std::string_view stage, double cells) { progress.begin(stage, cells); };
  events.progress = [&](double fraction) { progress.update(fraction); };
  events.stage_ends = [&](std::string_view stage, double seconds) {
    progress.clear();
    log_info(fmt::format("{:<10} {:.1f} s", stage, seconds));
  };
  events.stop = &stop_requested();
  const std::string name = session.execute(events);
  log_info(fmt::format("{} is in {}", name, options.folder));
}

}  // namespace

void add_island_command(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("island", "Crops and refines one more island from a finished planet");
  const auto options = std::make_shared<IslandOptions>();
  command->add_option("DIR", options->folder, "Folder of a run");
  command
      ->add_option("--center", options->center,
                   "Centre of the island in degrees (default: as the run, else the best score)")
      ->type_name("LAT,LON");
  command->add_option("--size", options->size, "Columns and rows of its grid (default: as the run)")
      ->type_name("NX,NY");
  command->add_option("--cell", options->cell, "Size of its cells (default: as the run)")
      ->type_name("METRES");
  command
      ->add_option("--detail", options->detail,
                   "What its detail is made of: roughness, height or exemplars (default: as the "
                   "run)")
      ->type_name("WORD");
  command
      ->add_option("--exemplars", options->exemplars,
                   "Folder of DEMs (NetCDF, GeoTIFF, m) that its terrain is made like")
      ->type_name("DIR");
  command->add_flag("--allow-other-build", options->allow_other_build,
                    "Cut it from a planet that another build of terrane made; the manifest keeps "
                    "that it was allowed");
  add_memory_options(*command, options->memory, "the island");
  command->add_flag("--no-maps", options->no_maps, "Draw no maps");
  command->add_flag("--quiet", options->quiet, "Say nothing but warnings and errors");
  command->callback([&action, options] { action = [options] { make_island(*options); }; });
}

}  // namespace terrane
