#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/configuration.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/run/difference.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_folder.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The exit code where two differ: an answer rather than a failure, so no kind of the library's.
constexpr geo::ErrorKind kDifferent{6};

struct DiffOptions {
  std::string first, second, tolerance, relative;
  bool json = false;
};

/// A parameter that two configurations give other values.
struct ParameterDifference {
  std::string name, first, second;
};

/// What two stages, or files, have in other ways.
struct StageDifference {
  std::string stage, fault;
  std::vector<geo::io::FieldDifference> fields;
};

struct Comparison {
  std::vector<ParameterDifference> parameters;
  std::vector<StageDifference> stages;
  int fields = 0, different = 0;

  void add(StageDifference stage) {
    fields += static_cast<int>(stage.fields.size());
    for (const auto& field : stage.fields) different += field.is_same() ? 0 : 1;
    if (!stage.fault.empty()) ++different;
    stages.push_back(std::move(stage));
  }
  [[nodiscard]] bool is_same() const { return different == 0 && parameters.empty(); }
};

double tolerance_of(std::string_view option, const std::string& text) {
  if (text.empty()) return 0.0;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !(number >= 0.0)) {
    throw geo::ConfigurationError(
        fmt::format("{} {}: must be a number, 0 at least, such as 1e-6", option, text));
  }
  return number;
}

void compare_configurations(const fs::path& a, const fs::path& b, Comparison& result) {
  Configuration first, second;
  geo::io::apply_config_file(a, first.all_parameters(), &first.settings.events);
  geo::io::apply_config_file(b, second.all_parameters(), &second.settings.events);
  const auto& rows = first.all_parameters();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto one = rows[k].value(), other = second.all_parameters()[k].value();
    if (one == other) continue;
    result.parameters.push_back(
        {std::string(rows[k].name), geo::to_toml(one), geo::to_toml(other)});
  }
  const std::string one = geo::io::write_events(first.settings.events);
  const std::string other = geo::io::write_events(second.settings.events);
  if (one != other) {
    result.parameters.push_back({"event", fmt::format("{} events", first.settings.events.size()),
                                 fmt::format("{} events", second.settings.events.size())});
  }
}

void compare_runs(const DiffOptions& options, const geo::io::Tolerance& tolerance,
                  Comparison& result) {
  const geo::io::RunFolder a(options.first), b(options.second);
  compare_configurations(a.config(), b.config(), result);
  const auto first = geo::io::read_manifest(a.manifest()),
             second = geo::io::read_manifest(b.manifest());
  const auto find = [](const geo::io::Manifest& manifest, const std::string& name) {
    return std::find_if(manifest.stages.begin(), manifest.stages.end(),
                        [&](const auto& record) { return record.name == name; });
  };
  for (const auto& record : first.stages) {
    const auto other = find(second, record.name);
    if (other == second.stages.end()) {
      result.add({record.name, "only in the first", {}});
      continue;
    }
    result.add({record.name, "",
                geo::io::differences(geo::io::read_netcdf(a.path() / geo::io::netcdf_of(record)),
                                     geo::io::read_netcdf(b.path() / geo::io::netcdf_of(*other)),
                                     tolerance)});
  }
  for (const auto& record : second.stages) {
    if (find(first, record.name) == first.stages.end()) {
      result.add({record.name, "only in the second", {}});
    }
  }
}

std::string place_words(const geo::io::FieldDifference& field) {
  if (!field.place) return fmt::format("in cell {}", field.cell);
  return fmt::format("at {:.4f},{:.4f}", field.place->latitude_deg, field.place->longitude_deg);
}

void print_table(const Comparison& result) {
  for (const auto& row : result.parameters) {
    fmt::print("{}: {} and {}\n", row.name, row.first, row.second);
  }
  for (const auto& stage : result.stages) {
    if (!stage.fault.empty()) fmt::print("{}: {}\n", stage.stage, stage.fault);
    for (const auto& field : stage.fields) {
      if (field.is_same()) continue;
      const std::string name = fmt::format("{}/{}", stage.stage, field.name);
      if (!field.fault.empty()) {
        fmt::print("{}: {}\n", name, field.fault);
        continue;
      }
      fmt::print(
          "{}: {:.0f} of {:.0f} cells; by {:.6g} {} at most, {:.6g} and {:.6g} {}; mean {:.6g}\n",
          name, field.different, field.cells, field.largest, field.units, field.first, field.second,
          place_words(field), field.mean);
    }
  }
  if (result.is_same()) fmt::print("the same: {} fields\n", result.fields);
}

/// JSON has no infinity and no NaN: null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

void print_json(const DiffOptions& options, const Comparison& result) {
  Json parameters = Json::array(), stages = Json::array();
  for (const auto& row : result.parameters) {
    parameters.push_back({{"name", row.name}, {"first", row.first}, {"second", row.second}});
  }
  for (const auto& stage : result.stages) {
    Json fields = Json::array();
    for (const auto& field : stage.fields) {
      Json entry{{"name", field.name}, {"units", field.units}, {"same", field.is_same()}};
      if (!field.fault.empty()) {
        entry["fault"] = field.fault;
      } else {
        entry["cells"] = field.cells;
        entry["different"] = field.different;
        entry["largest"] = number(field.largest);
        entry["mean"] = field.mean;
        if (field.cell != geo::kNoCell) {
          entry["cell"] = field.cell;
          entry["first"] = number(field.first);
          entry["second"] = number(field.second);
        }
        if (field.place) {
          entry["latitude"] = field.place->latitude_deg;
          entry["longitude"] = field.place->longitude_deg;
        }
      }
      fields.push_back(entry);
    }
    Json entry{{"stage", stage.stage}, {"fields", fields}};
    if (!stage.fault.empty()) entry["fault"] = stage.fault;
    stages.push_back(entry);
  }
  const Json json{{"first", options.first},
                  {"second", options.second},
                  {"same", result.is_same()},
                  {"parameters", parameters},
                  {"stages", stages}};
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

void compare(const DiffOptions& options) {
  use_threads();
  if (options.first.empty() || options.second.empty()) {
    throw geo::ConfigurationError(
        "diff: which two? Give two runs, two stage files or two configurations");
  }
  const geo::io::Tolerance tolerance{tolerance_of("--tolerance", options.tolerance),
                                     tolerance_of("--relative", options.relative)};
  const auto is_run = [](const std::string& place) {
    return fs::exists(geo::io::RunFolder(place).manifest());
  };
  const auto is_configuration = [](const fs::path& path) { return path.extension() == ".toml"; };
  Comparison result;
  const bool folders = fs::is_directory(options.first);
  if (folders != fs::is_directory(options.second) ||
      is_configuration(options.first) != is_configuration(options.second)) {
    throw geo::ConfigurationError(fmt::format(
        "diff: {} and {} are of unlike kinds: give two runs, two stage files or two configurations",
        options.first, options.second));
  }
  if (folders) {
    for (const std::string& place : {options.first, options.second}) {
      if (is_run(place)) continue;
      throw geo::ConfigurationError(
          fmt::format("diff: {} holds no run: give the folder of one", place));
    }
    compare_runs(options, tolerance, result);
  } else if (is_configuration(options.first)) {
    compare_configurations(options.first, options.second, result);
  } else {
    const auto first = geo::io::read_netcdf(options.first);
    result.add({first.stage, "",
                geo::io::differences(first, geo::io::read_netcdf(options.second), tolerance)});
  }
  options.json ? print_json(options, result) : print_table(result);
  if (result.is_same()) return;
  throw geo::Error(kDifferent, fmt::format("{} and {} differ in {} of {} fields and {} parameters",
                                           options.first, options.second, result.different,
                                           result.fields, result.parameters.size()));
}

}  // namespace

void add_diff_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "diff", "Compares two runs, stage files or configurations; exit code 6 if they differ");
  const auto options = std::make_shared<DiffOptions>();
  command->add_option("A", options->first, "Folder of a run, a stage file, or a configuration");
  command->add_option("B", options->second, "Another of the same kind");
  command
      ->add_option("--tolerance", options->tolerance,
                   "How far real numbers may be apart, in the field's unit (default: 0)")
      ->type_name("T");
  command
      ->add_option("--relative", options->relative,
                   "The same as a share of the larger of both (default: 0)")
      ->type_name("R");
  command->add_flag("--json", options->json, "Every field, as JSON");
  command->callback([&action, options] { action = [options] { compare(*options); }; });
}

}  // namespace terrane
