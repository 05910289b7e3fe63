// Ice of the erosion stage.
#include <gtest/gtest.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/stages.hpp"
#include "stages/erosion/icy_climate.hpp"
#include "stages/three_continents.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

State freeze_planet(Budget& budget, std::map<std::string, std::string> settings = {}) {
  settings.insert({{"erosion.steps", "2"}, {"erosion.climates", "1"}});
  return erode_three_continents(200.0F, settings, budget);
}

/// Ground that ice has hardly worn, and that is high enough for ice today.
const std::map<std::string, std::string> kHighGround{{"erosion.ice.abrasion", "1e-8"}};

template <class Value>
double land_mean(const State& state, double south_deg, double north_deg, Value&& value) {
  const Grid& grid = state.grid();
  const auto z = state.read(field::elevation);
  double sum = 0.0, area = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    const double latitude = std::abs(grid.latitude_deg(grid.row(c)));
    if (z[c] < 0.0F || latitude < south_deg || latitude > north_deg) continue;
    sum += grid.area_m2(grid.row(c)) * value(c);
    area += grid.area_m2(grid.row(c));
  }
  return sum / area;
}

TEST(Ice, LiesTowardsThePolesAndElevationIsItsSurface) {
  Budget budget;
  const State state = freeze_planet(budget, kHighGround);
  const auto ice = state.read(field::ice_thickness);
  const auto z = state.read(field::elevation);
  const auto thickness = [&](Index c) { return double{ice[c]}; };
  EXPECT_GT(land_mean(state, 70, 90, thickness), 200.0);
  EXPECT_LT(land_mean(state, 0, 40, thickness), 1.0);
  for (Index c = 0; c < state.grid().size(); ++c) {
    EXPECT_TRUE(ice[c] == 0.0F || ice[c] >= 1.0F);
    if (ice[c] > 0.0F) EXPECT_GT(z[c], 0.0F);
  }
  const double volume = area_sum<double>(state.grid(), thickness);
  EXPECT_NEAR(budget.at("ice_m3"), volume, 1e-9 * volume);
}

TEST(Ice, BudgetsOfIceRockAndSedimentClose) {
  for (const char* model : {"sediment", "detachment"}) {
    Budget budget;
    auto settings = kHighGround;
    settings["erosion.model"] = model;
    (void)freeze_planet(budget, settings);
    EXPECT_GT(budget.at("ice_snow_m3_yr"), 0.0);
    EXPECT_GT(budget.at("ice_melt_m3_yr") + budget.at("ice_calving_m3_yr"), 0.0);
    for (const auto& [name, value] : budget) {
      if (name.ends_with("closing_error"))
        EXPECT_LT(std::abs(value), 1e-12) << model << ' ' << name;
    }
  }
}

TEST(Ice, OfColdTimesWorksWhereThatOfTodayDoesNotReach) {
  Budget warm, cold, none;
  const State state = freeze_planet(cold);
  const State without = freeze_planet(warm, {{"erosion.ice.glacial_share", "0"}});
  const auto scoured = [](const State& s) {
    const auto taken = s.read(field::glacial_erosion);
    return land_mean(s, 50, 70, [&](Index c) { return std::max(0.0, double{taken[c]}); });
  };
  EXPECT_GT(scoured(state), 1.5 * scoured(without));
  EXPECT_GT(cold.at("rock_eroded_m3"), warm.at("rock_eroded_m3"));
  const auto taken = state.read(field::glacial_erosion);
  EXPECT_LT(land_mean(state, 0, 20, [&](Index c) { return std::abs(double{taken[c]}); }), 1.0);
  const State bare = freeze_planet(none, {{"erosion.ice.model", "none"}});
  EXPECT_FALSE(bare.has(field::ice_thickness));
  EXPECT_EQ(none.count("ice_m3"), 0U);
}

/// Share of a low continent between two parallels that lies under the ice of icy_climate.
double covered(double from_deg, double to_deg, double glacial_share) {
  constexpr float kHeight_m = 300.0F;
  const Pipeline pipeline = make_pipeline();
  const Grid grid = Grid::sphere(72, 36);
  std::vector<float> elevation_m(static_cast<std::size_t>(grid.size()), -4000.0F);
  const auto is_land = [&](Index c) {
    const double latitude = grid.latitude_deg(grid.row(c));
    return latitude > from_deg && latitude < to_deg;
  };
  for (Index c = 0; c < grid.size(); ++c) {
    if (is_land(c)) elevation_m[c] = kHeight_m;
  }
  ErosionParameters parameters;
  parameters.glacial_share = glacial_share;
  Context context;
  context.configuration = pipeline.parameters();
  const LandClimate climate = icy_climate(parameters, grid, elevation_m, context);
  double land_m2 = 0.0, iced_m2 = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (!is_land(c)) continue;
    land_m2 += grid.area_m2(grid.row(c));
    if (climate.ice_m[c] >= 10.0F) iced_m2 += grid.area_m2(grid.row(c));
  }
  return iced_m2 / land_m2;
}

// Where the same sun allows ice and none, the last cold time decides.
TEST(Ice, OverAPoleIsWhatColdTimesHaveLeft) {
  EXPECT_GT(covered(55.0, 90.0, 0.3), 0.9);
  EXPECT_LT(covered(55.0, 90.0, 0.0), 0.1) << "without cold times";
  EXPECT_GT(covered(65.0, 90.0, 0.0), 0.9) << "all of it is too cold at any time";
  EXPECT_LT(covered(50.0, 60.0, 0.3), 0.1) << "the warm times melt it";
}

// Without rivers and creep, which wear ground that is free of ice and so change the difference.
TEST(Ice, HoldsTheGroundDownAsFarAsMantleFloatsIt) {
  const std::map<std::string, std::string> unworn{{"erosion.ice.abrasion", "0"},
                                                  {"erosion.erodibility_yr", "0"},
                                                  {"erosion.diffusivity_m2_yr", "0"}};
  auto bare = unworn;
  bare["erosion.ice.model"] = "none";
  Budget with, without;
  const State state = freeze_planet(with, unworn);
  const State stiff = freeze_planet(without, bare);
  const auto ice = state.read(field::ice_thickness);
  const auto surface = state.read(field::elevation), ground = stiff.read(field::elevation);
  double sunk = 0.0, load = 0.0;
  const Grid& grid = state.grid();
  for (Index c = 0; c < grid.size(); ++c) {
    if (ice[c] <= 0.0F || ground[c] < 0.0F) continue;
    sunk += grid.area_m2(grid.row(c)) * (ground[c] - (surface[c] - ice[c]));
    load += grid.area_m2(grid.row(c)) * ice[c];
  }
  // 910 / 3300, less what the plate carries beside the ice and at sea.
  EXPECT_GT(sunk / load, 0.16);
  EXPECT_LT(sunk / load, 0.28);
}

#ifdef _OPENMP
TEST(Ice, SameBitsForAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  Budget one, four;
  omp_set_num_threads(1);
  const State first = freeze_planet(one);
  omp_set_num_threads(4);
  const State second = freeze_planet(four);
  omp_set_num_threads(threads);
  const auto same = [&](const Field<float>& field) {
    const auto a = first.read(field), b = second.read(field);
    return std::equal(a.begin(), a.end(), b.begin());
  };
  EXPECT_TRUE(same(field::elevation));
  EXPECT_TRUE(same(field::ice_thickness));
  EXPECT_TRUE(same(field::glacial_erosion));
  EXPECT_EQ(one, four);
}
#endif

}  // namespace
}  // namespace geo
