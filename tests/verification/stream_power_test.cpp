// Exact solutions of dz/dt = U - K A^m S^n along a river of drainage area A = ka x^h.
#include "geo/kernels/landscape/stream_power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

/// A straight river of `cells` cells from the divide at x = 0 to the outlet at x = length_m, laid
/// out along a row (or a column) of a plane, forwards or backwards. Its two banks do not flow.
class River {
 public:
  enum class Course { east, west, north, south };

  River(int cells, double first_x_m, double length_m, Course course = Course::east)
      : cells_(cells),
        dx_m_((length_m - first_x_m) / cells),
        first_x_m_(first_x_m),
        along_row_(course == Course::east || course == Course::west),
        grid_(along_row_ ? Grid::plane(cells + 1, 3, dx_m_, 1.0)
                         : Grid::plane(4, cells + 1, 1.0, dx_m_)),
        z(grid_.size(), 0.0),
        area_m2(grid_.size(), 1.0) {
    graph.receiver.resize(grid_.size());
    std::iota(graph.receiver.begin(), graph.receiver.end(), 0);
    const bool reversed = course == Course::west || course == Course::south;
    for (int c = 0; c <= cells; ++c) {
      const int place = reversed ? cells - c : c;
      at_.push_back(along_row_ ? grid_.cell(place, 1) : grid_.cell(1, place));
    }
    for (int c = 0; c < cells; ++c) graph.receiver[at_[c]] = at_[c + 1];
    graph.order = downstream_order(graph.receiver);
  }
  /// Drainage area at the downstream face of each cell: second order in dx.
  void set_area_at_faces(double ka, double h) {
    for (int c = 0; c < cells_; ++c) {
      area_m2[at_[c]] = ka * std::pow(x_m(c) + 0.5 * dx_m_, h);
    }
  }
  void set_area_at_nodes(double ka, double h) {
    for (int c = 0; c < cells_; ++c) area_m2[at_[c]] = ka * std::pow(x_m(c), h);
  }
  /// Node c stands at first_x + c dx; the last one, `cells`, is the outlet.
  [[nodiscard]] double x_m(int c) const { return first_x_m_ + c * dx_m_; }
  [[nodiscard]] double& height(int c) { return z[at_[c]]; }
  [[nodiscard]] int cells() const { return cells_; }
  [[nodiscard]] double dx_m() const { return dx_m_; }

  void step(const StreamPower& law, float erodibility, double uplift_m_yr) {
    for (int c = 0; c < cells_; ++c) height(c) += uplift_m_yr * law.dt_yr;
    const std::vector<float> single{erodibility};
    incise<float, double>(grid_, graph, area_m2, single, law, z);
  }
  /// Steps until nothing moves any more.
  void settle(const StreamPower& law, float erodibility, double uplift_m_yr) {
    for (int step_number = 0; step_number < 20000; ++step_number) {
      const double before = height(0);
      step(law, erodibility, uplift_m_yr);
      if (std::abs(height(0) - before) < 1e-10 * std::abs(before)) return;
    }
    FAIL() << "no steady state";
  }

 private:
  int cells_;
  double dx_m_, first_x_m_;
  bool along_row_;
  Grid grid_;
  std::vector<Index> at_;

 public:
  FlowGraph graph;
  std::vector<double> z;
  std::vector<double> area_m2;
};

constexpr double kLength = 50e3;

/// Steady height above the outlet, p = 1 - h m / n.
double steady(double x, double uplift, double k, double m, double n, double ka, double h) {
  const double scale = std::pow(uplift / k, 1 / n) * std::pow(ka, -m / n), p = 1 - h * m / n;
  return std::abs(p) < 1e-12 ? scale * std::log(kLength / x)
                             : scale * (std::pow(kLength, p) - std::pow(x, p)) / p;
}

TEST(StreamPowerExact, FormulaGivesTheTabulatedNumbers) {
  EXPECT_NEAR(steady(1e3, 1e-3, 2e-5, 0.5, 1, 6.69, 1.67), 332.152, 5e-4);
  EXPECT_NEAR(steady(1e4, 1e-3, 2e-5, 0.5, 1, 6.69, 1.67), 162.881, 5e-4);
  EXPECT_NEAR(steady(1e3, 1e-3, 2e-5, 0.5, 1, 1.0, 2.0), 195.601, 5e-4);
  EXPECT_NEAR(steady(1e3, 1e-3, 2e-9, 1.0, 2, 6.69, 1.67), 4697.34, 5e-3);
}

double steady_error(int cells, bool at_faces, River::Course course) {
  River river(cells, 1e3, kLength, course);
  if (at_faces) {
    river.set_area_at_faces(6.69, 1.67);
  } else {
    river.set_area_at_nodes(6.69, 1.67);
  }
  river.settle({.dt_yr = 1e6}, 2e-5F, 1e-3);
  double error = 0.0;
  for (int c = 0; c < cells; ++c) {
    error = std::max(
        error, std::abs(river.height(c) - steady(river.x_m(c), 1e-3, 2e-5F, 0.5, 1, 6.69, 1.67)));
  }
  return error;
}

TEST(StreamPowerExact, SteadyProfileConvergesWithTheSecondOrderInAllFourDirections) {
  for (const auto course :
       {River::Course::east, River::Course::west, River::Course::north, River::Course::south}) {
    const double coarse = steady_error(100, true, course), fine = steady_error(200, true, course);
    EXPECT_LT(fine, 0.2);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15);
  }
}

TEST(StreamPowerExact, AreaAtNodesConvergesWithTheFirstOrderOnly) {
  const double coarse = steady_error(100, false, River::Course::east);
  const double fine = steady_error(200, false, River::Course::east);
  EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.15);
}

TEST(StreamPowerExact, SteadySlopesForSeveralExponents) {
  // 101 nodes 300 m apart, U = K = 1e-3, m = 0.5: S = (U / K)^(1/n) A^(-m/n).
  const double relief[] = {7.404181, 413.638120, 3435.622004};
  int which = 0;
  for (const double n : {1.0, 2.0, 4.0}) {
    River river(100, 300.0, 30300.0);
    river.set_area_at_nodes(6.69, 1.67);
    river.settle({.slope_exponent = n, .dt_yr = 1e5}, 1e-3F, 1e-3F);
    for (int c = 0; c < 100; ++c) {
      const double slope = (river.height(c) - river.height(c + 1)) / river.dx_m();
      const double expected = std::pow(6.69 * std::pow(river.x_m(c), 1.67), -0.5 / n);
      ASSERT_NEAR(slope / expected, 1.0, 1e-5) << "n = " << n << ", node " << c;
    }
    EXPECT_NEAR(river.height(0), relief[which], 2e-5 * relief[which]);
    ++which;
  }
}

TEST(StreamPowerExact, SteadySlopeForExponentBelowOne) {
  River river(100, 300.0, 30300.0);
  river.set_area_at_nodes(6.69, 1.67);
  river.settle({.slope_exponent = 0.7, .dt_yr = 1e5}, 1e-3F, 1e-3F);
  for (int c = 0; c < 100; ++c) {
    const double slope = (river.height(c) - river.height(c + 1)) / river.dx_m();
    const double expected = std::pow(6.69 * std::pow(river.x_m(c), 1.67), -0.5 / 0.7);
    ASSERT_NEAR(slope / expected, 1.0, 1e-5);
  }
}

/// L1 error of the response to a doubling of uplift, 2e5 yr after it.
double transient_error(int cells, double dt_yr, double* knick_height_m = nullptr) {
  const double u0 = 0.5e-3, u1 = 1e-3, time = 2e5;
  const double k = 2e-5F;
  River river(cells, 1e3, kLength);
  river.set_area_at_faces(6.69, 1.67);
  const auto tau = [&](double x) { return steady(x, 1.0, k, 0.5, 1, 6.69, 1.67); };
  for (int c = 0; c <= cells; ++c) river.height(c) = u0 * tau(river.x_m(c));
  const int steps = static_cast<int>(std::lround(time / dt_yr));
  for (int s = 0; s < steps; ++s) river.step({.dt_yr = dt_yr}, 2e-5F, u1);
  double error = 0.0;
  for (int c = 0; c < cells; ++c) {
    const double t = tau(river.x_m(c));
    error += std::abs(river.height(c) - (u0 * t + (u1 - u0) * std::min(time, t))) / cells;
  }
  if (knick_height_m != nullptr) *knick_height_m = river.height(0);
  return error;
}

TEST(StreamPowerExact, KnickpointConvergesWithTheFirstOrder) {
  double top = 0.0;
  const double coarse = transient_error(200, 5000.0), fine = transient_error(400, 2500.0, &top);
  EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.15);
  EXPECT_LT(transient_error(400, 625.0), 0.12);
  EXPECT_NEAR(top, 266.076, 0.5);
}

TEST(StreamPowerExact, ImplicitDropSolvesItsEquation) {
  EXPECT_NEAR(implicit_drop(100.0, 0.01, 2.0), 61.803399, 1e-6);
  EXPECT_NEAR(implicit_drop(100.0, 10.0, 0.5), 38.196601, 1e-6);
  for (const double n : {0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 4.0, 7.0}) {
    for (const double factor : {0.0, 1e-12, 1e-3, 1.0, 1e3, 1e12}) {
      for (const double s0 : {1e-6, 1.0, 1e4}) {
        const double s = implicit_drop(s0, factor, n);
        ASSERT_GE(s, 0.0);
        ASSERT_LE(s, s0);
        ASSERT_NEAR((s + factor * std::pow(s, n)) / s0, 1.0, 1e-9)
            << "n " << n << " F " << factor << " s0 " << s0;
      }
    }
  }
}

TEST(StreamPower, NeverClimbsNorDigsPits) {
  for (const Grid& grid : test::small_grids()) {
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      auto z = test::random_terrain(grid, seed);
      const auto outlets = find_outlets(grid, z);
      const auto before = z;
      const FlowGraph graph = route_water(grid, z, outlets).graph;
      std::vector<double> area(z.size());
      for (Index c = 0; c < grid.size(); ++c) area[c] = grid.area_m2(grid.row(c));
      graph.accumulate(area);
      const std::vector<float> single{1e-5F};
      incise<float, float>(grid, graph, area, single, {.slope_exponent = 1.3, .sea_level_m = 0.0},
                           z);
      for (Index c = 0; c < grid.size(); ++c) {
        const Index to = graph.receiver[c];
        ASSERT_LE(z[c], before[c]);
        if (before[c] > before[to] && to != c) {
          ASSERT_GE(z[c], z[to]);
        }
        if (before[c] >= 0.0F) {
          ASSERT_GE(z[c], 0.0F) << "rivers do not cut below the sea";
        }
      }
    }
  }
}

TEST(StreamPower, BreachingLeavesNoClimbOnTheWayToTheSea) {
  for (const Grid& grid : test::small_grids()) {
    auto z = test::random_terrain(grid, 11);
    const auto before = z;
    const FlowGraph graph = route_water(grid, z, find_outlets(grid, z)).graph;
    const double removed = breach_sills<float>(grid, graph, z);
    double lowered = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      lowered += grid.area_m2(grid.row(c)) * (static_cast<double>(before[c]) - z[c]);
      const Index to = graph.receiver[c];
      if (graph.receiver[to] != to) {
        ASSERT_LE(z[to], z[c]);
      }
    }
    EXPECT_GT(removed, 0.0);
    EXPECT_NEAR(lowered / removed, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace geo
