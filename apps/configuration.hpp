#pragma once

#include <string>
#include <vector>

#include "calibration/settings.hpp"
#include "geo/core/pipeline.hpp"
#include "geo/core/planet.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/run/run_plan.hpp"
#include "geo/stages/stages.hpp"

namespace terrane {

/// Where the values of a run's parameters come from. Later ones win: preset, file, DEM,
/// assignments, then what is named on its own. Empty: not given.
struct ConfigurationSources {
  std::string preset;                    ///< name of a built-in configuration
  std::string config;                    ///< TOML file
  std::string dem;                       ///< FILE[:VARIABLE]
  std::vector<std::string> assignments;  ///< "section.key=value"
  std::string seed, grid, topology, turn, dem_range, dem_window, exemplars;
  /// The file is what an earlier run kept: complete, so that no preset goes before it.
  bool is_kept = false;
};

/// Everything that can be configured, with its declarations bound to the members: not movable.
class Configuration {
 public:
  Configuration();
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  /// Takes the values of all sources. Throws ConfigurationError, IoError.
  void take(const ConfigurationSources& sources);

  /// What a run can be told.
  [[nodiscard]] const std::vector<geo::Parameter>& parameters() const { return parameters_; }
  /// What a configuration file may hold: that, and the section of calibrations.
  [[nodiscard]] const std::vector<geo::Parameter>& all_parameters() const {
    return all_parameters_;
  }
  /// All that a run is configured by, bound to this.
  [[nodiscard]] geo::io::RunConfiguration run() {
    return {pipeline, settings, planet, parameters_};
  }
  /// Positions in the full order of stages, parallel to the pipeline.
  [[nodiscard]] std::vector<int> stage_numbers() const;

  geo::io::RunSettings settings;
  geo::Planet planet;
  geo::Pipeline pipeline;
  geo::calibration::Settings calibration;

 private:
  std::vector<geo::Parameter> parameters_, all_parameters_;
};

}  // namespace terrane
