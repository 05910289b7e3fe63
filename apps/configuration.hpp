#pragma once

#include <string>
#include <vector>

#include "calibration/settings.hpp"
#include "geo/core/pipeline.hpp"
#include "geo/core/planet.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/stages/stages.hpp"

namespace terrane {

/// Everything that can be configured, with its declarations bound to the members: not movable.
class Configuration {
 public:
  Configuration();
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  /// What a run can be told.
  [[nodiscard]] const std::vector<geo::Parameter>& parameters() const { return parameters_; }
  /// What a configuration file may hold: that, and the section of calibrations.
  [[nodiscard]] const std::vector<geo::Parameter>& all_parameters() const {
    return all_parameters_;
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
