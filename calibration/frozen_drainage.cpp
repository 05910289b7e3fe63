#include "calibration/frozen_drainage.hpp"

#include <ceres/ceres.h>

#include <algorithm>

namespace geo::calibration {
namespace {

/// The objective with drainage frozen, as Ceres sees it.
class FrozenCost final : public ceres::CostFunction {
 public:
  explicit FrozenCost(Objective& objective, Eigen::Index parameters) : objective_(objective) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters));
    set_num_residuals(static_cast<int>(objective.residuals()));
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const auto count = parameter_block_sizes().front();
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], count);
    const bool wants_rates = jacobians != nullptr && jacobians[0] != nullptr;
    const bool renews = wants_rates && rates_.size() == 0;
    const Eigen::VectorXd residual = objective_.linearise(x, renews ? &rates_ : nullptr);
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

}  // namespace

Eigen::VectorXd solve_with_frozen_drainage(Objective& objective, const Problem& problem,
                                           Eigen::VectorXd x,
                                           const FrozenDrainageOptions& options) {
  const auto count = static_cast<int>(x.size());
  if (options.fixed && count == 1) return x;
  ceres::Problem held;
  held.AddParameterBlock(x.data(), count);
  for (int i = 0; i < count; ++i) {
    const FreeParameter& free = problem.free[i];
    const double low = std::max(free.to_x(free.low), x[i] - options.reach);
    const double high = std::min(free.to_x(free.high), x[i] + options.reach);
    held.SetParameterLowerBound(x.data(), i, std::min(low, x[i]));
    held.SetParameterUpperBound(x.data(), i, std::max(high, x[i]));
  }
  if (options.fixed) {
    held.SetManifold(x.data(),
                     new ceres::SubsetManifold(count, {static_cast<int>(*options.fixed)}));
  }
  held.AddResidualBlock(new FrozenCost(objective, x.size()), nullptr, x.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.steps;
  solver.function_tolerance = options.tolerance;
  solver.initial_trust_region_radius = options.radius;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  // With bounds Ceres searches along each step, which takes two more Jacobians.
  solver.max_num_line_search_step_size_iterations = 0;
  solver.jacobi_scaling = false;  // the scales are set already
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &held, &summary);
  return x;
}

}  // namespace geo::calibration
