#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/objective.hpp"
#include "calibration/result.hpp"

namespace geo::calibration {

/// Where a fit from one starting point stands: enough to go on from, bit for bit.
struct FitState {
  Eigen::VectorXd x;        ///< the best so far
  double cost = 0.0;        ///< half the sum of squares there, rerouted
  double distance_m = 0.0;  ///< mean Wasserstein-1 distance there
  Eigen::VectorXd probed;   ///< where the next iteration begins
  double radius = 0.0;      ///< of the trust region, as Ceres has it
  int iteration = 0;
  int stalls = 0;    ///< iterations in a row that gained almost nothing
  int probes = 0;    ///< steps in a row that went on from a place no better than the best
  int polishes = 0;  ///< failed attempts in a row by differences of routed planets
  bool begun = false, ended = false, converged = false;
  std::string ending;
};

struct FitOptions {
  int iterations = 20;
  double tolerance = 1e-3;
};

/// Levenberg-Marquardt (Ceres Solver) with the drainage frozen for a few steps at a time: reroute,
/// freeze, solve, reroute. A step counts only if the cost with everything rerouted falls, else
/// half of it is tried. Where no part of it is better, routing may have jumped: the fit goes on
/// from the step's end up to twice, then back to the best place within a smaller trust region.
/// Derivatives with frozen drainage know nothing of rivers that move, so such a fit may settle
/// beside the minimum: in the end steps are taken along differences of planets rerouted, as long
/// as they gain. `after` is called after each iteration with the state and a record of it.
void fit(Objective& objective, Problem& problem, const FitOptions& options, FitState& state,
         const std::function<void(const FitState&, const Iteration&)>& after);

}  // namespace geo::calibration
