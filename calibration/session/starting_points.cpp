#include "calibration/session/starting_points.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/random.hpp"

namespace geo::calibration {

std::vector<Eigen::VectorXd> starting_points(const Problem& problem, std::int64_t count) {
  std::vector<Eigen::VectorXd> points{problem.present()};
  const RandomStream random(0, "calibration.starts");
  for (std::int64_t n = 1; n < count; ++n) {
    Eigen::VectorXd x = points.front();
    for (std::size_t i = 0; i < problem.free.size(); ++i) {
      const FreeParameter& free = problem.free[i];
      const double reach = free.logarithmic ? std::log(2.0) : 0.5;
      const double centre = points.front()[Eigen::Index(i)];
      const double low = std::max(centre - reach, free.to_x(free.low));
      const double high = std::min(centre + reach, free.to_x(free.high));
      x[Eigen::Index(i)] = random.uniform(std::uint64_t(n), i, low, high);
    }
    points.push_back(x);
  }
  return points;
}

std::vector<double> values_at(const Problem& problem, const Eigen::VectorXd& x) {
  std::vector<double> values;
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    values.push_back(problem.free[i].to_value(x[Eigen::Index(i)]));
  }
  return values;
}

int equally_good_elsewhere(const Problem& problem, std::span<const Start> starts,
                           const Start& best) {
  constexpr double kAsGood = 1.05, kElsewhere = 0.1;
  int others = 0;
  for (const Start& start : starts) {
    if (start.cost > kAsGood * best.cost + 1e-9) continue;
    for (std::size_t i = 0; i < problem.free.size(); ++i) {
      const FreeParameter& free = problem.free[i];
      if (std::abs(free.to_x(start.to[i]) - free.to_x(best.to[i])) > kElsewhere) {
        ++others;
        break;
      }
    }
  }
  return others;
}

}  // namespace geo::calibration
