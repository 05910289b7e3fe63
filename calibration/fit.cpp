#include "calibration/fit.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "geo/core/error.hpp"

namespace geo::calibration {
namespace {

constexpr int kStepsHeldFast = 2;  // of Ceres between two routings
/// How far a parameter goes between two routings: a factor 2, or its own scale times ln 2.
constexpr double kReach = 0.7;
constexpr double kFirstRadius = 1e2, kLeastRadius = 1e-7, kMostRadius = 1e8;

/// The objective with all held fast as Ceres sees it.
class HeldFastCost final : public ceres::CostFunction {
 public:
  explicit HeldFastCost(Objective& objective, Eigen::Index parameters) : objective_(objective) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters));
    set_num_residuals(static_cast<int>(objective.residuals()));
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const auto count = parameter_block_sizes().front();
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], count);
    const bool wants_rates = jacobians != nullptr && jacobians[0] != nullptr;
    // Those of the first place serve the later steps too: routing anew changes more than they do.
    const bool renews = wants_rates && rates_.size() == 0;
    const Eigen::VectorXd residual = objective_.follow(x, renews ? &rates_ : nullptr);
    Eigen::Map<Eigen::VectorXd>(residuals, residual.size()) = residual;
    if (wants_rates) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[0], rates_.rows(), rates_.cols()) = rates_;
      return rates_.allFinite() && residual.allFinite();
    }
    return residual.allFinite();
  }

 private:
  Objective& objective_;
  mutable Eigen::MatrixXd rates_;
};

double cost_of(const Eigen::VectorXd& residual) {
  const double cost = 0.5 * residual.squaredNorm();
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

/// A few steps with all held fast. Returns where they end.
Eigen::VectorXd solve_held_fast(Objective& objective, const Problem& problem,
                                const FitState& state) {
  Eigen::VectorXd x = state.probed;
  const auto count = static_cast<int>(x.size());
  ceres::Problem held;
  held.AddParameterBlock(x.data(), count);
  for (int i = 0; i < count; ++i) {
    const FreeParameter& free = problem.free[i];
    const double low = std::max(free.to_x(free.low), x[i] - kReach);
    const double high = std::min(free.to_x(free.high), x[i] + kReach);
    held.SetParameterLowerBound(x.data(), i, std::min(low, x[i]));
    held.SetParameterUpperBound(x.data(), i, std::max(high, x[i]));
  }
  held.AddResidualBlock(new HeldFastCost(objective, x.size()), nullptr, x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kStepsHeldFast;
  options.initial_trust_region_radius = state.radius;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  // With bounds Ceres searches along each step, which takes two more Jacobians.
  options.max_num_line_search_step_size_iterations = 0;
  options.jacobi_scaling = false;  // the scales are set already
  ceres::Solver::Summary summary;
  ceres::Solve(options, &held, &summary);
  return x;
}

/// One Gauss-Newton step with derivatives by differences of planets routed anew, over a step wide
/// enough to average over the jumps of rivers. Returns whether it found a better place.
bool polish(Objective& objective, const Problem& problem, FitState& state) {
  constexpr std::array kSteps{0.02, 0.005, 0.05};
  const double width = kSteps[state.polishes % kSteps.size()];
  constexpr double kFarthest = 0.2;
  const Eigen::Index count = state.x.size();
  const Eigen::VectorXd here = objective.route(state.x);
  Eigen::MatrixXd rates(here.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FreeParameter& free = problem.free[i];
    Eigen::VectorXd x = state.x;
    const double step = x[i] + width > free.to_x(free.high) ? -width : width;
    x[i] += step;
    rates.col(i) = (objective.route(x) - here) / step;
  }
  Eigen::VectorXd step = -rates.completeOrthogonalDecomposition().solve(here);
  step *= std::min(1.0, kFarthest / std::max(step.cwiseAbs().maxCoeff(), 1e-300));
  for (double part = 1.0; part > 0.2; part *= 0.5) {
    Eigen::VectorXd x = state.x + part * step;
    for (Eigen::Index i = 0; i < count; ++i) {
      x[i] = std::clamp(x[i], problem.free[i].to_x(problem.free[i].low),
                        problem.free[i].to_x(problem.free[i].high));
    }
    const double cost = cost_of(objective.route(x));
    if (!(cost < state.cost)) continue;
    state.x = state.probed = x;
    state.cost = cost;
    state.distance_m = objective.distance_m();
    return true;
  }
  return false;
}

}  // namespace

void fit(Objective& objective, Problem& problem, const FitOptions& options, FitState& state,
         const std::function<void(const FitState&, const Iteration&)>& after) {
  using Clock = std::chrono::steady_clock;
  if (!state.begun) {
    state.radius = kFirstRadius;
    state.begun = true;
    state.cost = cost_of(objective.route(state.x));
    state.distance_m = objective.distance_m();
    state.probed = state.x;
  } else {
    objective.route(state.probed);
  }
  if (!std::isfinite(state.cost)) {
    throw InputError("calibration: the start gives a relief that is not finite");
  }
  while (!state.ended) {
    const auto begin = Clock::now();
    const Eigen::VectorXd from = state.probed, best = state.x;
    const double before = state.cost;
    const Eigen::VectorXd to = solve_held_fast(objective, problem, state);
    double part = 1.0, full_cost = 0.0;
    bool accepted = false;
    constexpr double kLeastPart = 0.2;
    while (!accepted && part > kLeastPart && (to - from).cwiseAbs().maxCoeff() > 0.0) {
      const Eigen::VectorXd x = from + part * (to - from);
      const double cost = cost_of(objective.route(x));
      if (part == 1.0) full_cost = cost;
      accepted = cost < before;
      if (accepted) {
        state.x = state.probed = x;
        state.cost = cost;
        state.distance_m = objective.distance_m();
        state.probes = 0;
      } else {
        part *= 0.5;
      }
    }
    if (!accepted) {
      constexpr int kProbes = 2;
      constexpr double kNotMuchWorse = 4.0;
      const bool goes_on =
          state.probes < kProbes && full_cost > 0.0 && full_cost < kNotMuchWorse * before;
      state.probes = goes_on ? state.probes + 1 : 0;
      state.probed = goes_on ? to : best;
      objective.route(state.probed);
      if (!goes_on) state.radius = std::max(0.03 * state.radius, kLeastRadius);
    } else {
      state.radius =
          std::clamp(state.radius * (part == 1.0 ? 3.0 : 0.5), kLeastRadius, kMostRadius);
    }
    ++state.iteration;
    const double gain = (before - state.cost) / std::max(before, 1e-300);
    state.stalls = gain < options.tolerance ? state.stalls + 1 : 0;
    constexpr int kPatience = 3;
    // Where the target can be met, no jump of a river shall keep the fit from it.
    const bool is_close = state.cost < 0.005 * static_cast<double>(objective.residuals());
    const int attempts = is_close ? 3 : 1;
    if (state.stalls >= kPatience && state.polishes < attempts) {
      const double unpolished = state.cost;
      accepted = polish(objective, problem, state);
      const bool gained = unpolished - state.cost > options.tolerance * unpolished;
      state.polishes = gained ? 0 : state.polishes + 1;
      // Polished again unless the next iteration gains by itself.
      state.stalls = gained || state.polishes < attempts ? kPatience - 1 : kPatience;
      state.probes = 0;
      state.probed = state.x;
      objective.route(state.x);
    }
    const double step = (state.x - best).cwiseAbs().maxCoeff();
    // A cost of nothing is as far as a fit can go.
    const double nothing = 1e-10 * static_cast<double>(objective.residuals());
    if (state.cost <= nothing || state.stalls >= kPatience) {
      state.ended = state.converged = true;
      state.ending =
          state.cost <= nothing
              ? "the target is met"
              : fmt::format("the cost fell by less than {:g} of itself", options.tolerance);
    } else if (state.iteration >= options.iterations) {
      state.ended = true;
      state.ending =
          fmt::format("{} iterations did not suffice (calibration.iterations)", options.iterations);
    }
    Iteration record;
    record.number = state.iteration;
    record.cost = state.cost;
    record.step = step;
    record.accepted = accepted;
    record.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    record.wasserstein_m = state.distance_m;
    for (std::size_t i = 0; i < problem.free.size(); ++i) {
      record.values.push_back(problem.free[i].to_value(state.x[Eigen::Index(i)]));
    }
    after(state, record);
  }
  problem.set(state.x);
}

}  // namespace geo::calibration
