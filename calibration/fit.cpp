#include "calibration/fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "calibration/frozen_drainage.hpp"
#include "geo/core/error.hpp"

namespace geo::calibration {
namespace {

constexpr int kStepsFrozen = 2;  // of Ceres between two routings
/// Cost below which the target is met: whatever is left, chi squared = 0.1 at most, can move no
/// parameter by more than a third of the standard error that the deviations stand for.
constexpr double kMetCost = 0.05;
constexpr double kFirstRadius = 1e2, kLeastRadius = 1e-7, kMostRadius = 1e8;

double cost_of(const Eigen::VectorXd& residual) {
  const double cost = 0.5 * residual.squaredNorm();
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

/// How far to move each parameter for differences: as far as moves the residuals by about what is
/// left of them, so that rivers jump no more than they do on the way that is left.
Eigen::VectorXd difference_widths(Objective& objective, const Eigen::VectorXd& x,
                                  const Eigen::VectorXd& residual, double factor) {
  constexpr double kLeast = 1e-4, kMost = 0.05;
  Eigen::MatrixXd rates;
  objective.linearise(x, &rates);
  Eigen::VectorXd width(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double rate = std::max(rates.col(i).norm(), 1e-300);
    width[i] = std::clamp(factor * residual.norm() / rate, kLeast, kMost);
  }
  return width;
}

/// One Gauss-Newton step with derivatives by differences of planets rerouted, central where bounds
/// allow it, over steps wide enough to average over the jumps of rivers. Returns whether it found a
/// better place.
bool polish(Objective& objective, const Problem& problem, FitState& state) {
  constexpr std::array kFactors{1.0, 0.5, 2.0};
  constexpr double kFarthest = 0.2;
  const Eigen::Index count = state.x.size();
  const Eigen::VectorXd here = objective.evaluate(state.x);
  const Eigen::VectorXd width =
      difference_widths(objective, state.x, here, kFactors[state.polishes % kFactors.size()]);
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(here.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FreeParameter& free = problem.free[i];
    Eigen::VectorXd below = state.x, above = state.x;
    below[i] = std::max(below[i] - width[i], free.to_x(free.low));
    above[i] = std::min(above[i] + width[i], free.to_x(free.high));
    if (!(above[i] > below[i])) continue;
    rates.col(i) = (objective.evaluate(above) - objective.evaluate(below)) / (above[i] - below[i]);
  }
  Eigen::VectorXd step = -rates.completeOrthogonalDecomposition().solve(here);
  step *= std::min(1.0, kFarthest / std::max(step.cwiseAbs().maxCoeff(), 1e-300));
  for (double part = 1.0; part > 0.2; part *= 0.5) {
    Eigen::VectorXd x = state.x + part * step;
    for (Eigen::Index i = 0; i < count; ++i) {
      x[i] = std::clamp(x[i], problem.free[i].to_x(problem.free[i].low),
                        problem.free[i].to_x(problem.free[i].high));
    }
    const double cost = cost_of(objective.evaluate(x));
    if (!(cost < state.cost)) continue;
    state.x = state.probed = x;
    state.cost = cost;
    state.distance_m = objective.distance_m();
    return true;
  }
  return false;
}

/// The cost of the start, or the routes of where a fit that goes on was.
void begin(Objective& objective, FitState& state) {
  if (state.begun) {
    objective.evaluate(state.probed);
  } else {
    state.radius = kFirstRadius;
    state.begun = true;
    state.cost = cost_of(objective.evaluate(state.x));
    state.distance_m = objective.distance_m();
    state.probed = state.x;
  }
  if (!std::isfinite(state.cost)) {
    throw InputError("calibration: the start gives elevations that are not finite");
  }
}

/// How far along a step the cost falls.
struct LineSearch {
  bool found = false;
  double part = 1.0;       // of the step
  double full_cost = 0.0;  // of all of it; 0 where there is none
};

LineSearch search_line(Objective& objective, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                       FitState& state) {
  constexpr double kLeastPart = 0.2;
  const double before = state.cost;
  LineSearch search;
  while (!search.found && search.part > kLeastPart && (to - from).cwiseAbs().maxCoeff() > 0.0) {
    const Eigen::VectorXd x = from + search.part * (to - from);
    const double cost = cost_of(objective.evaluate(x));
    if (search.part == 1.0) search.full_cost = cost;
    search.found = cost < before;
    if (search.found) {
      state.x = state.probed = x;
      state.cost = cost;
      state.distance_m = objective.distance_m();
      state.probes = 0;
    } else {
      search.part *= 0.5;
    }
  }
  return search;
}

/// Where no part of a step is better, the next one begins at its end if that is not much worse, a
/// few times, and else at the best place with a smaller radius.
void probe(Objective& objective, const Eigen::VectorXd& to, double full_cost, FitState& state) {
  constexpr int kProbes = 2;
  constexpr double kNotMuchWorse = 4.0;
  const bool goes_on =
      state.probes < kProbes && full_cost > 0.0 && full_cost < kNotMuchWorse * state.cost;
  state.probes = goes_on ? state.probes + 1 : 0;
  state.probed = goes_on ? to : state.x;
  objective.evaluate(state.probed);
  if (!goes_on) state.radius = std::max(0.03 * state.radius, kLeastRadius);
}

/// One step with frozen drainage. Returns whether it found a better place.
bool descend(Objective& objective, Problem& problem, FitState& state) {
  const Eigen::VectorXd from = state.probed;
  const Eigen::VectorXd to = solve_with_frozen_drainage(
      objective, problem, state.probed, {.steps = kStepsFrozen, .radius = state.radius});
  const LineSearch search = search_line(objective, from, to, state);
  if (search.found) {
    state.radius =
        std::clamp(state.radius * (search.part == 1.0 ? 3.0 : 0.5), kLeastRadius, kMostRadius);
  } else {
    probe(objective, to, search.full_cost, state);
  }
  return search.found;
}

/// Iterations that gain next to nothing before a fit polishes or ends.
constexpr int kPatience = 3;

/// Counts iterations that gained next to nothing; after a few of them, polishes. Returns whether
/// the iteration has found a better place by then.
bool polish_where_stalled(Objective& objective, const Problem& problem, const FitOptions& options,
                          double before, bool accepted, FitState& state) {
  const double worthwhile = options.tolerance * std::max(before, kMetCost);
  state.stalls = before - state.cost < worthwhile ? state.stalls + 1 : 0;
  // Where the target can be met, no jump of a river shall keep the fit from it.
  const bool is_close = state.cost < 0.005 * static_cast<double>(objective.residuals());
  const int attempts = is_close ? 3 : 1;
  if (state.stalls < kPatience || state.polishes >= attempts) return accepted;
  const double unpolished = state.cost;
  accepted = polish(objective, problem, state);
  const bool gained = unpolished - state.cost > options.tolerance * std::max(unpolished, kMetCost);
  state.polishes = gained ? 0 : state.polishes + 1;
  // Polished again unless the next iteration gains by itself.
  state.stalls = gained || state.polishes < attempts ? kPatience - 1 : kPatience;
  state.probes = 0;
  state.probed = state.x;
  objective.evaluate(state.x);
  return accepted;
}

void end_where_done(const Objective& objective, const FitOptions& options, FitState& state) {
  // A cost of nothing is as far as a fit can go.
  const double nothing = 1e-10 * static_cast<double>(objective.residuals());
  const bool is_met = state.cost <= kMetCost;
  if (state.cost > nothing && state.stalls < kPatience && state.iteration < options.iterations) {
    return;
  }
  state.ended = true;
  state.converged = is_met || state.stalls >= kPatience;
  state.ending = state.cost <= nothing ? "the target is met"
                 : is_met ? fmt::format("the target is met to {:.2g} of its deviations",
                                        std::sqrt(2.0 * state.cost / double(objective.residuals())))
                 : state.converged
                     ? fmt::format("the cost fell by less than {:g} of itself", options.tolerance)
                     : fmt::format("{} iterations did not suffice (calibration.iterations)",
                                   options.iterations);
}

}  // namespace

void fit(Objective& objective, Problem& problem, const FitOptions& options, FitState& state,
         const std::function<void(const FitState&, const Iteration&)>& after) {
  using Clock = std::chrono::steady_clock;
  begin(objective, state);
  while (!state.ended) {
    const auto start = Clock::now();
    const Eigen::VectorXd best = state.x;
    const double before = state.cost;
    bool accepted = descend(objective, problem, state);
    ++state.iteration;
    accepted = polish_where_stalled(objective, problem, options, before, accepted, state);
    end_where_done(objective, options, state);
    Iteration record;
    record.number = state.iteration;
    record.cost = state.cost;
    record.step = (state.x - best).cwiseAbs().maxCoeff();
    record.accepted = accepted;
    record.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    record.wasserstein_m = state.distance_m;
    for (std::size_t i = 0; i < problem.free.size(); ++i) {
      record.values.push_back(problem.free[i].to_value(state.x[Eigen::Index(i)]));
    }
    after(state, record);
  }
  problem.set(state.x);
}

}  // namespace geo::calibration
