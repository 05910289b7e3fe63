#include "geo/kernels/stream_power.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace geo {
namespace {

/// Distance from each cell of a row to its receiver: from the flat offset inside the grid, by
/// search at its edges.
class ReceiverDistance {
 public:
  ReceiverDistance(const Grid& grid, int row) : grid_(grid), row_(row) {
    const auto& distance = grid.distances_m(row);
    for (int k = 0; k < kDirections; ++k) {
      by_step_[kRowStep[k] + 1][kColumnStep[k] + 1] = distance[k];
    }
  }
  [[nodiscard]] double operator()(Index cell, int column, Index receiver) const {
    if (grid_.is_interior(column, row_)) {
      const Index step = receiver - cell + grid_.nx() + 1;  // row step * nx + column step, shifted
      const Index row_step = step / grid_.nx();
      return by_step_[row_step][step - row_step * grid_.nx()];
    }
    for (int k = 0; k < kDirections; ++k) {
      if (grid_.neighbour(column, row_, k) == receiver) return grid_.distances_m(row_)[k];
    }
    return grid_.distances_m(row_)[kNorth];
  }

 private:
  const Grid& grid_;
  int row_;
  double by_step_[3][3] = {};
};

template <class Value>
Value at_or_single(std::span<const Value> values, Index cell) {
  return values.size() == 1 ? values[0] : values[cell];
}

double power(double base, double exponent) {
  if (exponent == 0.5) return std::sqrt(base);
  if (exponent == 1.0) return base;
  return std::pow(base, exponent);
}

/// F = K dt A^m / d^n of every cell.
std::vector<float> incision_factors(const Grid& grid, const FlowGraph& graph,
                                    std::span<const double> area_m2,
                                    std::span<const float> erodibility, const StreamPower& law) {
  std::vector<float> factor(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const ReceiverDistance distance(grid, j);
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j), to = graph.receiver[cell];
      if (to == cell) continue;
      factor[cell] = static_cast<float>(law.dt_yr * at_or_single(erodibility, cell) *
                                        power(area_m2[cell], law.area_exponent) /
                                        power(distance(cell, i, to), law.slope_exponent));
    }
  }
  return factor;
}

}  // namespace

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

template <class Real>
void incise(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
            std::span<const float> erodibility, const StreamPower& law,
            std::span<Real> elevation_m) {
  const auto factor = incision_factors(grid, graph, area_m2, erodibility, law);
  const Index* receiver = graph.receiver.data();
  const double n = law.slope_exponent, sea_level = law.sea_level_m;
  for (auto at = graph.order.rbegin(); at != graph.order.rend(); ++at) {
    const Index cell = *at, to = receiver[cell];
    if (to == cell) continue;
    const double base = std::max<double>(elevation_m[to], sea_level);
    const double drop = elevation_m[cell] - base;
    if (!(drop > 0.0)) continue;
    elevation_m[cell] = static_cast<Real>(base + implicit_drop(drop, factor[cell], n));
  }
}

template void incise<float>(const Grid&, const FlowGraph&, std::span<const double>,
                            std::span<const float>, const StreamPower&, std::span<float>);
template void incise<double>(const Grid&, const FlowGraph&, std::span<const double>,
                             std::span<const float>, const StreamPower&, std::span<double>);

void incision_rate(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                   std::span<const float> erodibility, const StreamPower& law,
                   std::span<const float> elevation_m, std::span<float> rate_m_yr) {
  const auto factor = incision_factors(grid, graph, area_m2, erodibility, law);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double base = std::max<double>(elevation_m[graph.receiver[cell]], law.sea_level_m);
    const double drop = std::max(0.0, elevation_m[cell] - base);
    rate_m_yr[cell] =
        static_cast<float>(factor[cell] / law.dt_yr * power(drop, law.slope_exponent));
  }
}

double breach_sills(const Grid& grid, const FlowGraph& graph, std::span<float> elevation_m) {
  std::vector<double> removed_m3(grid.ny(), 0.0);
  for (const Index cell : graph.order) {
    const Index to = graph.receiver[cell];
    if (graph.receiver[to] == to || elevation_m[to] <= elevation_m[cell]) continue;
    const int row = grid.row(to);
    removed_m3[row] +=
        grid.area_m2(row) * (static_cast<double>(elevation_m[to]) - elevation_m[cell]);
    elevation_m[to] = elevation_m[cell];
  }
  double total = 0.0;
  for (const double row : removed_m3) total += row;
  return total;
}

}  // namespace geo
