#include "calibration/report/report_json.hpp"

#include <nlohmann/json.hpp>

#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/run/manifest.hpp"

namespace geo::calibration {
namespace {

// JSON has no NaN and no infinity: the library writes null for both.
using Json = nlohmann::ordered_json;

template <class Items, class Writer>
Json list_of(const Items& items, const Writer& writer) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(writer(item));
  return list;
}

Json parameter_json(const FittedParameter& parameter) {
  Json json{{"name", parameter.name},
            {"units", parameter.units},
            {"doc", parameter.doc},
            {"start", parameter.start},
            {"fitted", parameter.fitted}};
  json["bounds"] = {parameter.low, parameter.high};
  json["at_bound"] = parameter.at_bound;
  json["scale"] = parameter.logarithmic ? "logarithmic" : "linear";
  json["standard_error"] = parameter.standard_error;
  json["seed_error"] = parameter.seed_error;
  json["prior"] = nullptr;
  if (parameter.prior_deviation > 0.0) {
    json["prior"] = {{"mean", parameter.prior_mean}, {"deviation", parameter.prior_deviation}};
  }
  return json;
}

Json residual_json(const Residual& residual) {
  return {{"name", residual.name},          {"units", residual.units},   {"share", residual.share},
          {"target", residual.target},      {"before", residual.before}, {"after", residual.after},
          {"deviation", residual.deviation}};
}

Json misfits_json(const std::vector<SeedMisfit>& seeds, const SeedSpread& spread) {
  const auto one = [](const SeedMisfit& seed) {
    return Json{{"seed", seed.seed}, {"before_m", seed.before_m}, {"after_m", seed.after_m}};
  };
  return {{"mean_before_m", mean_before_m(seeds)}, {"mean_after_m", mean_after_m(seeds)},
          {"spread_before_m", spread.before_m},    {"spread_after_m", spread.after_m},
          {"collapsed", has_collapsed(spread)},    {"seeds", list_of(seeds, one)}};
}

Json iteration_json(const Iteration& iteration) {
  return {{"start", iteration.start},   {"number", iteration.number},
          {"cost", iteration.cost},     {"wasserstein_m", iteration.wasserstein_m},
          {"step", iteration.step},     {"accepted", iteration.accepted},
          {"values", iteration.values}, {"seconds", io::time_is_given() ? 0.0 : iteration.seconds}};
}

Json start_json(const Start& start) {
  return {{"from", start.from},
          {"to", start.to},
          {"cost", start.cost},
          {"converged", start.converged},
          {"iterations", start.iterations},
          {"ending", start.ending}};
}

Json direction_json(const Direction& direction) {
  return {{"singular_value", direction.singular_value}, {"weights", direction.weights}};
}

Json profile_json(const Profile& profile) {
  return {{"name", profile.name},
          {"value", profile.value},
          {"cost", profile.cost},
          {"fitted", profile.fitted}};
}

Json curves_json(const Result& result) {
  return {{"share_from", result.target.share_from},
          {"share_to", result.target.share_to},
          {"target_m", result.target.elevation_m},
          {"before_m", result.before.elevation_m},
          {"after_m", result.after.elevation_m}};
}

/// True times are left out where a file must come out the same twice.
Json effort_json(const Result& result) {
  const double measured = io::time_is_given() ? 0.0 : 1.0;
  return {{"seconds", measured * result.seconds},
          {"forward_runs", result.forward_runs},
          {"jacobians", result.jacobians},
          {"seconds_per_forward", measured * result.seconds_per_forward},
          {"seconds_per_jacobian", measured * result.seconds_per_jacobian},
          {"profile_seconds", measured * result.profile_seconds}};
}

Json program_json() {
  const auto& build = io::build_info();
  return {{"version", build.version},
          {"commit", build.commit},
          {"compiler", build.compiler},
          {"libraries", io::library_versions()}};
}

}  // namespace

std::string json_text(const Result& result) {
  Json json{{"target", result.target_name},  {"configuration", result.preset_or_config},
            {"grid", result.grid},           {"held_out_grid", result.held_out_grid},
            {"objective", result.objective}, {"converged", result.converged},
            {"ending", result.ending},       {"warnings", result.warnings}};
  json["parameters"] = list_of(result.parameters, parameter_json);
  json["correlation"] = result.correlation;
  json["condition"] = result.condition;
  json["directions"] = list_of(result.directions, direction_json);
  json["profiles"] = list_of(result.profiles, profile_json);
  json["cost_before"] = result.cost_before;
  json["cost_after"] = result.cost_after;
  json["noise_m"] = result.noise_m;
  json["misfit"] = {{"fitted", misfits_json(result.fitted, result.fitted_spread)},
                    {"held_out", misfits_json(result.held_out, result.held_out_spread)},
                    {"held_out_resolution",
                     misfits_json(result.held_out_resolution, result.held_out_resolution_spread)}};
  json["hypsometry"] = curves_json(result);
  json["residuals"] = list_of(result.residuals, residual_json);
  json["iterations"] = list_of(result.iterations, iteration_json);
  json["starts"] = list_of(result.starts, start_json);
  json["effort"] = effort_json(result);
  json["program"] = program_json();
  json["written_by"] = list_of(result.builders, [](const io::Builder& builder) {
    return Json{{"version", builder.version}, {"commit", builder.commit}, {"build", builder.id}};
  });
  // Bytes that are no UTF-8 (in a path, say) are replaced: no reason to lose a finished fit.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace geo::calibration
