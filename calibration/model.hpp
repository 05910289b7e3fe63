#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "geo/core/parameter.hpp"
#include "geo/core/planet.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/isostasy/isostasy.hpp"

namespace geo::calibration {

/// The settings of the forward model, bound to their declarations: not movable. Rivers follow the
/// area that they drain (erosion.discharge) whatever the configuration says.
class Model {
 public:
  /// Takes over the values of a run's configuration. Throws ConfigurationError for settings that
  /// leave nothing to fit or that have no derivative: a remap of heights, the blueprint's crust.
  explicit Model(std::span<const Parameter> configuration);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// Real-valued parameters of planet, isostasy and erosion.
  [[nodiscard]] const std::vector<Parameter>& declarations() const { return declarations_; }
  /// One of them. Throws ConfigurationError that names the nearest one, or says why not.
  [[nodiscard]] const Parameter& find(std::string_view name) const;

  Planet planet;
  IsostasyParameters isostasy;
  ErosionParameters erosion;
  double uplift_factor = 1.0;  ///< speed_factor of the run's plates

 private:
  std::vector<Parameter> declarations_;
};

}  // namespace geo::calibration
