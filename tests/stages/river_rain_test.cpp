// Rivers that follow the rain: what drain() and the erosion stage make of a climate.
#include <gtest/gtest.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "stages/three_continents.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

LandClimate even_climate(const Grid& grid, float rain_mm_yr, float potential_mm_yr) {
  LandClimate climate;
  climate.precipitation_mm_yr.assign(grid.size(), rain_mm_yr);
  climate.potential_mm_yr.assign(grid.size(), potential_mm_yr);
  climate.sea_level_temperature_c.assign(grid.size(), 15.0F);
  climate.range_k.assign(grid.size(), 10.0F);
  return climate;
}

std::vector<double> drained(const Grid& grid, std::span<const float> z, const ErosionParameters& p,
                            const LandClimate* climate) {
  Drainage drainage;
  drain(p, grid, z, find_outlets(grid, z), drainage, climate);
  return drainage.area_m2;
}

TEST(RiverRain, OfTheReferenceRunoffEverywhereIsTheAreaOfLand) {
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 3);
    for (const std::string routing : {"d8", "mfd"}) {
      ErosionParameters p;
      p.flow_routing = routing;
      const auto climate = even_climate(grid, static_cast<float>(p.reference_runoff_mm_yr), 0.0F);
      const auto by_area = drained(grid, z, p, nullptr);
      const auto by_rain = drained(grid, z, p, &climate);
      for (Index c = 0; c < grid.size(); ++c) {
        if (z[c] < 0.0F) continue;
        ASSERT_NEAR(by_rain[c] / by_area[c], 1.0, 1e-6);
      }
    }
  }
}

/// A cone of land around a bowl with a rim at 200 m, and a gap in it at 150 m: 40 x 40 cells of
/// 10 km.
struct Bowl {
  Grid grid = Grid::plane(40, 40, 1e4, 1e4);
  std::vector<float> z = std::vector<float>(grid.size());
  int gap = 0;      ///< column of the rim in the gap
  int flooded = 0;  ///< cells below the gap, inside

  Bowl() {
    for (Index c = 0; c < grid.size(); ++c) {
      const double r = 1e-4 * std::hypot(grid.x_m(grid.column(c)), grid.y_m(grid.row(c)));
      z[c] = static_cast<float>(r < 12.0 ? 50.0 + 12.5 * r : 200.0 - 30.0 * (r - 12.0));
      if (r < 12.0 && z[c] < 150.0F) ++flooded;
      if (r < 12.0) gap = std::max(gap, grid.column(c));
    }
    for (int i = 20; i < grid.nx(); ++i) {
      float& height = z[grid.cell(i, 20)];
      height = std::min(height, 150.0F);
    }
  }
};

TEST(RiverRain, OfAClosedBasinCutsNoSill) {
  const Bowl bowl;
  const ErosionParameters p;
  const auto largest_beyond = [&](const std::vector<double>& area) {
    double largest = 0.0;
    for (Index c = 0; c < bowl.grid.size(); ++c) {
      if (bowl.grid.column(c) > bowl.gap && bowl.z[c] > 0.0F) {
        largest = std::max(largest, area[c]);
      }
    }
    return largest;
  };
  const auto wet = even_climate(bowl.grid, 1000.0F, 500.0F);
  const auto dry = even_climate(bowl.grid, 200.0F, 2500.0F);
  const double cell_m2 = bowl.grid.area_m2(0);
  // 450 cells drain to the bowl.
  EXPECT_GT(largest_beyond(drained(bowl.grid, bowl.z, p, &wet)), 400.0 * cell_m2);
  EXPECT_LT(largest_beyond(drained(bowl.grid, bowl.z, p, &dry)), 1.0 * cell_m2);
}

TEST(RiverRain, OpenLakesLoseWhatTheAirTakes) {
  // All land and no sea but the edges; the lake stands to its sill.
  const Bowl bowl;
  ErosionParameters p;
  p.flow_routing = "d8";
  const auto climate = even_climate(bowl.grid, 1000.0F, 1100.0F);
  const auto area = drained(bowl.grid, bowl.z, p, &climate);
  // What leaves: runoff of all land, less what a flooded cell loses beside the land's share.
  const double e = land_evaporation(1000.0, 1100.0), cell_m2 = bowl.grid.area_m2(0);
  int land = 0;
  double left = 0.0;
  const auto outlets = find_outlets(bowl.grid, bowl.z);
  for (const float height : bowl.z) land += height >= 0.0F ? 1 : 0;
  for (Index c = 0; c < bowl.grid.size(); ++c) {
    if (outlets[c] != 0) left += area[c];
  }
  const double least = p.least_runoff_mm_yr * (bowl.grid.size() - land);  // at sea, never less
  EXPECT_NEAR(left * p.reference_runoff_mm_yr / cell_m2,
              (1000.0 - e) * land - (1100.0 - e) * bowl.flooded + least,
              1e-3 * (1000.0 - e) * land);
}

State erode_planet(const std::string& discharge, Budget& budget) {
  return erode_three_continents(100.0F, {{"erosion.discharge", discharge}, {"erosion.steps", "3"}},
                                budget);
}

TEST(RiverRain, FlowThatNoSlopeLeadsIsRefused) {
  Budget budget;
  EXPECT_THROW(
      erode_three_continents(
          100.0F, {{"erosion.flow_routing", "mfd"}, {"erosion.flow_exponent", "0"}}, budget),
      ConfigurationError);
}

TEST(RiverRain, WearsWetLandFasterThanDryAndLeavesDrainageAreaWhatItIs) {
  Budget budget, even;
  const State state = erode_planet("rain", budget), other = erode_planet("area", even);
  EXPECT_LT(std::abs(budget.at("rock_closing_error")), 1e-12);
  EXPECT_LT(std::abs(budget.at("sediment_closing_error")), 1e-12);
  const Grid& grid = state.grid();
  const auto rate = [&](const State& s, double south, double north) {
    const auto lowered = s.read(field::erosion_rate);
    const auto z = s.read(field::elevation);
    double sum = 0.0, area = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      const double latitude = grid.latitude_deg(grid.row(c));
      if (z[c] < 0.0F || latitude < south || latitude > north) continue;
      sum += grid.area_m2(grid.row(c)) * lowered[c];
      area += grid.area_m2(grid.row(c));
    }
    return sum / area;
  };
  // Equatorial rain against the subtropics.
  EXPECT_GT(rate(state, -8, 8) / rate(state, 20, 30),
            1.2 * rate(other, -8, 8) / rate(other, 20, 30));
  double roots = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (state.read(field::flow_receiver)[c] == c) roots += state.read(field::drainage_area)[c];
  }
  EXPECT_NEAR(roots / grid.total_area_m2(), 1.0, 1e-12);
}

#ifdef _OPENMP
TEST(RiverRain, SameBitsForAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  Budget one, two;
  omp_set_num_threads(1);
  const State first = erode_planet("rain", one);
  omp_set_num_threads(2);
  const State second = erode_planet("rain", two);
  omp_set_num_threads(threads);
  const auto same = [](auto a, auto b) { return std::equal(a.begin(), a.end(), b.begin()); };
  EXPECT_TRUE(same(first.read(field::elevation), second.read(field::elevation)));
  EXPECT_EQ(one, two);
}
#endif

}  // namespace
}  // namespace geo
