// What closed lines on a planet enclose.
#include "geo/kernels/plates/region_outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geo {
namespace {

using Ring = std::vector<Centre>;

RegionOutline region(const std::vector<Ring>& rings) { return RegionOutline(rings); }

/// Share of the sphere within, from places on a grid fine enough for the tests here.
double share(const RegionOutline& region) {
  double inside = 0.0, all = 0.0;
  for (double latitude = -89.75; latitude < 90.0; latitude += 0.5) {
    const double weight = std::cos(latitude * std::numbers::pi / 180.0);
    for (double longitude = -179.75; longitude < 180.0; longitude += 0.5) {
      all += weight;
      if (region.holds({latitude, longitude})) inside += weight;
    }
  }
  return inside / all;
}

/// Share of the sphere between two parallels and two meridians.
double box_share(double south, double north, double width) {
  const auto s = [](double degrees) { return std::sin(degrees * std::numbers::pi / 180.0); };
  return 0.5 * (s(north) - s(south)) * width / 360.0;
}

TEST(RegionOutline, ABoxHoldsItsShareOfTheSphereWhereverItLies) {
  for (const double west : {-10.0, 100.0, 165.0, 179.5, -200.0, 340.0}) {
    Ring box{{-20.0, west}, {-20.0, west + 30.0}, {40.0, west + 30.0}, {40.0, west}};
    const double wanted = box_share(-20.0, 40.0, 30.0);
    EXPECT_NEAR(share(region({box})), wanted, 1e-4) << west;
    // Drawn the other way round, closed by its first place again, within -180 to 180.
    for (Centre& at : box) at.longitude_deg = std::remainder(at.longitude_deg, 360.0);
    box = {box[3], box[2], box[1], box[0], box[3]};
    EXPECT_NEAR(share(region({box})), wanted, 1e-4) << west;
  }
}

TEST(RegionOutline, PartsCutAlongTheDateLineAreOne) {
  const RegionOutline parts = region(
      {{{0, 170}, {0, 180}, {10, 180}, {10, 170}}, {{0, -180}, {0, -160}, {10, -160}, {10, -180}}});
  const RegionOutline whole = region({{{0, 170}, {0, -160}, {10, -160}, {10, 170}}});
  EXPECT_NEAR(share(parts), box_share(0.0, 10.0, 30.0), 1e-4);
  EXPECT_EQ(share(parts), share(whole));
  EXPECT_TRUE(parts.holds({5.0, 179.9}));
  EXPECT_TRUE(parts.holds({5.0, -179.9}));
  EXPECT_FALSE(parts.holds({5.0, 0.0}));
}

TEST(RegionOutline, APolarCapIsTheSameHoweverItIsDrawn) {
  const double wanted = box_share(-90.0, -60.0, 360.0);
  // A line round the planet; the map's frame; the frame begun elsewhere; a step between.
  const std::vector<Ring> caps{
      {{-60, -180}, {-60, -90}, {-60, 0}, {-60, 90}, {-60, 180}},
      {{-60, 170}, {-60, 50}, {-60, -70}},
      {{-90, -180}, {-60, -180}, {-60, 180}, {-90, 180}, {-90, -180}},
      {{-60, 180}, {-90, 180}, {-90, -180}, {-60, -180}, {-60, 0}, {-60, 180}},
      {{-60, -180}, {-60, 0}, {-60, 180}, {-90, 180}, {-90, -180}, {-60, -180}}};
  for (const Ring& cap : caps) {
    EXPECT_NEAR(share(region({cap})), wanted, 1e-4);
    EXPECT_TRUE(region({cap}).holds({-89.9, 12.0}));
    EXPECT_FALSE(region({cap}).holds({89.9, 12.0}));
  }
}

TEST(RegionOutline, RingsWithinAreHolesAndIslands) {
  const auto square = [](double half) {
    return Ring{{-half, -half}, {-half, half}, {half, half}, {half, -half}};
  };
  const RegionOutline nested = region({square(30.0), square(20.0), square(10.0)});
  EXPECT_TRUE(nested.holds({25.0, 0.0}));
  EXPECT_FALSE(nested.holds({15.0, 0.0}));
  EXPECT_TRUE(nested.holds({0.0, 0.0}));
  EXPECT_FALSE(nested.holds({0.0, 40.0}));
}

TEST(RegionOutline, TellsWhichEdgesCross) {
  const auto crossing = first_crossing({{0, 0}, {10, 0}, {10, 10}, {5, -5}});
  ASSERT_TRUE(crossing.has_value());
  EXPECT_EQ(crossing->first, 0U);
  EXPECT_EQ(crossing->second, 2U);
  // The last edge, back to the first place, with the second; across the date line.
  const auto closing = first_crossing({{0, 170}, {10, 170}, {10, -170}, {5, 175}, {20, -175}});
  ASSERT_TRUE(closing.has_value());
  EXPECT_EQ(closing->first, 1U);
  EXPECT_EQ(closing->second, 3U);
}

TEST(RegionOutline, LinesThatOnlyTouchDoNotCross) {
  EXPECT_FALSE(first_crossing({{0, 0}, {0, 10}, {10, 10}, {10, 0}}).has_value());
  // A loop of a hundredth of a square degree where a drawn line closes.
  EXPECT_FALSE(
      first_crossing({{0, 0}, {0, 10}, {10, 10}, {10, 0}, {-0.1, 0.2}, {0.1, 0.3}}).has_value());
  EXPECT_TRUE(
      first_crossing({{0, 0}, {0, 10}, {10, 10}, {10, 0}, {-1.0, 2.0}, {1.0, 3.0}}).has_value());
  // Two boxes that meet in a corner; a spike; the frame of a polar cap; a line round the planet.
  EXPECT_FALSE(
      first_crossing({{0, 0}, {0, 10}, {10, 10}, {10, 20}, {20, 20}, {20, 10}, {10, 10}, {10, 0}})
          .has_value());
  EXPECT_FALSE(first_crossing({{0, 0}, {0, 10}, {0, 20}, {0, 10}, {10, 10}}).has_value());
  EXPECT_FALSE(
      first_crossing({{-90, -180}, {-60, -180}, {-60, 0}, {-60, 180}, {-90, 180}}).has_value());
  EXPECT_FALSE(
      first_crossing({{-60, -180}, {-60, -90}, {-50, 0}, {-60, 90}, {-60, 180}}).has_value());
}

TEST(RegionOutline, NeighboursShareNoPlaceAndLeaveNone) {
  // Edges of two neighbours that are the same line, drawn in both directions.
  const Ring line{{90.0, 10.0}, {31.7, 12.3}, {30.0, 20.1}, {-17.0, 3.3}, {-90.0, 10.0}};
  Ring east(line), west(line.rbegin(), line.rend());
  east.insert(east.end(), {{-90.0, 150.0}, {90.0, 150.0}});
  west.insert(west.end(), {{90.0, -120.0}, {-90.0, -120.0}});
  const RegionOutline first = region({east}), second = region({west});
  for (double latitude = -89.5; latitude < 90.0; latitude += 1.0) {
    for (double longitude = -119.5; longitude < 150.0; longitude += 1.0) {
      EXPECT_NE(first.holds({latitude, longitude}), second.holds({latitude, longitude}));
    }
  }
}

}  // namespace
}  // namespace geo
