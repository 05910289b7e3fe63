#include "geo/io/input/hypsography.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "geo/core/error.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

double elevation_at(const Hypsography& curve, double fraction) {
  std::size_t k = 1;
  while (curve.fraction[k] < fraction) ++k;
  return std::lerp(
      curve.elevation_m[k - 1], curve.elevation_m[k],
      (fraction - curve.fraction[k - 1]) / (curve.fraction[k] - curve.fraction[k - 1]));
}

TEST(Hypsography, MixesSeaAndLandToAWantedShare) {
  for (const char* name : {"earth", "earth-statistical"}) {
    const Hypsography curve = read_hypsography(name);
    for (const double share : {0.2, 0.71, 0.95}) {
      const Hypsography mixed = with_ocean_share(curve, share);
      ASSERT_EQ(mixed.fraction.size(), mixed.elevation_m.size());
      EXPECT_EQ(mixed.fraction.front(), 0.0);
      EXPECT_EQ(mixed.fraction.back(), 1.0);
      for (std::size_t k = 1; k < mixed.fraction.size(); ++k) {
        ASSERT_GT(mixed.fraction[k], mixed.fraction[k - 1]);
        ASSERT_GE(mixed.elevation_m[k], mixed.elevation_m[k - 1]);
      }
      EXPECT_NEAR(elevation_at(mixed, share), 0.0, 1e-9) << name;
      // Halfway up the land and halfway down the sea stay what they were.
      const double below = name == std::string("earth") ? 0.7151 : 0.7817;
      EXPECT_NEAR(elevation_at(mixed, share + 0.5 * (1.0 - share)),
                  elevation_at(curve, below + 0.5 * (1.0 - below)), 3.0);
      EXPECT_NEAR(elevation_at(mixed, 0.5 * share), elevation_at(curve, 0.5 * below), 3.0);
    }
  }
}

TEST(Hypsography, LeavesOneOfThemAtTheEnds) {
  const Hypsography curve = read_hypsography("earth");
  EXPECT_EQ(with_ocean_share(curve, 0.0).elevation_m.front(), 0.0);
  EXPECT_EQ(with_ocean_share(curve, 1.0).elevation_m.back(), 0.0);
}

TEST(Hypsography, OfOneKindOfGroundIsMovedToTheWantedShare) {
  const Hypsography dry{{0.0, 0.4, 1.0}, {10.0, 1000.0, 4000.0}};
  const Hypsography wet = with_ocean_share(dry, 0.7);
  EXPECT_EQ(wet.fraction, dry.fraction);
  EXPECT_NEAR(ocean_share_of(wet), 0.7, 1e-12);
  EXPECT_NEAR(wet.elevation_m.back() - wet.elevation_m.front(), 3990.0, 1e-9);
  EXPECT_EQ(with_ocean_share(dry, 0.0).elevation_m, dry.elevation_m);
}

TEST(Hypsography, TellsItsShareOfSea) {
  EXPECT_NEAR(ocean_share_of({{0.0, 0.5, 1.0}, {-3000.0, -1000.0, 1000.0}}), 0.75, 1e-12);
  EXPECT_EQ(ocean_share_of({{0.0, 1.0}, {10.0, 4000.0}}), 0.0);
  EXPECT_EQ(ocean_share_of({{0.0, 1.0}, {-4000.0, -10.0}}), 1.0);
}

TEST(Hypsography, RefusesElevationsWhoseDifferenceIsNoNumber) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "huge.csv").string();
  std::ofstream(file) << "quantile,elevation_m\n0,-1.7e308\n1,1.7e308\n";
  EXPECT_THROW(static_cast<void>(read_hypsography(file)), InputError);
}

}  // namespace
}  // namespace geo::io
