#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/objective.hpp"
#include "calibration/result.hpp"

namespace geo::calibration {

/// The configuration itself, then random places within the bounds or within a factor 2 of it.
[[nodiscard]] std::vector<Eigen::VectorXd> starting_points(const Problem& problem,
                                                           std::int64_t count);

/// Values of the free parameters at x.
[[nodiscard]] std::vector<double> values_at(const Problem& problem, const Eigen::VectorXd& x);

/// How many fits ended as well as the best one, but elsewhere: other minima as good.
[[nodiscard]] int equally_good_elsewhere(const Problem& problem, std::span<const Start> starts,
                                         const Start& best);

}  // namespace geo::calibration
