#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/cell_set.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/work_array.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/water/flow_graph.hpp"

namespace geo {

/// Cells under the water of depressions that `graph` leads over their sills (route_water): from
/// there to the outlet the way climbs. One byte per cell.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
template <class Z>
std::vector<std::uint8_t> flooded_cells(const FlowGraph& graph, std::span<const Z> elevation_m) {
  check_sizes("flooded_cells", graph.receiver.size(),
              {{"order", graph.order.size()}, {"elevation_m", elevation_m.size()}});
  std::vector<std::uint8_t> flooded(elevation_m.size(), 0);
  WorkArray<float> surface_m(elevation_m.size());
  walk_upstream(graph, [&](Index cell) {
    const Index to = graph.receiver[cell];
    const auto ground_m = static_cast<float>(value_of(elevation_m[cell]));
    surface_m[cell] = to == cell ? ground_m : std::max(ground_m, surface_m[to]);
    flooded[cell] = surface_m[cell] > ground_m ? 1 : 0;
  });
  return flooded;
}

/// One implicit step of rivers that erode and deposit at once, along the receivers of a forest:
///
///   dz/dt = -K A^m S^n + (G / A*) Q
///
/// with Q the sediment that leaves a cell, m3 yr-1, what the cell itself loses included, and A* the
/// area that it comes from (Davy & Lague 2009; Yuan et al. 2019). With K_d = K and K_t = K / G it
/// is the shared stream-power law E / K_d + Q / (A* K_t) = A^m S^n (Hergarten 2020): G = 0 is
/// detachment-limited, G to infinity with K / G held is transport-limited. In a steady state of
/// uniform uplift U, K A^m S^n = (1 + G) U everywhere.
///
/// For n = 1 the step is solved directly, whatever its length: with the lowering e = z(old) -
/// z(new), the water's drop s and the volume V = sum over donors of V + a e of the step,
///
///   e = F s - (G / A*) V,   s = s_old - e + e_receiver,   F = K dt A^m / d^n,
///
/// each e is linear in its receiver's: one sweep downstream eliminates, one upstream solves
/// (Hergarten 2020). For another n the same two sweeps are repeated with F s^(n-1) at the slopes
/// found before, from those of `incise` on, until drops change by less than 1e-12; those under
/// 1e-6 m count as that.
///
/// Cells with a non-zero byte in `flooded` are lakes that stand at the level of their sill: rivers
/// end at that level, and what they bring fills the way to the sill from the mouth on; what finds
/// no room leaves over the sill. Roots keep their elevation, outlets under water stand for
/// `law.sea_level_m`. A cell below its receiver is not cut; it keeps what settles on it.
///
/// What is taken equals what is laid and what arrives at roots, to the rounding of Z
/// (sediment_outflow). `area_m2`, `erodibility`: as for `incise`; `area_done` is called once the
/// areas are read no more, so that who holds them may let them go. `flooded`: one byte per cell, or
/// empty. `elevation_m` in and out. Derivatives (core/numeric.hpp) are those of the step along
/// these receivers. Cost: linear; in double, threaded over the parts of the order, the same bits
/// for any number of threads. Throws Bug where sizes differ.
template <class K, class Z>
void incise_and_deposit(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                        std::span<const K> erodibility, const BasicStreamPower<Arithmetic<Z>>& law,
                        const Arithmetic<Z>& deposition, std::span<const std::uint8_t> flooded,
                        std::span<Z> elevation_m, const std::function<void()>& area_done = {});

/// Rock and sediment that leave each cell along its receiver while elevation changes from
/// `before_m` to `after_m`, m3: its own loss and that of all cells upstream. At a root: what
/// arrives there, its own change aside.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
template <class Z>
std::vector<Arithmetic<Z>> sediment_outflow(const Grid& grid, const FlowGraph& graph,
                                            std::span<const Z> before_m,
                                            std::span<const Z> after_m) {
  check_sizes("sediment_outflow", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"order", graph.order.size()},
               {"before_m", before_m.size()},
               {"after_m", after_m.size()}});
  using Number = Arithmetic<Z>;
  std::vector<Number> volume_m3(before_m.size(), Number(0.0));
  walk_downstream(graph, [&](Index cell) {
    const Index to = graph.receiver[cell];
    if (to == cell) return;
    volume_m3[cell] +=
        grid.area_m2(grid.row(cell)) * (Number(before_m[cell]) - Number(after_m[cell]));
    volume_m3[to] += volume_m3[cell];
  });
  return volume_m3;
}

namespace detail {

/// The elimination of `incise_and_deposit` for factors that are linear in the drop.
template <class Z>
class SedimentSweeps {
 public:
  using Number = Arithmetic<Z>;

  SedimentSweeps(const Grid& grid, const FlowGraph& graph, const Number& deposition,
                 double sea_level_m, std::span<const std::uint8_t> flooded,
                 std::span<const Z> elevation_m)
      : grid_(grid),
        graph_(graph),
        deposition_(deposition),
        sea_level_m_(sea_level_m),
        flooded_(flooded),
        z_(elevation_m),
        source_m2_(source_area(grid, graph)) {
    if (!flooded.empty()) find_lake_levels();
  }

  /// `factor(cell)`: F of s + F s = s0. Afterwards `lowering` and `drop` hold.
  template <class Factor>
  void solve(const Factor& factor) {
    eliminate(factor);
    substitute(factor);
  }
  [[nodiscard]] const Number& lowering(Index cell) const { return lowering_m_[cell]; }
  /// Of a cell above its receiver, after `solve`.
  [[nodiscard]] Number drop(Index cell) const {
    const Index to = graph_.receiver[cell];
    Number drop = Number(z_[cell]) - base(to) - lowering_m_[cell];
    if (moves(to)) drop += lowering_m_[to];
    return drop;
  }
  [[nodiscard]] bool is_river(Index cell) const {
    return graph_.receiver[cell] != cell && !is_flooded(cell);
  }

 private:
  /// As exact as the surface.
  using Area = std::conditional_t<std::is_same_v<Z, float>, float, double>;

  /// A* of every cell.
  static WorkArray<Area> source_area(const Grid& grid, const FlowGraph& graph) {
    WorkArray<double> area_m2(static_cast<std::size_t>(grid.size()));
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      std::fill_n(area_m2.begin() + grid.cell(0, j), grid.nx(), grid.area_m2(j));
    }
    graph.accumulate(area_m2);
    if constexpr (std::is_same_v<Area, double>) {
      return area_m2;
    } else {
      return WorkArray<Area>::copy_of(area_m2);
    }
  }

  [[nodiscard]] bool is_flooded(Index cell) const {
    return !flooded_.empty() && flooded_[cell] != 0;
  }
  /// Whether a cell's level as a base is part of the solution.
  [[nodiscard]] bool moves(Index cell) const { return is_river(cell); }
  [[nodiscard]] Number base(Index to) const {
    if (is_flooded(to)) return Number(lake_level_m_.of(to));
    if (graph_.receiver[to] == to) return greater(Number(z_[to]), Number(sea_level_m_));
    return Number(z_[to]);
  }
  void find_lake_levels() {
    lake_level_m_ = SparseValues<Z>(std::make_shared<const CellSet>(
        grid_.size(), [&](Index cell) { return flooded_[cell] != 0; }));
    walk_upstream(graph_, [&](Index cell) {
      if (!is_flooded(cell)) return;
      const Index to = graph_.receiver[cell];
      const Z sill_m = is_flooded(to) ? lake_level_m_.of(to) : z_[to];
      lake_level_m_.of(cell) = to == cell ? z_[cell] : Z(greater(Number(z_[cell]), Number(sill_m)));
    });
  }

  /// Donors first: e = lowering + follows e_receiver. Until its turn a cell holds what its donors
  /// bring: V = lowering + follows e of its own.
  template <class Factor>
  void eliminate(const Factor& factor) {
    if (lowering_m_.empty()) {
      lowering_m_ = WorkArray<Number>(z_.size(), Number(0.0));
      follows_ = WorkArray<Number>(z_.size(), Number(0.0));
    } else {
      lowering_m_.fill(Number(0.0));
      follows_.fill(Number(0.0));
    }
    walk_downstream(graph_, [&](Index cell) {
      const Index to = graph_.receiver[cell];
      if (to == cell) return;
      const double area_m2 = grid_.area_m2(grid_.row(cell));
      const Number brought = lowering_m_[cell], more = follows_[cell];
      if (is_flooded(cell)) {
        const Number room = area_m2 * (Number(lake_level_m_.of(cell)) - Number(z_[cell]));
        const Number laid = lesser(greater(brought, Number(0.0)), room);
        lowering_m_[cell] = -laid / area_m2;
        follows_[cell] = Number(0.0);
        lowering_m_[to] += brought - laid;
        return;
      }
      const Number settles = deposition_ / static_cast<double>(source_m2_[cell]);
      const Number f = factor(cell);
      const Number total = 1.0 + f + settles * (area_m2 + more);
      const Number e = (f * (Number(z_[cell]) - base(to)) - settles * brought) / total;
      const Number with_receiver = moves(to) ? Number(f / total) : Number(0.0);
      lowering_m_[cell] = e;
      follows_[cell] = with_receiver;
      lowering_m_[to] += brought + (more + area_m2) * e;
      follows_[to] += (more + area_m2) * with_receiver;
    });
  }

  /// Receivers first.
  template <class Factor>
  void substitute(const Factor& factor) {
    walk_upstream(graph_, [&](Index cell) {
      const Index to = graph_.receiver[cell];
      if (to == cell) {
        lowering_m_[cell] = Number(0.0);
        return;
      }
      if (is_flooded(cell)) return;
      Number& e = lowering_m_[cell];
      if (moves(to)) e += follows_[cell] * lowering_m_[to];
      const Number s = drop(cell);
      if (value_of(s) < 0.0) e = lesser(Number(e - factor(cell) * s), Number(0.0));
    });
  }

  const Grid& grid_;
  const FlowGraph& graph_;
  Number deposition_;
  double sea_level_m_;
  std::span<const std::uint8_t> flooded_;
  std::span<const Z> z_;
  SparseValues<Z> lake_level_m_;
  WorkArray<Area> source_m2_;
  WorkArray<Number> lowering_m_, follows_;
};

/// Slopes of a law that is not linear in them: F s^(n-1) at the drops of the last solution, damped
/// so that neither gentle nor steep powers swing.
template <class K, class Z, class Number = Arithmetic<Z>>
void iterate_slopes(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                    std::span<const K> erodibility, const BasicStreamPower<Number>& law,
                    std::span<const K> factor, std::span<const Z> elevation_m,
                    SedimentSweeps<Z>& sweeps) {
  using std::exp;
  using std::log;
  using std::pow;
  constexpr int kMost = 100;
  constexpr double kLeast_m = 1e-6, kStill = 1e-12, kGentle_m = 1.0;
  const Number n = law.slope_exponent;
  std::vector<Number> drop(elevation_m.size(), Number(kLeast_m));
  {
    std::vector<Z> cut(elevation_m.begin(), elevation_m.end());
    incise<K, Z>(grid, graph, area_m2, erodibility, law, cut);
    for (std::size_t c = 0; c < drop.size(); ++c) {
      const Index to = graph.receiver[c];
      const Number base = greater(Number(cut[to]), Number(law.sea_level_m));
      drop[c] = greater(Number(Number(cut[c]) - base), Number(kLeast_m));
    }
  }
  const auto linear = [&](Index cell) { return Number(factor[cell]) * pow(drop[cell], n - 1.0); };
  const double damping = 1.0 / std::max(1.0, value_of(n));
  double change = 1.0;
  // One more solution than values need: derivatives come one behind them.
  for (int round = 0, still = 0; round < kMost && still < 2; ++round) {
    sweeps.solve(linear);
    change = 0.0;
    for (std::size_t c = 0; c < drop.size(); ++c) {
      if (!sweeps.is_river(static_cast<Index>(c))) continue;
      const Number found = greater(sweeps.drop(static_cast<Index>(c)), Number(kLeast_m));
      change = std::max(change, std::abs(value_of(found) - value_of(drop[c])) /
                                    std::max(value_of(found), kGentle_m));
      drop[c] = exp((1.0 - damping) * log(drop[c]) + damping * log(found));
    }
    still = change < kStill || value_of(n) == 1.0 ? still + 1 : 0;
  }
}

}  // namespace detail

template <class K, class Z>
void incise_and_deposit(const Grid& grid, const FlowGraph& graph, std::span<const double> area_m2,
                        std::span<const K> erodibility, const BasicStreamPower<Arithmetic<Z>>& law,
                        const Arithmetic<Z>& deposition, std::span<const std::uint8_t> flooded,
                        std::span<Z> elevation_m, const std::function<void()>& area_done) {
  check_sizes("incise_and_deposit", grid.size(),
              {{"receiver", graph.receiver.size()},
               {"order", graph.order.size()},
               {"area_m2", area_m2.size()},
               {"erodibility", erodibility.size(), ArraySize::May::be_single},
               {"flooded", flooded.size(), ArraySize::May::be_empty},
               {"elevation_m", elevation_m.size()}});
  using Number = Arithmetic<Z>;
  const auto factor = detail::incision_factors(grid, graph, area_m2, erodibility, law);
  const bool is_linear =
      value_of(law.slope_exponent) == 1.0 && !carries_derivative(law.slope_exponent);
  if (is_linear && area_done) area_done();
  detail::SedimentSweeps<Z> sweeps(grid, graph, deposition, law.sea_level_m, flooded, elevation_m);
  if (is_linear) {
    sweeps.solve([&](Index cell) { return Number(factor[cell]); });
  } else {
    detail::iterate_slopes<K, Z>(grid, graph, area_m2, erodibility, law, factor, elevation_m,
                                 sweeps);
    if (area_done) area_done();
  }
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    elevation_m[cell] = static_cast<Z>(Number(elevation_m[cell]) - sweeps.lowering(cell));
  }
}

}  // namespace geo
