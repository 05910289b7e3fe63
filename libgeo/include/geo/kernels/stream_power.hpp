#pragma once

#include <limits>
#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/flow_graph.hpp"

namespace geo {

/// Exponents of the stream-power law and the step.
struct StreamPower {
  double area_exponent = 0.5;   ///< m
  double slope_exponent = 1.0;  ///< n
  double dt_yr = 1e5;
  /// Rivers do not cut below it: the level that outlets under water stand for, m.
  double sea_level_m = -std::numeric_limits<double>::infinity();
};

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
/// `area_m2`: drainage area, m2, one per cell. `erodibility`: K, m^(1-2m) yr-1, one per cell, or a
/// single value for all. `elevation_m` in and out: hold uplift of the step already.
/// Real is float or double: the precision that elevations are kept in; the solve is in double.
template <class Real>
void incise(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
            std::span<const float> erodibility, const StreamPower& law,
            std::span<Real> elevation_m);

/// Root s in [0, s0] of s + F s^n = s0 for s0 > 0, F >= 0, n > 0, to round-off.
double implicit_drop(double s0, double factor, double n);

/// Rate of incision K A^m S^n along receivers, m yr-1; 0 where the receiver is not lower.
/// Outlets below `law.sea_level_m` count as standing at it.
void incision_rate(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                   std::span<const float> erodibility, const StreamPower& law,
                   std::span<const float> elevation_m, std::span<float> rate_m_yr);

/// Cuts sills down to the water behind them: along the forest, no receiver stays above its donor.
/// Outlets are left alone. Returns the volume removed, m3.
double breach_sills(const Grid& grid, const FlowGraph& graph, std::span<float> elevation_m);

}  // namespace geo
