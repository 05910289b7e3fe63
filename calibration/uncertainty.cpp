#include "calibration/uncertainty.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/frozen_drainage.hpp"

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

/// Derivatives of the residuals with rivers, coasts and the level of the sea following, by central
/// differences, one-sided at a bound; `frozen` where a parameter cannot move. Over the distance of
/// an error they differ from those with drainage frozen by a tenth to a half. Leaves `objective`
/// evaluated at `x`.
Eigen::MatrixXd rerouted_rates(Objective& objective, const Problem& problem,
                               const Eigen::VectorXd& x, Eigen::MatrixXd frozen) {
  // In fitted scales: over less, single rivers would be seen that jump; over more, bends.
  constexpr double kReach = 0.03;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& free = problem.free[i];
    Eigen::VectorXd below = x, above = x;
    below[i] = std::max(x[i] - kReach, free.to_x(free.low));
    above[i] = std::min(x[i] + kReach, free.to_x(free.high));
    if (!(above[i] > below[i])) continue;
    const Eigen::VectorXd there = objective.evaluate(below);
    frozen.col(i) = (objective.evaluate(above) - there) / (above[i] - below[i]);
  }
  objective.evaluate(x);
  return frozen;
}

/// How the fitted values follow the target. The fit ends where F^T r = 0 with the derivatives F of
/// frozen drainage, while the residuals r follow the parameters by those of the model itself, R:
/// F^T (r + R dx) = 0, so dx = -(F^T R)^-1 F^T r, an estimator by instrumental variables.
Eigen::MatrixXd gain_of_fit(const Eigen::MatrixXd& frozen, const Eigen::MatrixXd& rerouted) {
  const Eigen::MatrixXd both = frozen.transpose() * rerouted;
  return both.completeOrthogonalDecomposition().pseudoInverse() * frozen.transpose();
}

}  // namespace

void assess(Objective& objective, const Problem& problem, const Eigen::VectorXd& x,
            const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, Result& result) {
  const auto count = Eigen::Index(problem.free.size());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  const double largest = singular[0];
  const double freedom = std::max<double>(1.0, double(jacobian.rows() - count));
  const double reduced = residual.squaredNorm() / freedom;
  const Eigen::VectorXd variance = objective.known_variance().cwiseMax(reduced);
  result.noise_m = objective.misfit_m(residual) * std::sqrt(double(jacobian.rows()) / freedom);
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
    const double error = std::sqrt(svd.matrixU().col(d).cwiseAbs2().dot(variance));
    if (error > kTooFar * singular[d]) {
      result.warnings.push_back(fmt::format("a combination is not determined by the target: {}",
                                            in_words(problem, direction.weights)));
    }
    result.directions.push_back(std::move(direction));
  }
  const auto covariance_by = [&](const Eigen::MatrixXd& gain) -> Eigen::MatrixXd {
    return gain * variance.asDiagonal() * gain.transpose();
  };
  const Eigen::MatrixXd frozen = covariance_by(inverse * jacobian.transpose());
  const Eigen::MatrixXd rerouted = rerouted_rates(objective, problem, x, jacobian);
  const Eigen::MatrixXd covariance = covariance_by(gain_of_fit(jacobian, rerouted));
  const bool has_spread = objective.statistics().size() >= 3;
  const Eigen::MatrixXd spread =
      has_spread ? seed_covariance(objective, problem, inverse) : Eigen::MatrixXd();
  result.correlation.assign(count, std::vector<double>(count, 0.0));
  for (Eigen::Index i = 0; i < count; ++i) {
    const double rate = problem.free[i].rate(x[i]);
    FittedParameter& parameter = result.parameters[i];
    const bool known = singular[count - 1] * kLargestCondition > largest || frozen(i, i) > 0.0;
    parameter.standard_error = known ? rate * std::sqrt(covariance(i, i)) : kNone;
    parameter.seed_error = has_spread ? rate * std::sqrt(spread(i, i)) : kNone;
    for (Eigen::Index j = 0; j < count; ++j) {
      const double both = std::sqrt(covariance(i, i) * covariance(j, j));
      result.correlation[i][j] = i == j ? 1.0 : both > 0.0 ? covariance(i, j) / both : 0.0;
    }
  }
}

namespace {

/// The place from `guess` on where all but parameter `i` are at their optimum, with drainage
/// frozen: steps with the derivatives of one place each, from anew until the cost no longer falls.
Eigen::VectorXd refit_others(Objective& objective, const Problem& problem, Eigen::Index i,
                             Eigen::VectorXd guess, double& cost) {
  constexpr int kRounds = 4, kSteps = 3;
  constexpr double kWorthwhile = 1e-3;
  cost = 0.5 * objective.linearise(guess).squaredNorm();
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd to = solve_with_frozen_drainage(
        objective, problem, guess,
        {.steps = kSteps, .radius = 1e4, .tolerance = kWorthwhile, .fixed = i});
    const double there = 0.5 * objective.linearise(to).squaredNorm();
    if (!(there < cost)) break;
    const bool settled = cost - there < kWorthwhile * cost;
    guess = to;
    cost = there;
    if (settled) break;
  }
  return guess;
}

/// What one side of a profile holds, from the fitted value outwards.
struct Side {
  std::vector<Eigen::VectorXd> place;
  std::vector<double> cost;
};

Side walk(Objective& objective, const Problem& problem, Eigen::Index i, double step, int points,
          const Eigen::VectorXd& from, const Eigen::VectorXd& along) {
  const FreeParameter& free = problem.free[i];
  const double low = free.to_x(free.low), high = free.to_x(free.high);
  Side side;
  Eigen::VectorXd here = from, rate = along;
  for (int k = 0; k < points; ++k) {
    const double to = std::clamp(here[i] + step, low, high);
    if (to == here[i]) break;  // at its bound
    // Where the others went from the last point to this one, they will go on to.
    Eigen::VectorXd guess = here + (to - here[i]) * rate;
    for (Eigen::Index j = 0; j < guess.size(); ++j) {
      guess[j] = std::clamp(guess[j], problem.free[j].to_x(problem.free[j].low),
                            problem.free[j].to_x(problem.free[j].high));
    }
    guess[i] = to;
    double cost = 0.0;
    const Eigen::VectorXd there = refit_others(objective, problem, i, guess, cost);
    rate = (there - here) / (to - here[i]);
    here = there;
    side.place.push_back(here);
    side.cost.push_back(cost);
  }
  return side;
}

}  // namespace

Profile profile_of(Objective& objective, const Problem& problem, const Eigen::VectorXd& x,
                   const Eigen::MatrixXd& jacobian, Eigen::Index i, double reach) {
  constexpr int kEachSide = 3;
  const Eigen::Index count = x.size();
  // How the others follow a small change: along the linear optimum.
  Eigen::MatrixXd others = jacobian;
  others.col(i).setZero();
  Eigen::VectorXd along = -others.completeOrthogonalDecomposition().solve(jacobian.col(i));
  along[i] = 1.0;
  if (count == 1) along.setOnes();
  double cost = 0.0;
  const Eigen::VectorXd middle = refit_others(objective, problem, i, x, cost);
  const double step = reach / kEachSide;
  const Side below = walk(objective, problem, i, -step, kEachSide, middle, along);
  const Side above = walk(objective, problem, i, step, kEachSide, middle, along);
  Profile profile;
  profile.name = problem.free[i].declaration.name;
  const auto add = [&](const Eigen::VectorXd& at, double cost_there) {
    profile.value.push_back(problem.free[i].to_value(at[i]));
    profile.cost.push_back(cost_there);
    auto& fitted = profile.fitted.emplace_back();
    for (Eigen::Index j = 0; j < count; ++j) fitted.push_back(problem.free[j].to_value(at[j]));
  };
  for (std::size_t k = below.place.size(); k-- > 0;) add(below.place[k], below.cost[k]);
  add(middle, cost);
  for (std::size_t k = 0; k < above.place.size(); ++k) add(above.place[k], above.cost[k]);
  return profile;
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
  // A direction without any bound is looked at within a factor e.
  const auto reach = [&](Eigen::Index i) { return std::clamp(3.0 * relative_error(i), 1e-6, 1.0); };
  result.profiles.push_back(profile_of(objective, problem, x, jacobian, best, reach(best)));
  if (worst != best) {
    result.profiles.push_back(profile_of(objective, problem, x, jacobian, worst, reach(worst)));
  }
  problem.set(x);
}

}  // namespace geo::calibration
