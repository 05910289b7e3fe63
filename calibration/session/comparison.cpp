#include "calibration/session/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/session/starting_points.hpp"

namespace geo::calibration {

Curve shown_curve(const Target& target, const std::vector<double>& fine) {
  const int first = target.first_bin(), end = target.end_bin();
  const int points = std::min(100, end - first);
  const double each = static_cast<double>(end - first) / points;
  Curve curve{std::vector<double>(points, 0.0), double(first) / kFineBins, double(end) / kFineBins};
  for (int k = 0; k < points; ++k) {
    const double from = first + k * each, to = first + (k + 1) * each;
    for (int bin = static_cast<int>(from); bin < end && bin < to; ++bin) {
      const double part = std::min(to, bin + 1.0) - std::max(from, double(bin));
      curve.elevation_m[k] += fine[bin] * part / each;
    }
  }
  return curve;
}
Curve mean_curve(const Target& target, const std::vector<std::vector<double>>& fine) {
  std::vector<double> mean(kFineBins, 0.0);
  for (const auto& of_seed : fine) {
    for (int k = 0; k < kFineBins; ++k) mean[k] += of_seed[k] / static_cast<double>(fine.size());
  }
  return shown_curve(target, mean);
}

std::vector<FittedParameter> fitted_parameters(const Problem& problem, const Eigen::VectorXd& start,
                                               const Eigen::VectorXd& end) {
  std::vector<FittedParameter> parameters;
  const auto from = values_at(problem, start), to = values_at(problem, end);
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    const FreeParameter& free = problem.free[i];
    FittedParameter parameter;
    parameter.name = free.declaration.name;
    parameter.units = free.declaration.units;
    parameter.doc = free.declaration.doc;
    parameter.start = from[i];
    parameter.fitted = to[i];
    parameter.low = free.low;
    parameter.high = free.high;
    parameter.logarithmic = free.logarithmic;
    const double near = 1e-3 * std::max(std::abs(to[i]), 1e-3 * free.scale);
    parameter.at_bound = to[i] - free.low <= near || free.high - to[i] <= near;
    if (free.prior) {
      parameter.prior_mean = free.prior->mean;
      parameter.prior_deviation = free.prior->deviation;
    }
    parameters.push_back(parameter);
  }
  return parameters;
}

std::vector<Residual> residuals_of(const Problem& problem,
                                   const std::vector<std::vector<double>>& before,
                                   const std::vector<std::vector<double>>& after) {
  std::vector<Residual> residuals;
  const auto mean = [](const std::vector<std::vector<double>>& all, std::size_t k) {
    double sum = 0.0;
    for (const auto& of_seed : all) sum += of_seed[k];
    return sum / static_cast<double>(all.size());
  };
  const std::size_t quantiles = problem.target.share.size();
  for (std::size_t k = 0; k < problem.statistics(); ++k) {
    Residual residual;
    const bool is_quantile = k < quantiles;
    residual.name = is_quantile ? fmt::format("quantile {:.4g}", problem.target.share[k])
                                : problem.terms[k - quantiles].target.name;
    residual.units = is_quantile ? "m" : problem.terms[k - quantiles].units;
    residual.share =
        is_quantile ? problem.target.share[k] : std::numeric_limits<double>::quiet_NaN();
    residual.target = problem.aim(k);
    residual.before = mean(before, k);
    residual.after = mean(after, k);
    residual.deviation = problem.deviation(k);
    residuals.push_back(residual);
  }
  return residuals;
}

}  // namespace geo::calibration
