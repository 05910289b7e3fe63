#include "calibration/uncertainty.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace geo::calibration {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Ratio of singular values beyond which rounding alone decides.
constexpr double kLargestCondition = 1e8;

/// "0.81 ln(isostasy.swell_m) - 0.55 erosion.warping_m / 25"
std::string in_words(const Problem& problem, const std::vector<double>& weights) {
  constexpr double kWorthNaming = 0.15;
  std::string words;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (std::abs(weights[i]) < kWorthNaming) continue;
    const FreeParameter& free = problem.free[i];
    words += fmt::format(
        "{}{:.2f} {}",
        words.empty() ? (weights[i] < 0 ? "-" : "") : (weights[i] < 0 ? " - " : " + "),
        std::abs(weights[i]),
        free.logarithmic ? fmt::format("ln({})", free.declaration.name)
                         : fmt::format("{} / {:.3g}", free.declaration.name, free.scale));
  }
  return words;
}

Eigen::VectorXd statistic_residual(const Objective& objective, const Problem& problem,
                                   std::size_t seed, const Eigen::VectorXd& centre) {
  Eigen::VectorXd residual(Eigen::Index(problem.statistics()));
  for (std::size_t k = 0; k < problem.statistics(); ++k) {
    residual[Eigen::Index(k)] =
        (objective.statistics()[seed][k] - centre[Eigen::Index(k)]) / problem.deviation(k);
  }
  return residual;
}

/// Covariance of the minimum that the choice of seeds alone brings about.
Eigen::MatrixXd seed_covariance(const Objective& objective, const Problem& problem,
                                const Eigen::MatrixXd& covariance) {
  const std::size_t seeds = objective.statistics().size();
  const auto count = Eigen::Index(problem.free.size());
  Eigen::VectorXd centre = Eigen::VectorXd::Zero(Eigen::Index(problem.statistics()));
  Eigen::VectorXd scale(centre.size());
  Eigen::MatrixXd mean_rate = Eigen::MatrixXd::Zero(centre.size(), count);
  for (std::size_t k = 0; k < problem.statistics(); ++k) {
    const auto row = Eigen::Index(k);
    scale[row] = problem.deviation(k);
    for (const auto& of_seed : objective.statistics()) centre[row] += of_seed[k];
    centre[row] = problem.every_seed ? problem.aim(k) : centre[row] / double(seeds);
  }
  for (const auto& rate : objective.seed_jacobians()) mean_rate += rate / double(seeds);
  std::vector<Eigen::VectorXd> influence;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(count);
  for (std::size_t s = 0; s < seeds; ++s) {
    const Eigen::MatrixXd& rate = problem.every_seed ? objective.seed_jacobians()[s] : mean_rate;
    const Eigen::VectorXd residual = statistic_residual(objective, problem, s, centre);
    influence.push_back(covariance * (scale.cwiseInverse().asDiagonal() * rate).transpose() *
                        residual / double(seeds));
    mean += influence.back() / double(seeds);
  }
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(count, count);
  for (const Eigen::VectorXd& of_seed : influence) {
    spread += (of_seed - mean) * (of_seed - mean).transpose();
  }
  return spread * double(seeds) / double(seeds - 1);
}

}  // namespace

void assess(const Objective& objective, const Problem& problem, const Eigen::VectorXd& x,
            const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, Result& result) {
  const auto count = Eigen::Index(problem.free.size());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  const double largest = singular[0];
  const double freedom = std::max<double>(1.0, double(jacobian.rows() - count));
  const bool has_deviations = !problem.target.deviation_m.empty();
  const double reduced = residual.squaredNorm() / freedom;
  const double variance = has_deviations ? std::max(1.0, reduced) : reduced;
  result.noise_m = std::sqrt(reduced) * problem.deviation_m;
  result.condition = singular[count - 1] > 0.0 ? largest / singular[count - 1]
                                               : std::numeric_limits<double>::infinity();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index d = 0; d < count; ++d) {
    const Eigen::VectorXd along = svd.matrixV().col(d);
    Direction direction{singular[d], {along.data(), along.data() + count}};
    if (singular[d] * kLargestCondition > largest) {
      inverse += along * along.transpose() / (singular[d] * singular[d]);
    }
    // One deviation along it is more than a change by a factor e, or by the whole scale.
    constexpr double kTooFar = 1.0;
    if (std::sqrt(variance) > kTooFar * singular[d]) {
      result.warnings.push_back(fmt::format("a combination is not determined by the target: {}",
                                            in_words(problem, direction.weights)));
    }
    result.directions.push_back(std::move(direction));
  }
  const Eigen::MatrixXd covariance = variance * inverse;
  const bool has_spread = objective.statistics().size() >= 3;
  const Eigen::MatrixXd spread =
      has_spread ? seed_covariance(objective, problem, inverse) : Eigen::MatrixXd();
  result.correlation.assign(count, std::vector<double>(count, 0.0));
  for (Eigen::Index i = 0; i < count; ++i) {
    const double rate = problem.free[i].rate(x[i]);
    FittedParameter& parameter = result.parameters[i];
    const bool known = singular[count - 1] * kLargestCondition > largest || covariance(i, i) > 0.0;
    parameter.standard_error = known ? rate * std::sqrt(covariance(i, i)) : kNone;
    parameter.seed_error = has_spread ? rate * std::sqrt(spread(i, i)) : kNone;
    for (Eigen::Index j = 0; j < count; ++j) {
      const double both = std::sqrt(covariance(i, i) * covariance(j, j));
      result.correlation[i][j] = i == j ? 1.0 : both > 0.0 ? covariance(i, j) / both : 0.0;
    }
  }
}

void add_profiles(Objective& objective, Problem& problem, const Eigen::VectorXd& x,
                  const Eigen::MatrixXd& jacobian, Result& result) {
  const auto count = Eigen::Index(problem.free.size());
  const auto relative_error = [&](Eigen::Index i) {
    const double error = result.parameters[i].standard_error / problem.free[i].rate(x[i]);
    return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
  };
  Eigen::Index best = 0, worst = 0;
  for (Eigen::Index i = 1; i < count; ++i) {
    if (relative_error(i) < relative_error(best)) best = i;
    if (relative_error(i) > relative_error(worst)) worst = i;
  }
  for (const Eigen::Index i : {best, worst}) {
    if (i == worst && worst == best && !result.profiles.empty()) break;
    // A direction without any bound is looked at within a factor e.
    const double reach = std::clamp(3.0 * relative_error(i), 1e-6, 1.0);
    Eigen::MatrixXd others(jacobian.rows(), std::max<Eigen::Index>(count - 1, 1));
    others.setZero();
    for (Eigen::Index j = 0, to = 0; j < count; ++j) {
      if (j != i) others.col(to++) = jacobian.col(j);
    }
    const Eigen::VectorXd follows =
        count > 1 ? Eigen::VectorXd(others.completeOrthogonalDecomposition().solve(jacobian.col(i)))
                  : Eigen::VectorXd();
    Profile profile;
    profile.name = problem.free[i].declaration.name;
    constexpr int kEachSide = 3;
    for (int k = -kEachSide; k <= kEachSide; ++k) {
      Eigen::VectorXd at = x;
      const double move = reach * k / kEachSide;
      at[i] += move;
      for (Eigen::Index j = 0, from = 0; j < count; ++j) {
        if (j != i) at[j] -= move * follows[from++];
      }
      profile.value.push_back(problem.free[i].to_value(at[i]));
      profile.cost.push_back(0.5 * objective.follow(at).squaredNorm());
    }
    result.profiles.push_back(std::move(profile));
  }
  problem.set(x);
}

}  // namespace geo::calibration
