#pragma once

#include "calibration/objective.hpp"
#include "calibration/result.hpp"

namespace geo::calibration {

/// Standard errors, correlations, directions and the spread over seeds at a minimum, into `result`:
///   cov = G diag(v) G^T,  G = (J^T R)^-1 J^T,  v_r = max(s2, e_r^2)
/// in fitted scales, with s2 = 2 cost / (residuals - parameters), what the residuals show, and e_r
/// the error to which the figure of residual r is known, over its deviation: that of a quantile
/// where the target or calibration.error_m says it, of terms and priors their deviation. It is the
/// same for targets of every kind. J: `jacobian`, with drainage frozen; R: central differences over
/// 6 % of planets routed anew. The fit ends where J^T r = 0, and r follows the parameters by R, as
/// where J holds instrumental variables. Seeds by the influence of each on the minimum,
/// (J^T J)^-1 J_s^T r_s (a delete-one jackknife, Wu 1986). Directions are the right
/// singular vectors of J. What is not determined gives warnings in words.
/// `objective` must have been evaluated and linearised with a Jacobian at `x`, and is left
/// evaluated there.
void assess(Objective& objective, const Problem& problem, const Eigen::VectorXd& x,
            const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, Result& result);

/// Profile likelihood of parameter `i` about `x`, with all frozen as the last `evaluate` left it:
/// it is moved in three steps of a third of `reach` to either side, as far as its bounds allow, and
/// at each place all others are fitted again from the last one on. At most four Jacobians and 17
/// evaluations a place, most often two and seven.
[[nodiscard]] Profile profile_of(Objective& objective, const Problem& problem,
                                 const Eigen::VectorXd& x, const Eigen::MatrixXd& jacobian,
                                 Eigen::Index i, double reach);

/// Profiles of the best and the worst determined parameter, to three standard errors on either
/// side.
void add_profiles(Objective& objective, Problem& problem, const Eigen::VectorXd& x,
                  const Eigen::MatrixXd& jacobian, Result& result);

}  // namespace geo::calibration
