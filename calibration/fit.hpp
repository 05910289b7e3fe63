#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/objective.hpp"
#include "calibration/result.hpp"

namespace geo::calibration {

/// Where a fit from one starting point stands: enough to go on from, bit for bit.
struct FitState {
  Eigen::VectorXd x;
  double cost = 0.0;    ///< half the sum of squares at x, routed anew there
  double radius = 0.0;  ///< of the trust region, as Ceres has it
  int iteration = 0;
  int stalls = 0;  ///< iterations in a row that gained almost nothing
  bool begun = false, ended = false, converged = false;
  std::string ending;
};

struct FitOptions {
  int iterations = 20;
  double tolerance = 1e-3;
};

/// Levenberg-Marquardt (Ceres Solver) with the drainage held fast for a few steps at a time: route,
/// hold, solve, route again. A step is kept only if the cost with everything routed anew falls;
/// else half of it is tried, and the trust region shrinks. `after` is called after each iteration
/// with the state, and with the iteration for the record.
void fit(Objective& objective, Problem& problem, const FitOptions& options, FitState& state,
         const std::function<void(const FitState&, const Iteration&)>& after);

}  // namespace geo::calibration
