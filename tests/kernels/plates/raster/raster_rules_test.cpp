// The rules of plates as height maps (Viitanen 2012, 7.4), each by itself.
#include "geo/kernels/plates/raster/raster_rules.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace geo {
namespace {

TEST(RasterRules, TheLowerOfTwoCrustsSinksWhicheverComes) {
  const RasterCrust low{0.3F, 5, 0}, high{0.6F, 2, 0}, land{1.4F, 0, 0};
  EXPECT_EQ(raster_meeting(low, high), RasterMeeting::first_sinks);
  EXPECT_EQ(raster_meeting(high, low), RasterMeeting::second_sinks);
  EXPECT_EQ(raster_meeting(land, high), RasterMeeting::second_sinks);
  EXPECT_EQ(raster_meeting(high, land), RasterMeeting::first_sinks);
}

TEST(RasterRules, OfEqualFloorsTheOlderSinks) {
  const RasterCrust old{0.1F, 10, 0}, young{0.1F, 90, 0};
  EXPECT_EQ(raster_meeting(old, young), RasterMeeting::first_sinks);
  EXPECT_EQ(raster_meeting(young, old), RasterMeeting::second_sinks);
  EXPECT_EQ(raster_meeting(young, young), RasterMeeting::second_sinks);
}

TEST(RasterRules, LandDoesNotSink) {
  const RasterCrust land{1.0F, 0, 0}, mountain{3.0F, 0, 0};
  EXPECT_EQ(raster_meeting(land, mountain), RasterMeeting::both_stay);
  EXPECT_EQ(raster_meeting(mountain, land), RasterMeeting::both_stay);
}

TEST(RasterRules, AStepTakesAFloorsHeightAtMost) {
  EXPECT_FLOAT_EQ(raster_sinking(0.75F, 0.1, 0.5).after, 0.65F);
  EXPECT_FLOAT_EQ(raster_sinking(0.06F, 0.1, 0.5).after, 0.0F);
}

TEST(RasterRules, MoreMeltsTheDeeperWhatSinksLies) {
  // r (1 - h) of what went down.
  EXPECT_NEAR(raster_sinking(0.1F, 0.1, 0.5).melt, 0.5 * 0.9 * 0.1, 1e-7);
  EXPECT_NEAR(raster_sinking(0.8F, 0.1, 0.5).melt, 0.5 * 0.2 * 0.1, 1e-7);
  EXPECT_NEAR(raster_sinking(0.04F, 0.1, 0.25).melt, 0.25 * 0.96 * 0.04, 1e-7);
  EXPECT_EQ(raster_sinking(0.5F, 0.1, 0.0).melt, 0.0F);
}

TEST(RasterRules, MagmaRisesInlandAlongTheLowerPlatesMotion) {
  using Way = std::array<double, 2>;
  // Against each other: by the lower plate's own motion. Behind one that flees: by the difference.
  EXPECT_EQ(raster_arc_offset<2>(Way{2.0, 0.0}, Way{-1.0, 0.5}, 10.0), (Way{20.0, 0.0}));
  EXPECT_EQ(raster_arc_offset<2>(Way{2.0, 1.0}, Way{0.5, 0.0}, 10.0), (Way{15.0, 10.0}));
  EXPECT_EQ(raster_arc_offset<3>({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}, 4.0),
            (std::array<double, 3>{0.0, 0.0, 4.0}));
}

TEST(RasterRules, MagmaScattersToBothSidesAndMostlyLittle) {
  EXPECT_DOUBLE_EQ(raster_scatter(0), -1.0);
  EXPECT_NEAR(raster_scatter(0xFFFFFFFFU), 1.0, 1e-8);
  EXPECT_DOUBLE_EQ(raster_scatter(0x80000000U), 0.0);
  EXPECT_DOUBLE_EQ(raster_scatter(0xC0000000U), 0.125);
}

TEST(RasterRules, TheLargerContinentTakesAShareOfTheSmallerOnesCrust) {
  RasterCrust small{2.0F, 0, 0}, large{3.0F, 0, 0};
  raster_fold(small, large, 0.02, 7);
  EXPECT_FLOAT_EQ(small.height, 1.96F);
  EXPECT_FLOAT_EQ(large.height, 3.04F);
  EXPECT_EQ(large.folded, 2 * 7 + 1) << "an orogeny of two continents at step 7";
  EXPECT_EQ(small.folded, 0);
  RasterCrust shoal{0.5F, 0, 0}, floor{0.4F, 0, 0};
  raster_fold(shoal, floor, 0.02, 7);
  EXPECT_EQ(floor.folded, 0) << "below the sea nothing folds";
}

TEST(RasterRules, FoldingSlowsPlatesTheLessTheHeavierTheyAre) {
  // v - v_0 f m / M
  EXPECT_NEAR(raster_speed_left(1.0, 10.0, 1000.0, 2.0, 1.0), 0.98, 1e-12);
  EXPECT_NEAR(raster_speed_left(1.0, 10.0, 4000.0, 2.0, 1.0), 0.995, 1e-12);
  EXPECT_NEAR(raster_speed_left(0.5, 10.0, 1000.0, 2.0, 1.0), 0.96, 1e-12);
  EXPECT_EQ(raster_speed_left(0.01, 10.0, 1000.0, 2.0, 1.0), 0.0) << "never backwards";
  EXPECT_EQ(raster_speed_left(1.0, 10.0, 1000.0, 0.0, 1.0), 1.0);
}

constexpr RasterCycle::Limits kLimits{0.2, 0.15, 10, 600};

TEST(RasterRules, ACycleEndsWhenPlatesAreSlow) {
  RasterCycle cycle;
  EXPECT_FALSE(cycle.is_over(kLimits, {10 * 0.21, 100.0, 10}));
  EXPECT_TRUE(cycle.is_over(kLimits, {10 * 0.19, 100.0, 10}));
}

TEST(RasterRules, ACycleEndsWhenMomentumHasFallenFarBelowItsPeak) {
  RasterCycle cycle;
  EXPECT_FALSE(cycle.is_over(kLimits, {10.0, 50.0, 10}));
  EXPECT_FALSE(cycle.is_over(kLimits, {10.0, 100.0, 10}));
  EXPECT_FALSE(cycle.is_over(kLimits, {10.0, 16.0, 10}));
  EXPECT_TRUE(cycle.is_over(kLimits, {10.0, 14.0, 10}));
}

TEST(RasterRules, ACycleEndsAfterStepsInWhichNoContinentsMet) {
  RasterCycle cycle;
  for (int k = 0; k < 10; ++k) cycle.note(false);
  EXPECT_FALSE(cycle.is_over(kLimits, {10.0, 100.0, 10}));
  cycle.note(true);
  for (int k = 0; k < 10; ++k) cycle.note(false);
  EXPECT_FALSE(cycle.is_over(kLimits, {10.0, 100.0, 10})) << "a meeting begins the count anew";
  cycle.note(false);
  EXPECT_TRUE(cycle.is_over(kLimits, {10.0, 100.0, 10}));
}

TEST(RasterRules, ACycleEndsAfterItsStepsOrWithOnePlateLeft) {
  RasterCycle cycle;
  EXPECT_TRUE(cycle.is_over(kLimits, {1.0, 100.0, 1}));
  for (int k = 0; k < 600; ++k) {
    EXPECT_FALSE(cycle.is_over(kLimits, {10.0, 100.0, 10}));
    cycle.begin_step();
  }
  EXPECT_TRUE(cycle.is_over(kLimits, {10.0, 100.0, 10}));
}

TEST(RasterRules, PlatesFollowTheirOwnSettingsOrTheCommonOnes) {
  RasterSettings settings;
  settings.own.resize(2);
  settings.own[1].folding_ratio = 0.3;
  const auto ratio = [&](int plate) {
    return settings.of(plate, &RasterPlateSettings::folding_ratio, 0.02);
  };
  EXPECT_EQ(ratio(0), 0.02);
  EXPECT_EQ(ratio(1), 0.3);
  EXPECT_EQ(ratio(2), 0.02);
}

}  // namespace
}  // namespace geo
