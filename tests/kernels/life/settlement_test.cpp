#include "geo/kernels/life/settlement.hpp"

#include <gtest/gtest.h>

namespace geo {
namespace {

SettlementLimits at(double mean_c, double range_k, double annual_mm, double seasonality = 0.0) {
  return settlement_limits(harmonic_months(mean_c, range_k, annual_mm, seasonality));
}

TEST(Settlement, WetBulbsAsTheTableOfStullHasThem) {
  // His worked example, and saturated air, whose wet bulb is as warm as the air.
  EXPECT_NEAR(wet_bulb_c(20.0, 0.5), 13.7, 0.05);
  for (const double t : {0.0, 15.0, 30.0}) EXPECT_NEAR(wet_bulb_c(t, 0.99), t, 0.6) << t;
  EXPECT_LT(wet_bulb_c(40.0, 0.1), wet_bulb_c(40.0, 0.2));
}

TEST(Settlement, HalfOfWarmthAndWaterLiesWhereRamankuttyHasIt) {
  // 1334 degree days: a constant (5 + 1334 / 365.25) degC.
  EXPECT_NEAR(at(5.0 + 1334.0 / 365.25, 0.0, 800.0).warmth, 0.5, 1e-9);
  EXPECT_GT(at(10.0, 20.0, 700.0).warmth, 0.95);  // central Europe
  EXPECT_LT(at(-10.0, 45.0, 300.0).warmth, 0.2);  // Yakutsk
  EXPECT_LT(at(25.0, 10.0, 50.0).water, 0.02);    // Sahara
  EXPECT_GT(at(10.0, 20.0, 700.0).water, 0.95);
  double before = 0.0;
  for (double rain = 0.0; rain < 3000.0; rain += 100.0) {
    const double water = at(20.0, 10.0, rain).water;
    EXPECT_GE(water, before);
    before = water;
  }
}

TEST(Settlement, HeatTellsOnlyWhereItIsHotAndDampMoreThanDry) {
  EXPECT_EQ(at(10.0, 20.0, 700.0).heat, 1.0);
  const double rainforest = at(27.0, 2.0, 2500.0).heat;
  EXPECT_GT(rainforest, 0.4);
  EXPECT_LT(rainforest, 0.8);
  EXPECT_LT(at(29.0, 2.0, 2500.0).heat, rainforest);
  EXPECT_LT(rainforest, at(27.0, 2.0, 200.0).heat);
  EXPECT_LT(at(35.0, 0.0, 3000.0).heat, 0.1) << "nobody works at a wet-bulb globe of 33 degC";
}

TEST(Settlement, TemperateForestFeedsMorePeopleThanRainforest) {
  const double temperate = at(11.0, 20.0, 900.0).product(),
               forest = at(26.0, 2.0, 2500.0).product();
  EXPECT_GT(temperate, 0.9);
  EXPECT_LT(forest, 0.5);
  EXPECT_GT(at(24.0, 8.0, 1100.0, 0.8).product(), forest) << "monsoon lands";
  EXPECT_LT(at(2.0, 35.0, 500.0).product(), 0.8 * temperate) << "taiga";
}

TEST(Settlement, SlopesAreThoseOfFieldsAtAnyLengthOfCells) {
  EXPECT_EQ(slope_limit(0.05), 1.0);
  EXPECT_EQ(slope_limit(0.5), 0.0);
  EXPECT_NEAR(slope_limit(0.265), 0.5, 1e-12);
  // Ground whose range grows with the root of the length has one slope.
  EXPECT_NEAR(field_slope(100.0, 4000.0), field_slope(400.0, 64000.0), 1e-12);
  EXPECT_EQ(field_slope(50.0, 500.0), 0.1);
}

}  // namespace
}  // namespace geo
