#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/work_array.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/diffusion.hpp"

namespace geo {

/// Lays what rivers bring on the floor of the sea. Plumes mix over a bell of standard deviation L
/// along every direction, with the coast as a wall, and settle:
///
///   D = exp(L²/2 ∇²) S,   no flux across the shore
///
/// with S what arrives and D what settles, m per cell; mass Σ S · area is kept. Where D exceeds the
/// room up to wave base, waves take the excess up again and it spreads anew, three times as far:
/// shelves fill to wave base and build their edges out. What still finds no accommodation space
/// goes with turbidity currents to wherever in the sea there is some, in proportion to it.
///
/// `sea`: one byte per cell, non-zero where it is. `room_m`: up to wave base, one per cell, not
/// negative. `supply_m` in: S, 0 on land; out: D, at most the room as long as the sea has room for
/// all; otherwise what exceeds it stays where it was left. Length L >= 0 in m. Numbers may carry
/// derivatives (core/numeric.hpp). Cost: linear, two diffusions; the same bits for any threads.
/// Throws Bug where sizes differ.
template <class Number>
void lay_at_sea(const Grid& grid, std::span<const std::uint8_t> sea, const Number& length_m,
                std::span<const Number> room_m, std::span<Number> supply_m) {
  check_sizes("lay_at_sea", grid.size(),
              {{"sea", sea.size()}, {"room_m", room_m.size()}, {"supply_m", supply_m.size()}});
  WorkArray<std::uint8_t> land(sea.size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) land[cell] = sea[cell] == 0 ? 1 : 0;
  auto afloat = WorkArray<Number>::copy_of(supply_m);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) supply_m[cell] = Number(0.0);
  const auto settle = [&] {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const Number laid = lesser(afloat[cell], Number(room_m[cell] - supply_m[cell]));
      supply_m[cell] += laid;
      afloat[cell] -= laid;
    }
    return area_sum<Number>(grid, [&](Index cell) { return afloat[cell]; });
  };
  // Thousands of sums of diffusion leave a part in 1e12 behind.
  const auto keep_sum = [&](const Number& brought) {
    const Number now = area_sum<Number>(grid, [&](Index cell) { return afloat[cell]; });
    if (!(value_of(now) > 0.0)) return;
    const Number correction = brought / now;
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid.size(); ++cell) afloat[cell] *= correction;
  };
  struct Spread {
    double reach;  // in lengths
    int substeps;
  };
  for (const Spread& spread : {Spread{1.0, 2}, Spread{3.0, 1}}) {
    const Number brought = area_sum<Number>(grid, [&](Index cell) { return afloat[cell]; });
    apply_linear<Number, 1>(
        std::span<Number>(afloat.data(), afloat.size()), {length_m},
        [&](auto values, const std::array<double, 1>& length) {
          const double spread_m = spread.reach * length[0];
          diffuse(
              grid, values, 0.5 * spread_m * spread_m, 1.0,
              {.excluded = land, .scheme = DiffusionScheme::positive, .substeps = spread.substeps});
        });
    keep_sum(brought);
    if (!(value_of(settle()) > 0.0)) return;
  }
  const Number rest = area_sum<Number>(grid, [&](Index cell) { return afloat[cell]; });
  const Number room =
      area_sum<Number>(grid, [&](Index cell) { return room_m[cell] - supply_m[cell]; });
  const Number share =
      value_of(room) > 0.0 ? lesser(Number(rest / room), Number(1.0)) : Number(0.0);
  const Number left = value_of(rest) > value_of(room) ? Number(1.0 - room / rest) : Number(0.0);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    supply_m[cell] += share * (room_m[cell] - supply_m[cell]) + left * afloat[cell];
  }
}

}  // namespace geo
