#include "geo/kernels/crust/volcanoes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/plates/growth/convergent_margins.hpp"

namespace geo {
namespace {

constexpr VolcanoSizes kAlike{1000.0, 0.0, 5000.0, 20.0};

double volume_m3(const Grid& grid, const std::vector<float>& height_m) {
  double sum = 0.0;
  for (Index c = 0; c < grid.size(); ++c) sum += grid.area_m2(grid.row(c)) * height_m[c];
  return sum;
}

TEST(Volcanoes, HaveTheirVolumeOnEveryGridAlsoAtPolesAndSeam) {
  const double own_m3 = 2.0 * std::numbers::pi * 2000.0 * 3e4 * 3e4;
  for (const int nx : {256, 512, 1024}) {
    const Grid grid = Grid::sphere(nx, nx / 2);
    for (const Vector3& place :
         {Vector3{1.0, 0.0, 0.0}, Vector3{-1.0, 0.0, 0.0}, Vector3{0.0, 0.0, 1.0},
          normalised({0.06, 0.06, 1.0}), normalised({0.3, -0.4, -0.7})}) {
      const Volcano volcano{place, 2000.0, 30.0};
      std::vector<float> height_m(grid.size(), 0.0F);
      pile_volcanoes(grid, {&volcano, 1}, height_m);
      // About the pole cells are wedges, 39 km long with 1024 columns.
      if (place[2] > 0.9 && nx < 1024) continue;
      EXPECT_NEAR(volume_m3(grid, height_m) / own_m3, 1.0, place[2] > 0.9 ? 0.2 : 0.01)
          << nx << " at " << place[0] << " " << place[2];
    }
  }
  const Grid grid = Grid::sphere(64, 32);
  std::vector<float> few(3);
  EXPECT_THROW(pile_volcanoes(grid, {}, few), Bug);
}

TEST(Volcanoes, AreAsManyAsTheirSpacingHasRoomForWhereTheyMayGrow) {
  const Grid grid = Grid::sphere(360, 180);
  const auto north = [&](Index c) { return grid.row(c) >= 90; };
  const auto all = scatter_volcanoes(grid, 200.0, kAlike, 3, "test.volcanoes", north);
  const double room = 0.5 * grid.total_area_m2() / (200e3 * 200e3);
  EXPECT_NEAR(static_cast<double>(all.size()) / room, 1.0, 0.03);
  for (const Volcano& v : all) {
    EXPECT_GE(v.place[2], 0.0);
    EXPECT_EQ(v.height_m, 1000.0);
    EXPECT_EQ(v.radius_km, 20.0);
  }
}

TEST(Volcanoes, TrailsFollowThePlateBackFromItsPlume) {
  // One plate that turns about the axis at 60 mm/yr, and one plume on the equator.
  const Grid grid = Grid::sphere(720, 360);
  const auto cells = static_cast<std::size_t>(grid.size());
  std::vector<std::int16_t> plate(cells, 1);
  std::vector<float> east(cells), north(cells, 0.0F), age(cells, 200.0F), land(cells, 0.0F),
      heat(cells);
  for (Index c = 0; c < grid.size(); ++c) {
    const auto at = grid.unit_vector(grid.column(c), grid.row(c));
    east[c] = static_cast<float>(60.0 * std::hypot(at[0], at[1]));
    const double from_km = 6371.0 * angle_between(at, {1.0, 0.0, 0.0});
    heat[c] = static_cast<float>(0.2 + 0.5 * std::exp(-0.5 * std::pow(from_km / 260.0, 2)));
  }
  const MovingPlates plates{plate, east, north, age, land, heat};
  const auto on_trail = [](const std::vector<Volcano>& all) {
    int count = 0;
    double farthest_km = 0.0;
    for (const Volcano& v : all) {
      const double longitude_km = 6371.0 * std::atan2(v.place[1], v.place[0]);
      if (std::abs(6371.0 * v.place[2]) > 60.0 || longitude_km < -60.0 || longitude_km > 4900.0) {
        continue;  // a smaller hot spot's
      }
      ++count;
      farthest_km = std::max(farthest_km, longitude_km);
    }
    return std::pair{count, farthest_km};
  };
  const auto [count, farthest_km] = on_trail(plume_trails(grid, plates, kAlike, 5));
  // 80 Myr at 60 mm/yr are 4800 km, with a volcano every 90 on the mean.
  EXPECT_NEAR(count, 4800.0 / 90.0, 9.0);
  EXPECT_NEAR(farthest_km, 4800.0, 150.0);
  // Floor of 20 Myr cannot carry older volcanoes.
  age.assign(cells, 20.0F);
  EXPECT_NEAR(on_trail(plume_trails(grid, plates, kAlike, 5)).second, 1200.0, 150.0);
  land.assign(cells, 1.0F);
  EXPECT_TRUE(plume_trails(grid, plates, kAlike, 5).empty());
}

TEST(ConvergentMargins, TrenchesDeepenWithAgeAndSpeedAndBulgesStandBeforeThem) {
  EXPECT_DOUBLE_EQ(trench_share(100.0, 100.0), 1.0);
  EXPECT_DOUBLE_EQ(trench_share(25.0, 100.0), 0.5);
  EXPECT_DOUBLE_EQ(trench_share(500.0, 500.0), 1.2);
  EXPECT_DOUBLE_EQ(trench_share(0.0, 80.0), 0.0);
  EXPECT_DOUBLE_EQ(bent_plate(0.0), -1.0);
  EXPECT_NEAR(bent_plate(-58.0), 0.0, 1e-12);
  EXPECT_NEAR(bent_plate(-113.0), 0.10, 0.005);  // the top of the bulge
  EXPECT_LT(bent_plate(-90.0), bent_plate(-113.0));
  EXPECT_LT(bent_plate(-150.0), bent_plate(-113.0));
  EXPECT_NEAR(bent_plate(-600.0), 0.0, 1e-3);
  EXPECT_NEAR(bent_plate(200.0), 0.0, 1e-6);
}

TEST(ConvergentMargins, OneOfTwoFloorsGoesDownAlongTheWholeBoundaryOfAPair) {
  // Two oceans that meet on the equator. The northern is older but for a third of the way.
  const Grid grid = Grid::sphere(360, 180);
  const auto cells = static_cast<std::size_t>(grid.size());
  std::vector<std::int16_t> plate(cells);
  std::vector<std::int8_t> type(cells, 0);
  std::vector<float> strength(cells, 0.0F), land(cells, 0.0F), age(cells), east(cells, 0.0F),
      north(cells);
  for (Index c = 0; c < grid.size(); ++c) {
    const bool is_north = grid.row(c) >= 90;
    plate[c] = is_north ? 1 : 2;
    age[c] = is_north ? (grid.column(c) < 120 ? 20.0F : 120.0F) : 60.0F;
    north[c] = is_north ? -40.0F : 40.0F;
    if (grid.row(c) == 89 || grid.row(c) == 90) {
      type[c] = static_cast<std::int8_t>(grid.column(c) < 300 ? BoundaryType::convergent
                                                              : BoundaryType::transform);
      strength[c] = 1.0F;
    }
  }
  const auto side = [&](Polarity polarity, int column) {
    const auto margins =
        convergent_margins(grid, plate, type, strength, land, age, east, north, polarity);
    return margins.across_km[grid.cell(column, 95)] < 0.0F ? "down" : "over";
  };
  EXPECT_STREQ(side(Polarity::of_place, 60), "over");
  EXPECT_STREQ(side(Polarity::of_place, 200), "down");
  EXPECT_STREQ(side(Polarity::of_pair, 60), "down");
  EXPECT_STREQ(side(Polarity::of_pair, 200), "down");
  const auto margins =
      convergent_margins(grid, plate, type, strength, land, age, east, north, Polarity::of_pair);
  EXPECT_NEAR(margins.floor_myr[grid.cell(200, 95)], 120.0, 1.0);
  EXPECT_NEAR(margins.floor_myr[grid.cell(60, 85)], 20.0, 1.0);
  EXPECT_NEAR(margins.from_end_km[grid.cell(290, 93)], 10.0 * 111.2, 60.0);
}

}  // namespace
}  // namespace geo
