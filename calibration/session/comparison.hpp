#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/objective.hpp"
#include "calibration/result.hpp"

namespace geo::calibration {

/// A curve of fine bins by a hundred points, or as many as there are bins where the target tells
/// of no more.
[[nodiscard]] Curve shown_curve(const Target& target, const std::vector<double>& fine);
/// The mean curve of several planets.
[[nodiscard]] Curve mean_curve(const Target& target, const std::vector<std::vector<double>>& fine);

/// Each free parameter before and after a fit.
[[nodiscard]] std::vector<FittedParameter> fitted_parameters(const Problem& problem,
                                                             const Eigen::VectorXd& start,
                                                             const Eigen::VectorXd& end);

/// Each figure to match before and after, as the mean over seeds, from the statistics of each.
[[nodiscard]] std::vector<Residual> residuals_of(const Problem& problem,
                                                 const std::vector<std::vector<double>>& before,
                                                 const std::vector<std::vector<double>>& after);

}  // namespace geo::calibration
