#pragma once

#include <string>
#include <vector>

#include "geo/core/pipeline.hpp"
#include "geo/core/planet.hpp"
#include "geo/io/run_settings.hpp"
#include "geo/stages/stages.hpp"

namespace terrane {

/// Everything that can be configured, with its declarations bound to the members: not movable.
class Configuration {
 public:
  Configuration();
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  [[nodiscard]] const std::vector<geo::Parameter>& parameters() const { return parameters_; }
  /// Positions in the full order of stages, parallel to the pipeline.
  [[nodiscard]] std::vector<int> stage_numbers() const;

  geo::io::RunSettings settings;
  geo::Planet planet;
  geo::Pipeline pipeline;

 private:
  std::vector<geo::Parameter> parameters_;
};

}  // namespace terrane
