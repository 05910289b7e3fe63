#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/moisture.hpp"
#include "geo/kernels/climate/orography.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"

namespace geo {
namespace {

struct Air {
  explicit Air(const Grid& grid)
      : size(static_cast<std::size_t>(grid.size())),
        east(size, 6.0F),
        north(size, 0.0F),
        mixing(size, 2e5F),
        activity(size, 1.0F),
        eddies(size, 0.0F),
        saturated(size, 40.0F),
        water(size, 0.0F),
        land_evaporation(size, 0.0F),
        column(size, 20.0) {}
  [[nodiscard]] MoistureSeason season() {
    return {east, north, mixing, activity, eddies, saturated, water, land_evaporation, column};
  }
  void solve(const Grid& grid, const MoistureBudget& model) {
    const MoistureSeason one = season();
    SteadyMoisture(grid, model, {&one, 1}).solve();
  }
  std::size_t size;
  std::vector<float> east, north, mixing, activity, eddies, saturated, water, land_evaporation;
  std::vector<double> column;
};

TEST(Moisture, WhatEvaporatesRains) {
  const Grid grid = Grid::sphere(72, 36);
  Air air(grid);
  for (Index c = 0; c < grid.size(); ++c) air.water[c] = grid.column(c) < 40 ? 0.2F : 0.0F;
  MoistureBudget model;
  model.sweeps = 400;
  air.solve(grid, model);
  double evaporation = 0.0, rain = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    const double area = grid.area_m2(grid.row(c));
    evaporation += area * air.water[c] * std::max(0.0, air.saturated[c] - air.column[c]);
    rain += area * rain_mm_d(model, air.column[c], air.saturated[c], 1.0, 0.0);
  }
  EXPECT_NEAR(rain / evaporation, 1.0, 1e-4);
}

TEST(Moisture, ClosedBudgetHasRainForAllThatEvaporates) {
  const Grid grid = Grid::sphere(72, 36);
  Air air(grid);
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c), j = grid.row(c);
    air.water[c] = i < 40 ? 0.2F : 0.0F;
    air.saturated[c] = static_cast<float>(2.0 + 45.0 * std::cos(grid.latitude_deg(j) / 57.3));
    air.activity[c] = i == 50 ? 3.0F : 1.0F;  // a range that lifts the air
    air.eddies[c] = i > 30 ? 0.5F : 0.0F;
    air.land_evaporation[c] = i < 40 ? 0.0F : 0.1F;
    air.mixing[c] = 8e5F;
  }
  const MoistureSeason season = air.season();
  SteadyMoisture steady(grid, MoistureBudget{}, {&season, 1});
  steady.solve();
  for (const double closed : {1e-3, 1e-7}) {
    steady.close(0, closed);
    double evaporation = 0.0, rain = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      const double area = grid.area_m2(grid.row(c)), w = air.column[c];
      evaporation +=
          area * (air.water[c] * std::max(0.0, air.saturated[c] - w) + air.land_evaporation[c]);
      rain += area * rain_mm_d({}, w, air.saturated[c], air.activity[c], air.eddies[c]);
    }
    EXPECT_NEAR(rain / evaporation, 1.0, closed);  // what close() promises
  }
}

TEST(Moisture, WhatARangeTakesTheAirLacksBehindIt) {
  const Grid grid = Grid::sphere(72, 36);
  Air air(grid), level(grid);
  for (Index c = 0; c < grid.size(); ++c) {
    air.water[c] = level.water[c] = grid.column(c) < 36 ? 0.2F : 0.0F;
    if (grid.column(c) == 42) air.activity[c] = 2.5F;
  }
  for (Air* each : {&air, &level}) {
    const MoistureSeason season = each->season();
    SteadyMoisture steady(grid, MoistureBudget{}, {&season, 1});
    steady.solve();
    steady.close(0);
  }
  const Index on = grid.cell(42, 18), behind = grid.cell(43, 18);
  EXPECT_GT(rain_mm_d({}, air.column[on], 40.0, 2.5, 0.0),
            rain_mm_d({}, level.column[on], 40.0, 1.0, 0.0));
  EXPECT_LT(air.column[behind], 0.97 * level.column[behind]);
}

TEST(Moisture, RainFallsOffDownwindOfTheCoast) {
  const Grid grid = Grid::sphere(72, 36);
  Air air(grid);
  for (Index c = 0; c < grid.size(); ++c) air.water[c] = grid.column(c) < 36 ? 0.2F : 0.0F;
  const MoistureBudget model;
  air.solve(grid, model);
  for (int i = 37; i < 60; ++i) {
    EXPECT_LT(air.column[grid.cell(i, 18)], air.column[grid.cell(i - 1, 18)]) << i;
  }
}

TEST(Moisture, LeeOfARangeIsDry) {
  const Grid grid = Grid::sphere(72, 36);
  Air air(grid), flat(grid);
  for (Index c = 0; c < grid.size(); ++c) {
    air.water[c] = flat.water[c] = grid.column(c) < 36 ? 0.2F : 0.0F;
    if (grid.column(c) == 42) air.saturated[c] = 12.0F;  // cold air over the crest
  }
  MoistureBudget model;
  model.rain_time_d = 0.8;  // so that a crest of one cell counts
  air.solve(grid, model);
  flat.solve(grid, model);
  EXPECT_GT(rain_mm_d(model, air.column[grid.cell(42, 18)], 12.0, 1.0, 0.0),
            1.5 * rain_mm_d(model, flat.column[grid.cell(42, 18)], 40.0, 1.0, 0.0));
  EXPECT_LT(air.column[grid.cell(44, 18)], 0.8 * flat.column[grid.cell(44, 18)]);
}

TEST(Moisture, SeasonsSideBySideDoNotTouchEachOther) {
  const Grid grid = Grid::sphere(36, 18);
  std::vector<Air> together(3, Air(grid)), alone;
  for (std::size_t k = 0; k < together.size(); ++k) {
    for (Index c = 0; c < grid.size(); ++c) {
      together[k].water[c] = grid.column(c) < 18 ? 0.1F * static_cast<float>(k + 1) : 0.0F;
      together[k].north[c] = static_cast<float>(k) - 1.0F;
    }
  }
  alone = together;
  const MoistureBudget model;
  std::vector<MoistureSeason> seasons;
  for (Air& air : together) seasons.push_back(air.season());
  SteadyMoisture(grid, model, seasons).solve();
  for (std::size_t k = 0; k < alone.size(); ++k) {
    alone[k].solve(grid, model);
    EXPECT_EQ(together[k].column, alone[k].column) << k;
  }
  EXPECT_NE(together[0].column, together[1].column);
}

// Of twice as humid air eddies wring four times as much, ascent eight times.
TEST(Moisture, AscentRainsMoreSharplyThanEddies) {
  MoistureBudget model;
  model.humidity_exponent = 2;
  EXPECT_NEAR(rain_mm_d(model, 20.0, 40.0, 0.0, 1.0), 4.0 * rain_mm_d(model, 10.0, 40.0, 0.0, 1.0),
              1e-12);
  EXPECT_NEAR(rain_mm_d(model, 20.0, 40.0, 1.0, 0.0), 8.0 * rain_mm_d(model, 10.0, 40.0, 1.0, 0.0),
              1e-12);
}

TEST(SeaEvaporation, WindIsThatOfAirEddiesAndGusts) {
  EXPECT_DOUBLE_EQ(wind_over_sea_m_s(0.0, 0.0, 0.0), 4.0);
  EXPECT_DOUBLE_EQ(wind_over_sea_m_s(-3.0, 0.0, 0.0), 5.0);
  EXPECT_DOUBLE_EQ(wind_over_sea_m_s(4.0, -4.0, 4.0), 8.0);
}

TEST(SeaEvaporation, ColdAirIsThatWhichComesFromTheCold) {
  const Grid grid = Grid::sphere(72, 36);
  const auto size = static_cast<std::size_t>(grid.size());
  std::vector<float> warmer_north(size), east(size, 8.0F), north(size, -5.0F);
  for (Index c = 0; c < grid.size(); ++c) {
    warmer_north[c] = static_cast<float>(0.5 * grid.latitude_deg(grid.row(c)));
  }
  const double slope_k_m = 2.5 / grid.spacing_north_m(18);
  const Index here = grid.cell(10, 18);
  EXPECT_EQ(cold_advection_k_s(grid, warmer_north, east, north)[here], 0.0F);
  for (float& wind : north) wind = 5.0F;
  EXPECT_NEAR(cold_advection_k_s(grid, warmer_north, east, north)[here], 5.0 * slope_k_m,
              1e-5 * slope_k_m);
}

TEST(UpwindLift, WindwardRisesLeeSinks) {
  const Grid grid = Grid::plane(60, 20, 10e3, 10e3);
  const auto size = static_cast<std::size_t>(grid.size());
  std::vector<float> h(size), lift(size);
  for (Index c = 0; c < grid.size(); ++c) {
    h[c] = std::max(0.0F, 2000.0F - 400.0F * std::abs(grid.column(c) - 30.0F));
  }
  upwind_lift(grid, h, std::vector<float>(size, 5.0F), std::vector<float>(size, 0.0F), 40e3, lift);
  EXPECT_NEAR(lift[grid.cell(5, 10)], 0.0, 1e-3);
  EXPECT_GT(lift[grid.cell(28, 10)], 400.0F);
  EXPECT_LT(lift[grid.cell(35, 10)], -400.0F);
  upwind_lift(grid, h, std::vector<float>(size, -5.0F), std::vector<float>(size, 0.0F), 40e3, lift);
  EXPECT_LT(lift[grid.cell(25, 10)], -400.0F) << "the other way round in the opposite wind";
}

TEST(ConservativeRemapping, AveragesKeepTheLand) {
  const Grid fine = Grid::sphere(100, 50), coarse = Grid::sphere(36, 18);
  const ConservativeRemapping remapping(fine, coarse);
  std::vector<float> h(static_cast<std::size_t>(fine.size()));
  for (Index c = 0; c < fine.size(); ++c) h[c] = (c * 7919) % 13 < 5 ? 100.0F : -100.0F;
  const auto size = static_cast<std::size_t>(coarse.size());
  std::vector<float> land(size), height(size), coverage(size);
  remapping.average_elevation(h, land, height, coverage);
  for (std::size_t c = 0; c < size; ++c) {
    ASSERT_NEAR(coverage[c], 1.0F, 1e-5F);
    ASSERT_NEAR(height[c], 100.0F * land[c], 1e-3F);
  }
}

TEST(ConservativeRemapping, SplineKeepsConstantsAndRangesAndCrossesPoles) {
  const Grid fine = Grid::sphere(200, 100), coarse = Grid::sphere(36, 18);
  const ConservativeRemapping remapping(fine, coarse);
  std::vector<float> values(static_cast<std::size_t>(coarse.size()), 3.0F);
  std::vector<float> row(200), scratch(200);
  Interpolator(remapping, values).row(99, row, scratch);
  for (const float v : row) ASSERT_NEAR(v, 3.0F, 1e-5F);
  // x of the unit vector is smooth over the pole; a linear function comes back almost unchanged.
  for (Index c = 0; c < coarse.size(); ++c) {
    values[c] = static_cast<float>(coarse.unit_vector(coarse.column(c), coarse.row(c))[0]);
  }
  const Interpolator smooth(remapping, values);
  for (const int j : {0, 1, 50, 98, 99}) {
    smooth.row(j, row, scratch);
    for (int i = 0; i < 200; ++i) ASSERT_NEAR(row[i], fine.unit_vector(i, j)[0], 0.02);
  }
}

TEST(SaturatedColumn, FollowsClausiusClapeyron) {
  EXPECT_NEAR(saturated_column_mm(27.0), 64.0, 2.0);
  EXPECT_NEAR(std::log(saturated_column_mm(15.5) / saturated_column_mm(14.5)), 0.062, 0.005);
}

TEST(Blueprint, TemperatureHasItsNumbers) {
  const BlueprintClimate model;
  const double greenhouse = 5.0 * std::log(2.0);
  EXPECT_NEAR(blueprint_temperature_c(model, 0, 0, 0, 1.0), 28.0 + greenhouse, 1e-9);
  EXPECT_NEAR(blueprint_temperature_c(model, 30, 2000, 0, 1.0), 28 - 6.3 - 12 + greenhouse, 1e-9);
  EXPECT_NEAR(blueprint_temperature_c(model, 30, -1, 0, 1.0), 28 - 6.3 + 2 + greenhouse, 1e-9);
  EXPECT_NEAR(blueprint_temperature_c(model, 30, 0, 1000, 1.0), 28 - 6.3 - 4 + greenhouse, 1e-9);
  EXPECT_EQ(blueprint_temperature_c(model, 90, 9000, 3000, 1.0), -70.0);
}

TEST(Blueprint, PrecipitationHasItsNumbers) {
  const BlueprintClimate model;
  for (const auto& [latitude, rain] : std::vector<std::pair<double, double>>{{0, 2000},
                                                                             {9, 2000},
                                                                             {15, 1300},
                                                                             {20, 600},
                                                                             {35, 250},
                                                                             {50, 900},
                                                                             {70, 400},
                                                                             {90, 150}}) {
    EXPECT_NEAR(hadley_precipitation_mm_yr(latitude), rain, 1e-9) << latitude;
    EXPECT_NEAR(hadley_precipitation_mm_yr(-latitude), rain, 1e-9) << latitude;
  }
  EXPECT_NEAR(blueprint_precipitation_mm_yr(model, 600, 0, 0, 800, 1.0, 0), 600 * std::exp(-1),
              1e-9);
  EXPECT_NEAR(blueprint_precipitation_mm_yr(model, 600, 0, 1000, 0, 1.0, 0), 600 * std::exp(-0.4),
              1e-9);
  EXPECT_NEAR(blueprint_precipitation_mm_yr(model, 600, 0, -1, 0, 0.25, 0), 360.0, 1e-9);
  EXPECT_EQ(blueprint_precipitation_mm_yr(model, 0, -900, 0, 0, 1.0, 0), 20.0);
}

TEST(Blueprint, LeeOfARangeIsDry) {
  const Grid grid = Grid::plane(100, 20, 20e3, 20e3);
  const std::vector<double> latitude(20, 45.0);  // westerlies
  const auto size = static_cast<std::size_t>(grid.size());
  std::vector<float> h(size), land(size), rain(size);
  for (Index c = 0; c < grid.size(); ++c) {
    land[c] = grid.column(c) < 20 ? 0.0F : 1.0F;
    h[c] = grid.column(c) == 50 ? 2000.0F : 0.0F;
  }
  blueprint_orographic_precipitation(grid, {}, latitude, land, h, rain);
  const auto at = [&](int column) { return rain[grid.cell(column, 10)]; };
  EXPECT_NEAR(at(50) - at(48), 0.8 * 2000, 80.0)
      << "0.8 mm per metre of lift, less two cells of decay from the sea";
  EXPECT_LT(at(51), at(48) - 500.0F) << "about 0.4 mm per metre in the shadow";
  EXPECT_GT(at(70), at(51) + 300.0F) << "which wears off";
  EXPECT_GT(at(22), at(40)) << "the sea upwind feeds the coast";
}

}  // namespace
}  // namespace geo
