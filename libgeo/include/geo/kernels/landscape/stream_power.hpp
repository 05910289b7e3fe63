#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/work_array.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/receiver_distance.hpp"
#include "geo/kernels/water/valley_width.hpp"

namespace geo {

/// Exponents of the stream-power law and the step.
template <class T>
struct BasicStreamPower {
  T area_exponent{0.5};   ///< m
  T slope_exponent{1.0};  ///< n
  T dt_yr{1e5};
  /// Rivers do not cut below it: the level that outlets under water stand for, m.
  double sea_level_m = -std::numeric_limits<double>::infinity();
};
using StreamPower = BasicStreamPower<double>;

/// One implicit step of river incision, dz/dt = -K A^m S^n (Howard 1994; Whipple & Tucker 1999),
/// along the receivers of a forest (Braun & Willett 2013), from outlets upwards:
///
///   s + F s^n = s0,  s = z_i - z_r,  s0 = z_i(old) - z_r(new),  F = K dt A^m / d^n
///
/// For n = 1 solved directly, otherwise by Newton's method, for n >= 1 from s0 (monotone), for
/// n < 1 within the bracket [0, s0]. Unconditionally stable, cost linear. Roots keep their
/// elevation; so do cells that do not stand above their receiver (flooded ground on the way from a
/// pit to its sill): no step climbs, none digs a pit.
///
/// `area_m2`: drainage area, m2, one per cell; where meridians converge a bed is as wide as its
/// valley (valley_width.hpp) and A has that much more than the cell's own. `erodibility`: K,
/// m^(1-2m) yr-1, one per cell, or a single value for all. `elevation_m` in and out: hold uplift of
/// the step already. Elevations and erodibilities may carry derivatives (core/numeric.hpp), which
/// are those of the step along these receivers. The solve is in double.
/// `erodibility`: one value per cell, or a single one. The other arrays: one value per cell; Bug
/// otherwise.
template <class K, class Z>
void incise(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
            std::span<const K> erodibility, const BasicStreamPower<Arithmetic<Z>>& law,
            std::span<Z> elevation_m);

/// Root s in [0, s0] of s + F s^n = s0 for s0 > 0, F >= 0, n > 0, to round-off.
double implicit_drop(double s0, double factor, double n);

/// The same with derivatives, by the implicit function theorem: one Newton step from the root, in
/// numbers that carry them.
template <class T>
[[nodiscard]] inline T implicit_drop(const T& s0, const T& factor,
                                     const T& n) requires(!std::is_arithmetic_v<T>) {
  using std::pow;
  if (value_of(n) == 1.0 && !carries_derivative(n)) return s0 / (1.0 + factor);
  const double s = implicit_drop(value_of(s0), value_of(factor), value_of(n));
  if (!(s > 0.0)) return T(0.0);
  const T power_n = factor * pow(s, n);
  const double slope = 1.0 + value_of(n) * value_of(power_n) / s;
  return s - (s + power_n - s0) / slope;
}

/// Rate of incision K A^m S^n along receivers, m yr-1; 0 where the receiver is not lower.
/// Outlets below `law.sea_level_m` count as standing at it.
/// Shapes as for `incise`; `rate_m_yr`: one value per cell.
void incision_rate(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                   std::span<const float> erodibility, const StreamPower& law,
                   std::span<const float> elevation_m, std::span<float> rate_m_yr);

/// Cuts sills down to the water behind them: along the forest, no receiver stays above its donor.
/// Outlets are left alone. Returns the volume removed, m3.
/// `elevation_m`: one value per cell, in and out; Bug otherwise.
template <class Z>
double breach_sills(const Grid& grid, const FlowGraph& graph, std::span<Z> elevation_m) {
  check_sizes("breach_sills", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"order", graph.order.size()},
               {"elevation_m", elevation_m.size()}});
  std::vector<double> removed_m3(grid.ny(), 0.0);
  for (const Index cell : graph.order) {
    const Index to = graph.receiver[cell];
    if (graph.receiver[to] == to || value_of(elevation_m[to]) <= value_of(elevation_m[cell])) {
      continue;
    }
    const int row = grid.row(to);
    removed_m3[row] +=
        grid.area_m2(row) * (value_of(elevation_m[to]) - value_of(elevation_m[cell]));
    elevation_m[to] = elevation_m[cell];
  }
  double total = 0.0;
  for (const double row : removed_m3) total += row;
  return total;
}

namespace detail {

template <class Value>
const Value& at_or_single(std::span<const Value> values, Index cell) {
  return values.size() == 1 ? values[0] : values[cell];
}

template <class T>
[[nodiscard]] inline T power(double base, const T& exponent) {
  using std::pow;
  if (!carries_derivative(exponent)) {
    if (value_of(exponent) == 0.5) return T(std::sqrt(base));
    if (value_of(exponent) == 1.0) return T(base);
  }
  return pow(base, exponent);
}

/// F = K dt A^m / d^n of every cell.
template <class K, class T>
WorkArray<K> incision_factors(const Grid& grid, const FlowGraph& graph,
                              std::span<const double> area_m2, std::span<const K> erodibility,
                              const BasicStreamPower<T>& law) {
  WorkArray<K> factor(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const ReceiverDistance distance(grid, j);
    const double beyond_m2 = valley_floor_beyond_cell_m2(grid, j);
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j), to = graph.receiver[cell];
      if (to == cell) continue;
      factor[cell] = static_cast<K>(law.dt_yr * T(at_or_single(erodibility, cell)) *
                                    power(area_m2[cell] + beyond_m2, law.area_exponent) /
                                    power(distance(cell, i, to), law.slope_exponent));
    }
  }
  return factor;
}

}  // namespace detail

template <class K, class Z>
void incise(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
            std::span<const K> erodibility, const BasicStreamPower<Arithmetic<Z>>& law,
            std::span<Z> elevation_m) {
  check_sizes("incise", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"order", graph.order.size()},
               {"area_m2", area_m2.size()},
               {"erodibility", erodibility.size(), ArraySize::May::be_single},
               {"elevation_m", elevation_m.size()}});
  using Number = Arithmetic<Z>;
  const auto factor = detail::incision_factors(grid, graph, area_m2, erodibility, law);
  const Index* receiver = graph.receiver.data();
  walk_upstream(graph, [&](Index cell) {
    const Index to = receiver[cell];
    if (to == cell) return;
    const Number base = greater(Number(elevation_m[to]), Number(law.sea_level_m));
    const Number drop = Number(elevation_m[cell]) - base;
    if (!(value_of(drop) > 0.0)) return;
    elevation_m[cell] =
        static_cast<Z>(base + implicit_drop(drop, Number(factor[cell]), law.slope_exponent));
  });
}

}  // namespace geo
