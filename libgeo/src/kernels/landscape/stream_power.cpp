#include "geo/kernels/landscape/stream_power.hpp"

#include <cstdint>

#include "geo/core/array_sizes.hpp"

namespace geo {

double implicit_drop(double s0, double factor, double n) {
  if (n == 1.0) return s0 / (1.0 + factor);
  // For n < 1 the function is concave: from below Newton's steps overshoot at most once, and the
  // bracket catches them. For n >= 1 it is convex and the way from s0 is monotone.
  double low = 0.0, high = s0, s = s0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double power_n = factor * std::pow(s, n);
    const double residual = s + power_n - s0;
    (residual > 0.0 ? high : low) = s;
    double next = s - residual / (1.0 + n * power_n / s);
    if (std::abs(next - s) <= 1e-15 * s) return s;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == s) return s;
    s = next;
  }
  return s;
}

void incision_rate(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                   std::span<const float> erodibility, const StreamPower& law,
                   std::span<const float> elevation_m, std::span<float> rate_m_yr) {
  check_sizes("incision_rate", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"area_m2", area_m2.size()},
               {"erodibility", erodibility.size(), ArraySize::May::be_single},
               {"elevation_m", elevation_m.size()},
               {"rate_m_yr", rate_m_yr.size()}});
  const auto factor = detail::incision_factors(grid, graph, area_m2, erodibility, law);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double base = std::max<double>(elevation_m[graph.receiver[cell]], law.sea_level_m);
    const double drop = std::max(0.0, elevation_m[cell] - base);
    rate_m_yr[cell] =
        static_cast<float>(factor[cell] / law.dt_yr * detail::power(drop, law.slope_exponent));
  }
}

}  // namespace geo
