#include "calibration/model.hpp"

#include <fmt/format.h>

#include "geo/core/error.hpp"
#include "geo/stages/erosion/ground.hpp"

namespace geo::calibration {
namespace {

void check_differentiable(const IsostasyParameters& isostasy, const ErosionParameters& erosion) {
  const auto refuse = [](std::string_view name, std::string_view value, std::string_view wanted) {
    throw ConfigurationError(
        fmt::format("{} = {}: must be {} in a calibration", name, value, wanted));
  };
  if (isostasy.crust != "margins") refuse("isostasy.crust", isostasy.crust, "margins");
  if (erosion.hypsometry != "none") {
    refuse("erosion.hypsometry", erosion.hypsometry,
           "none (a remap of heights hides what the parameters do)");
  }
  if (erosion.land_smoothing_km > 0.0) {
    refuse("erosion.land_smoothing_km", fmt::format("{:g}", erosion.land_smoothing_km), "0");
  }
  if (erosion.detail_noise > 0.0) {
    refuse("erosion.detail_noise", fmt::format("{:g}", erosion.detail_noise), "0");
  }
}

}  // namespace

Model::Model(std::span<const Parameter> configuration) {
  std::vector<Parameter> all = planet.parameters();
  for (auto more : {isostasy.declarations(), erosion.declarations()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  for (const Parameter& parameter : all) {
    const Parameter* given = find_parameter(configuration, parameter.name);
    if (given == nullptr) {
      throw Bug(fmt::format("calibration: no declaration of {}", parameter.name));
    }
    parameter.set(given->value());
    if (std::holds_alternative<double*>(parameter.storage)) declarations_.push_back(parameter);
  }
  // The climate of each trial would cost more than all the rest.
  erosion.discharge = "area";
  check_differentiable(isostasy, erosion);
  uplift_factor = speed_factor(erosion, configuration);
}

const Parameter& Model::find(std::string_view name) const {
  if (const Parameter* found = find_parameter(declarations_, name)) return *found;
  std::vector<std::string_view> names;
  for (const Parameter& parameter : declarations_) names.push_back(parameter.name);
  const std::string near = nearest_word(name, names);
  throw ConfigurationError(fmt::format(
      "calibration.free: {}: must be a real-valued parameter of planet, isostasy or erosion{}",
      name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

}  // namespace geo::calibration
