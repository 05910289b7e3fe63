#include "configuration.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/presets.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;

/// A path that the configuration gives is relative to where the configuration file lies.
void anchor_paths(geo::io::RunSettings& settings, const fs::path& folder) {
  for (std::string* path : {&settings.dem_file, &settings.exemplars}) {
    if (!path->empty()) *path = fs::absolute(folder / *path).lexically_normal().string();
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

/// The preset that a run starts from. A DEM is taken as it is, not worn down as a new one,
/// unless a preset or a kept file says so; a torus has one model of plates.
std::string preset_of(const ConfigurationSources& sources) {
  if (!sources.preset.empty() || sources.is_kept) return sources.preset;
  if (!sources.dem.empty()) return "earth-dem";
  if (sources.config.empty() && sources.topology == "torus") return "raster";
  return {};
}

}  // namespace

Configuration::Configuration() : pipeline(geo::make_pipeline()) {
  for (auto declarations : {settings.parameters(), planet.parameters(), pipeline.parameters()}) {
    parameters_.insert(parameters_.end(), declarations.begin(), declarations.end());
  }
  all_parameters_ = parameters_;
  const auto own = calibration.parameters();
  all_parameters_.insert(all_parameters_.end(), own.begin(), own.end());
}

void Configuration::take(const ConfigurationSources& sources) {
  const std::string preset = preset_of(sources);
  if (!preset.empty()) {
    geo::io::apply_toml(geo::io::find_preset(preset).toml, "preset " + preset, all_parameters_,
                        &settings.events);
  }
  if (!sources.config.empty()) {
    geo::io::apply_config_file(sources.config, all_parameters_, &settings.events);
    anchor_paths(settings, fs::path(sources.config).parent_path());
  }
  if (!sources.dem.empty()) {
    const auto [path, variable] = geo::io::split_dem(sources.dem);
    settings.dem_file = path.string();
    settings.dem_variable = variable;
  }
  for (const std::string& assignment : sources.assignments) {
    geo::io::apply_assignment(assignment, all_parameters_);
  }
  const auto set = [&](std::string_view option, std::string_view name, const std::string& text) {
    if (text.empty()) return;
    try {
      geo::find_parameter(parameters_, name)->set_text(text);
    } catch (const geo::ConfigurationError& error) {
      throw geo::ConfigurationError(fmt::format("{}: {}", option, error.what()));
    }
  };
  if (!sources.exemplars.empty()) {
    settings.exemplars = sources.exemplars;
    set("--exemplars", "island.detail", "exemplars");
  }
  anchor_paths(settings, fs::current_path());
  set("--seed", "run.seed", sources.seed);
  set("--grid", "run.grid", sources.grid);
  set("--dem-range", "dem.range", sources.dem_range);
  set("--dem-window", "dem.window", sources.dem_window);
  set("--topology", "run.topology", sources.topology);
  set("--turn", "run.turn", sources.turn);
  check_topology(*this);
}

std::vector<int> Configuration::stage_numbers() const {
  std::vector<int> numbers;
  for (const geo::StageEntry& entry : geo::stage_table()) numbers.push_back(entry.number);
  return numbers;
}

}  // namespace terrane
