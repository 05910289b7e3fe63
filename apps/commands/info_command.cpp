#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/files/digest.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/recorded_file.hpp"

namespace terrane {
namespace {

std::string grid_text(const geo::Grid& grid) {
  constexpr std::string_view kTopologies[] = {"sphere", "plane", "torus"};
  std::string text = fmt::format("{} x {} cells, {}", grid.nx(), grid.ny(),
                                 kTopologies[static_cast<int>(grid.topology())]);
  if (grid.is_latitude_longitude()) {
    const auto& window = grid.window();
    text += fmt::format(", latitude {:g} to {:g}, longitude {:g} to {:g}", window.south_deg,
                        window.north_deg, window.west_deg, window.east_deg);
  } else {
    text += fmt::format(", cells of {:g} m x {:g} m", grid.spacing_east_m(0), grid.step_north_m());
  }
  return text;
}

void print_table(const geo::io::Snapshot& snapshot, const geo::io::Provenance& provenance) {
  fmt::print("stage    {}\ngrid     {}\nmade by  terrane {}, seed {}\nhistory  {}\n\n",
             snapshot.stage, grid_text(*snapshot.grid), provenance.version, provenance.seed,
             provenance.history);
  fmt::print("{:<26} {:<12} {:>12} {:>12} {:>12} {:>9}\n", "field", "unit", "min", "mean", "max",
             "missing");
  for (const auto& [spec, values] : snapshot.fields) {
    const auto summary = geo::io::summarise(*spec, *values, *snapshot.grid);
    fmt::print("{:<26} {:<12} {:>12.6g} {:>12.6g} {:>12.6g} {:>9}\n", summary.name, summary.units,
               summary.min, summary.mean, summary.max, summary.missing);
  }
}

void print_json(const geo::io::Snapshot& snapshot, const geo::io::Provenance& provenance) {
  auto fields = nlohmann::ordered_json::object();
  for (const auto& [spec, values] : snapshot.fields) {
    const auto summary = geo::io::summarise(*spec, *values, *snapshot.grid);
    fields[summary.name] = {{"units", summary.units},     {"min", summary.min},
                            {"mean", summary.mean},       {"max", summary.max},
                            {"missing", summary.missing}, {"digest", summary.digest}};
  }
  const nlohmann::ordered_json json{{"stage", snapshot.stage},   {"nx", snapshot.grid->nx()},
                                    {"ny", snapshot.grid->ny()}, {"version", provenance.version},
                                    {"seed", provenance.seed},   {"history", provenance.history},
                                    {"fields", fields}};
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void verify(const std::string& folder, bool json) {
  const auto found = geo::io::verify_run(folder);
  if (json) {
    const nlohmann::ordered_json text{{"run", folder},
                                      {"files", found.files},
                                      {"fields", found.fields},
                                      {"differences", found.differences}};
    fmt::print("{}\n", text.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    for (const std::string& difference : found.differences) fmt::print("{}\n", difference);
  }
  if (found.differences.empty()) {
    if (!json) fmt::print("{} files with {} fields are as written\n", found.files, found.fields);
    return;
  }
  const std::size_t count = found.differences.size();
  throw geo::InputError(fmt::format("{}: {} of {} files {} not what manifest.json says: {}{}",
                                    folder, count, found.files, count == 1 ? "is" : "are",
                                    found.differences.front(), count == 1 ? "" : " and more"));
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
  struct Options {
    std::string file, run;
    bool json = false;
  };
  CLI::App* command = program.add_subcommand(
      "info", "What a stage file holds: grid, fields, units, min/mean/max, provenance");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->file, "A stage file of a run, such as 04-climate.nc");
  command->add_flag("--json", options->json, "As JSON, with digests");
  command
      ->add_option("--verify", options->run,
                   "Recomputes the digests of all files of a run and names what differs from its "
                   "manifest; exit code 3 then")
      ->type_name("DIR");
  command->callback([&action, options] {
    action = [options] {
      use_threads();
      if (!options->run.empty()) return verify(options->run, options->json);
      if (options->file.empty()) {
        throw geo::ConfigurationError("info: which FILE? Give a stage file, such as 04-climate.nc");
      }
      std::error_code ignored;
      if (std::filesystem::is_directory(options->file, ignored)) {
        throw geo::ConfigurationError(fmt::format(
            "info: {0} is a folder: give a stage file in it, such as 04-climate.nc; --verify {0} "
            "checks all of a run's",
            options->file));
      }
      const auto snapshot = geo::io::read_netcdf(options->file);
      const auto provenance = geo::io::read_provenance(options->file);
      options->json ? print_json(snapshot, provenance) : print_table(snapshot, provenance);
    };
  });
}

}  // namespace terrane
