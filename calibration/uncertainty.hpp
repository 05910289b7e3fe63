#pragma once

#include "calibration/objective.hpp"
#include "calibration/result.hpp"

namespace geo::calibration {

/// Standard errors, correlations, directions and the spread over seeds at a minimum, into `result`:
///   cov = s2 (J^T J)^-1 in fitted scales, s2 = 2 cost / (residuals - parameters),
/// or 1 where the target's own deviations are larger than the residuals; seeds by the influence of
/// each on the minimum, (J^T J)^-1 J_s^T r_s (a delete-one jackknife, Wu 1986). Directions are the
/// right singular vectors of J. What is not determined gives warnings in words.
/// `objective` must have been routed and followed with a Jacobian at `x`.
void assess(const Objective& objective, const Problem& problem, const Eigen::VectorXd& x,
            const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, Result& result);

/// Profile likelihoods of the best and the worst determined parameter, with all held fast: one
/// parameter is moved to three standard errors on either side, the others follow along the
/// linear optimum, and the cost there is computed, not extrapolated.
void add_profiles(Objective& objective, Problem& problem, const Eigen::VectorXd& x,
                  const Eigen::MatrixXd& jacobian, Result& result);

}  // namespace geo::calibration
