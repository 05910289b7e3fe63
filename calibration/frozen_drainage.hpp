#pragma once

#include <optional>

#include "calibration/objective.hpp"

namespace geo::calibration {

struct FrozenDrainageOptions {
  int steps = 2;        ///< of Levenberg-Marquardt at most
  double radius = 1e2;  ///< of the trust region, as Ceres has it
  /// How far a parameter may go: a factor 2, or its own scale times ln 2.
  double reach = 0.7;
  double tolerance = 1e-6;  ///< relative decrease of the cost that is too little to go on
  std::optional<Eigen::Index> fixed{};  ///< a parameter that stays where it is
};

/// A few steps of Levenberg-Marquardt (Ceres Solver) with all frozen as the last `evaluate` left
/// it, within the bounds, with the derivatives of the first place for all of them: one Jacobian,
/// and one evaluation a step. Returns where they end.
[[nodiscard]] Eigen::VectorXd solve_with_frozen_drainage(Objective& objective,
                                                         const Problem& problem, Eigen::VectorXd x,
                                                         const FrozenDrainageOptions& options);

}  // namespace geo::calibration
