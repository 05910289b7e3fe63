#include "geo/kernels/landscape/river_sediment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "geo/kernels/water/depressions.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

constexpr double kErodibility = 2e-6;
constexpr double kUplift = 1e-4;

/// A river along a row of a plane, from its head to an outlet; its banks do not flow.
struct River {
  explicit River(int cells) : grid(Grid::plane(cells, 3, 5000.0, 4000.0)), cells(cells) {
    graph.receiver.resize(grid.size());
    std::iota(graph.receiver.begin(), graph.receiver.end(), 0);
    for (int i = 0; i + 1 < cells; ++i) graph.receiver[grid.cell(i, 1)] = grid.cell(i + 1, 1);
    graph.order = downstream_order(graph.receiver);
    z.assign(grid.size(), 0.0);
    area_m2.assign(grid.size(), grid.area_m2(0));
    graph.accumulate(area_m2);
  }
  void step(double dt_yr, double deposition, double n = 1.0, double uplift = kUplift,
            double erodibility = kErodibility) {
    for (int i = 0; i + 1 < cells; ++i) z[grid.cell(i, 1)] += uplift * dt_yr;
    const std::vector<double> single{erodibility};
    incise_and_deposit<double, double>(grid, graph, area_m2, single,
                                       {.slope_exponent = n, .dt_yr = dt_yr}, deposition, {}, z);
  }
  [[nodiscard]] double slope(int i) const {
    return (z[grid.cell(i, 1)] - z[grid.cell(i + 1, 1)]) / 5000.0;
  }
  /// K A^m S^n = (1 + G) U.
  void make_steady(double deposition, double n = 1.0) {
    for (int i = cells - 2; i >= 0; --i) {
      const double a = area_m2[grid.cell(i, 1)];
      const double s =
          std::pow((1.0 + deposition) * kUplift / (kErodibility * std::sqrt(a)), 1.0 / n);
      z[grid.cell(i, 1)] = z[grid.cell(i + 1, 1)] + 5000.0 * s;
    }
  }
  Grid grid;
  int cells;
  FlowGraph graph;
  std::vector<double> z, area_m2;
};

TEST(RiverSediment, SteadySlopeIsTheAnalyticOne) {
  for (const double deposition : {0.0, 0.5, 1.0, 5.0}) {
    River river(60), exact(60);
    for (int k = 0; k < 3000; ++k) river.step(1e6, deposition);
    exact.make_steady(deposition);
    for (int i = 0; i + 1 < river.cells; ++i) {
      ASSERT_NEAR(river.slope(i) / exact.slope(i), 1.0, 1e-9) << deposition << " " << i;
    }
  }
}

TEST(RiverSediment, AStepOfAnyLengthKeepsASteadyRiver) {
  for (const double n : {0.7, 1.0, 1.5, 2.0}) {
    for (const double deposition : {0.3, 1.0, 10.0}) {
      for (const double dt_yr : {1.0, 1e4, 1e6, 1e9}) {
        River river(60);
        river.make_steady(deposition, n);
        const auto before = river.z;
        river.step(dt_yr, deposition, n);
        for (std::size_t c = 0; c < before.size(); ++c) {
          ASSERT_NEAR(river.z[c], before[c], 1e-6 * before[river.grid.cell(0, 1)])
              << n << " " << deposition << " " << dt_yr;
        }
      }
    }
  }
}

TEST(RiverSediment, HalvedStepsConvergeWithTheFirstOrder) {
  const auto height = [](int steps) {
    River river(60);
    river.make_steady(1.0);
    for (int k = 0; k < steps; ++k) river.step(2e6 / steps, 1.0, 1.0, 5.0 * kUplift);
    return river.z[river.grid.cell(50, 1)];
  };
  const double exact = height(8192);
  EXPECT_NEAR(std::log2((height(32) - exact) / (height(64) - exact)), 1.0, 0.05);
}

TEST(RiverSediment, FastBedsCarryWhatTheyCanTransport) {
  // K and G grow, K / G = K_t stays: K_t A^m S = U, whatever K is.
  constexpr double kDeposition = 1e5;
  River river(60);
  for (int k = 0; k < 400; ++k) {
    river.step(1e6, kDeposition, 1.0, kUplift, kDeposition * kErodibility);
  }
  for (int i = 0; i + 1 < river.cells; ++i) {
    const double a = river.area_m2[river.grid.cell(i, 1)];
    ASSERT_NEAR(river.slope(i) * kErodibility * std::sqrt(a) / kUplift, 1.0, 2e-5) << i;
  }
}

struct Land {
  explicit Land(const Grid& grid, std::uint64_t seed) : grid(grid) {
    const auto terrain = test::random_terrain(grid, seed);
    outlets = find_outlets(grid, terrain);
    graph = route_water(grid, terrain, outlets).graph;
    z.assign(terrain.begin(), terrain.end());
    area_m2.resize(grid.size());
    for (Index c = 0; c < grid.size(); ++c) area_m2[c] = grid.area_m2(grid.row(c));
    graph.accumulate(area_m2);
    flooded = flooded_cells<double>(graph, z);
  }
  template <class Z>
  std::vector<Z> stepped(double deposition, double dt_yr, double n = 1.0) const {
    std::vector<Z> out(z.begin(), z.end());
    const std::vector<double> single{kErodibility};
    incise_and_deposit<double, Z>(grid, graph, area_m2, single,
                                  {.slope_exponent = n, .dt_yr = dt_yr, .sea_level_m = 0.0},
                                  deposition, flooded, out);
    return out;
  }
  Grid grid;
  std::vector<std::uint8_t> outlets, flooded;
  FlowGraph graph;
  std::vector<double> z, area_m2;
};

TEST(RiverSediment, WhatIsTakenIsLaidOrArrives) {
  for (const Grid& grid : test::small_grids()) {
    const Land land(grid, 7);
    for (const double dt_yr : {1e4, 1e6, 1e8}) {
      const auto after = land.stepped<double>(1.0, dt_yr);
      const auto volume = sediment_outflow<double>(grid, land.graph, land.z, after);
      double taken = 0.0, laid = 0.0, arrives = 0.0;
      for (Index c = 0; c < grid.size(); ++c) {
        const double a = grid.area_m2(grid.row(c)), e = land.z[c] - after[c];
        (e > 0.0 ? taken : laid) += a * std::abs(e);
        if (land.graph.receiver[c] == c) {
          EXPECT_EQ(e, 0.0);
          arrives += volume[c];
        }
      }
      for (const double leaves : volume) EXPECT_GE(leaves, -1e-12 * taken);
      EXPECT_GT(laid, 0.0);
      EXPECT_NEAR((laid + arrives) / taken, 1.0, 1e-12);
    }
  }
}

TEST(RiverSediment, WithoutDepositionItIsTheStreamPowerLaw) {
  for (const Grid& grid : test::small_grids()) {
    Land land(grid, 3);
    land.flooded.clear();
    for (const double n : {0.6, 1.0, 1.8}) {
      const auto z = land.stepped<double>(0.0, 1e6, n);
      std::vector<double> expected = land.z;
      const std::vector<double> single{kErodibility};
      incise<double, double>(grid, land.graph, land.area_m2, single,
                             {.slope_exponent = n, .dt_yr = 1e6, .sea_level_m = 0.0}, expected);
      for (Index c = 0; c < grid.size(); ++c) {
        const bool climbs = land.z[land.graph.receiver[c]] >= land.z[c];
        if (climbs) continue;  // flooded ground, which the other test has
        // For another n drops of less than 1e-6 m count as that.
        const double tolerance_m = n == 1.0 ? 1e-12 * (1.0 + std::abs(expected[c])) : 1e-6;
        ASSERT_NEAR(z[c], expected[c], tolerance_m) << n;
      }
    }
  }
}

TEST(RiverSediment, EveryRiverCellKeepsTheLaw) {
  // A slope down to one edge, without lakes: what each cell loses is what the law says.
  const Grid grid = Grid::plane(24, 20, 3000.0, 3000.0);
  Land land(grid, 11);
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      land.z[grid.cell(i, j)] = 40.0 * i + 3.0 * std::sin(1.7 * j) * std::sqrt(1.0 * i);
    }
  }
  land.outlets.assign(grid.size(), 0);
  for (int j = 0; j < grid.ny(); ++j) land.outlets[grid.cell(0, j)] = 1;
  const std::vector<float> floats(land.z.begin(), land.z.end());
  land.graph = route_water(grid, floats, land.outlets).graph;
  land.area_m2.assign(grid.size(), grid.area_m2(0));
  land.graph.accumulate(land.area_m2);
  land.flooded.clear();
  constexpr double kDt = 3e6, kDeposition = 1.4;
  const auto after = land.stepped<double>(kDeposition, kDt);
  const auto volume = sediment_outflow<double>(grid, land.graph, land.z, after);
  int rivers = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    const Index to = land.graph.receiver[c];
    if (to == c) continue;
    const ReceiverDistance distance(grid, grid.row(c));
    const double drop = after[c] - std::max(after[to], 0.0);
    ASSERT_GE(drop, 0.0);
    const double cut =
        kErodibility * kDt * std::sqrt(land.area_m2[c]) * drop / distance(c, grid.column(c), to);
    const double settled = kDeposition * volume[c] / land.area_m2[c];
    EXPECT_NEAR(land.z[c] - after[c], cut - settled, 1e-11 * (cut + settled));
    ++rivers;
  }
  EXPECT_GT(rivers, 400);
}

TEST(RiverSediment, LakesFillFromTheMouthAndLetTheRestPass) {
  // 100 80 | 20 10 30 | 50 (sill) 0 (outlet): the lake holds 30 + 40 + 20 m of a cell.
  River river(7);
  const std::vector<double> bed{1000, 900, 20, 10, 30, 50, 0};
  const auto run = [&](double dt_yr) {
    for (int i = 0; i < 7; ++i) river.z[river.grid.cell(i, 1)] = bed[i];
    const auto flooded = flooded_cells<double>(river.graph, river.z);
    EXPECT_EQ(std::accumulate(flooded.begin(), flooded.end(), 0), 3);
    const std::vector<double> single{kErodibility};
    const auto before = river.z;
    incise_and_deposit<double, double>(river.grid, river.graph, river.area_m2, single,
                                       {.dt_yr = dt_yr}, 1.0, flooded, river.z);
    return sediment_outflow<double>(river.grid, river.graph, before, river.z);
  };
  const auto at = [&](int i) { return river.z[river.grid.cell(i, 1)]; };
  // Little: all of it in the first cell of the lake.
  auto volume = run(1e4);
  EXPECT_GT(at(2), 20.0);
  EXPECT_LT(at(2), 50.0);
  EXPECT_EQ(at(3), 10.0);
  EXPECT_NEAR(volume[river.grid.cell(4, 1)], 0.0, 1e-6);
  // Much: full to the sill, and the rest goes on.
  volume = run(1e6);
  for (int i = 2; i < 5; ++i) EXPECT_NEAR(at(i), 50.0, 1e-12);
  EXPECT_GT(volume[river.grid.cell(4, 1)], 0.0);
  // The river ends at the level of the water, not at the bed.
  EXPECT_GT(at(1), 50.0);
}

TEST(RiverSediment, DerivativesAreThoseOfTheStep) {
  using Complex = std::complex<double>;
  for (const double n : {1.0, 1.4}) {
    River river(20);
    river.make_steady(0.0);
    const auto step = [&](auto deposition, auto exponent) {
      using V = decltype(deposition);
      std::vector<V> z(river.z.begin(), river.z.end());
      const std::vector<V> single{V(kErodibility)};
      incise_and_deposit<V, V>(river.grid, river.graph, river.area_m2, single,
                               {V(0.5), exponent, V(1e6)}, deposition, {}, z);
      return z[river.grid.cell(4, 1)];
    };
    constexpr double kStep = 1e-5, kTiny = 1e-30;
    const double by_deposition = (step(1.0 + kStep, n) - step(1.0 - kStep, n)) / (2.0 * kStep);
    EXPECT_NEAR(step(Complex(1.0, kTiny), Complex(n)).imag() / kTiny / by_deposition, 1.0, 1e-6);
    const double by_exponent = (step(1.0, n + kStep) - step(1.0, n - kStep)) / (2.0 * kStep);
    EXPECT_NEAR(step(Complex(1.0), Complex(n, kTiny)).imag() / kTiny / by_exponent, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace geo
