#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "calibration/objective.hpp"
#include "geo/core/error.hpp"
#include "geo/stages/isostasy/freeboard.hpp"

namespace geo::calibration {
namespace {

Term read_term(const Estimate& estimate) {
  static constexpr std::string_view kThickness = "crust_thickness_q";
  const std::string& name = estimate.name;
  if (name == "land_fraction") return {Term::Kind::land_fraction, 0.0, estimate, "1"};
  if (name == "water_volume_km3") return {Term::Kind::water_volume, 0.0, estimate, "km3"};
  if (name == "erosion_rate_mm_yr") return {Term::Kind::erosion_rate, 0.0, estimate, "mm yr-1"};
  if (name == "concavity") return {Term::Kind::concavity, 0.0, estimate, "1"};
  if (name.starts_with(kThickness) && name.ends_with("_km")) {
    int percent = 0;
    const char* const end = name.data() + name.size() - 3;
    const auto [stop, error] = std::from_chars(name.data() + kThickness.size(), end, percent);
    if (error == std::errc() && stop == end && percent > 0 && percent < 100) {
      return {Term::Kind::crust_thickness, 0.01 * percent, estimate, "km"};
    }
  }
  throw ConfigurationError(
      fmt::format("calibration.terms: {}: must be one of land_fraction, water_volume_km3, "
                  "erosion_rate_mm_yr, concavity, crust_thickness_q01_km to _q99_km",
                  name));
}

FreeParameter make_free(const Parameter& declaration, std::span<const Range> bounds,
                        std::span<const Estimate> priors) {
  FreeParameter free{declaration, declaration.min, declaration.max};
  const double start = *std::get<double*>(declaration.storage);
  for (const Range& range : bounds) {
    if (range.name != declaration.name) continue;
    if (range.low < declaration.min || range.high > declaration.max) {
      throw ConfigurationError(fmt::format("calibration.bounds: {} = {:g} .. {:g}: must lie in {}",
                                           range.name, range.low, range.high,
                                           declaration.range_text()));
    }
    free.low = range.low;
    free.high = range.high;
  }
  if (start < free.low || start > free.high) {
    throw ConfigurationError(
        fmt::format("calibration.bounds: {} = {:g} .. {:g}: must hold its start {:g}",
                    declaration.name, free.low, free.high, start));
  }
  free.logarithmic = free.low >= 0.0 && start > 0.0;
  const double width = free.high - free.low;
  free.scale = std::max(std::abs(start), std::isfinite(width) ? 0.05 * width : 1.0);
  // On a log scale the bound 0 lies at infinity.
  if (free.logarithmic) free.low = std::max(free.low, 1e-6 * start);
  for (const Estimate& prior : priors) {
    if (prior.name == declaration.name) free.prior = prior;
  }
  return free;
}

/// The parameters that are free where none is named. How high continents stand follows from the
/// depth of a sea that reaches onto them, else from how thick they are.
std::string six_parameters(std::span<const Parameter> configuration, const Model& model) {
  const Parameter* share = find_parameter(configuration, "plates.continental_share");
  const double continents = share != nullptr ? *std::get<double*>(share->storage) : 0.0;
  const bool settles = settles_continents(model.isostasy, model.planet) &&
                       model.planet.ocean_fraction > 1.0 - continents &&
                       model.planet.ocean_fraction < 1.0;
  return std::string(settles ? "isostasy.ocean_depth_m" : "isostasy.continental_km") +
         ", isostasy.collision_km, isostasy.swell_m, isostasy.margin_tilt_m, "
         "isostasy.ocean_swell_m, erosion.erodibility_factor";
}

/// A fit keeps the plates of each seed: what moves them too would make another planet of the fitted
/// configuration than the one that was judged.
void check_plates_stay(std::span<const Parameter> configuration, const Model& model,
                       std::string_view name) {
  const auto is = [&](std::string_view key, std::string_view value) {
    const Parameter* parameter = find_parameter(configuration, key);
    return parameter != nullptr && *std::get<std::string*>(parameter->storage) == value;
  };
  const bool shares_land = is("plates.model", "growth") && is("plates.continents", "plates");
  const bool floods = is("plates.model", "raster") && model.planet.sea_level == "fraction";
  const bool moves = name == "planet.radius_km" || name == "planet.flattening" ||
                     (name == "planet.gravity_m_s2" && is("plates.model", "sphere")) ||
                     (name == "planet.ocean_fraction" && (shares_land || floods));
  if (moves) {
    throw ConfigurationError(fmt::format(
        "calibration.free: {}: must be one that leaves the plates as they are: a fit keeps them",
        name));
  }
}

void check_known(std::string_view key, std::string_view name, std::span<const FreeParameter> free) {
  const bool known = std::any_of(free.begin(), free.end(), [&](const FreeParameter& parameter) {
    return parameter.declaration.name == name;
  });
  if (!known) {
    throw ConfigurationError(fmt::format("{}: {}: must be one of calibration.free", key, name));
  }
}

}  // namespace

double FreeParameter::to_x(double value) const {
  return logarithmic ? std::log(value) : value / scale;
}
double FreeParameter::to_value(double x) const {
  return std::clamp(logarithmic ? std::exp(x) : x * scale, low, high);
}
double FreeParameter::rate(double x) const { return logarithmic ? std::exp(x) : scale; }

Problem::Problem(std::span<const Parameter> configuration, const Settings& settings, Target aims)
    : model(configuration), target(std::move(aims)), every_seed(settings.objective == "each") {
  const auto bounds = read_ranges("calibration.bounds", settings.bounds);
  const auto priors = read_estimates("calibration.priors", settings.priors);
  const std::string names =
      settings.free == "auto" ? six_parameters(configuration, model) : settings.free;
  for (const std::string& name : read_names("calibration.free", names)) {
    free.push_back(make_free(model.find(name), bounds, priors));
    check_plates_stay(configuration, model, name);
  }
  if (free.empty()) throw ConfigurationError("calibration.free: must name a parameter");
  for (const Range& range : bounds) check_known("calibration.bounds", range.name, free);
  for (const Estimate& prior : priors) check_known("calibration.priors", prior.name, free);
  for (const Estimate& term : read_estimates("calibration.terms", settings.terms)) {
    terms.push_back(read_term(term));
  }
  if (statistics() < free.size()) {
    throw ConfigurationError(
        fmt::format("calibration.free: {} parameters for {} figures: must be fewer", free.size(),
                    statistics()));
  }
}

void Problem::set(const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    *std::get<double*>(free[i].declaration.storage) = free[i].to_value(x[Eigen::Index(i)]);
  }
}

Eigen::VectorXd Problem::present() const {
  Eigen::VectorXd x(free.size());
  for (std::size_t i = 0; i < free.size(); ++i) {
    x[Eigen::Index(i)] = free[i].to_x(*std::get<double*>(free[i].declaration.storage));
  }
  return x;
}

double Problem::deviation(std::size_t statistic) const {
  const std::size_t quantiles = target.share.size();
  return statistic >= quantiles ? terms[statistic - quantiles].target.deviation
                                : target.deviation_m[statistic];
}

double Problem::error(std::size_t statistic) const {
  const std::size_t quantiles = target.share.size();
  if (statistic >= quantiles) return terms[statistic - quantiles].target.deviation;
  return target.error_m.empty() ? 0.0 : target.error_m[statistic];
}

double Problem::aim(std::size_t statistic) const {
  const std::size_t quantiles = target.share.size();
  return statistic >= quantiles ? terms[statistic - quantiles].target.mean
                                : target.elevation_m[statistic];
}

}  // namespace geo::calibration
