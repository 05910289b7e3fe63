// Distances and rates of convergence at the margins of plates, against exact values.
#include "geo/kernels/plates/growth/convergent_margins.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <vector>

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// A convergent boundary along the equator between an old ocean in the south and a continent.
struct EquatorialTrench {
  Grid grid = Grid::sphere(512, 256);
  std::vector<std::int16_t> plate;
  std::vector<std::int8_t> type;
  std::vector<float> strength, fraction, age, east, north;
  EquatorialTrench() {
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const bool north = grid.row(cell) >= 128;
      const bool near = grid.row(cell) == 127 || grid.row(cell) == 128;
      plate.push_back(north ? 1 : 0);
      type.push_back(near ? 1 : 0);
      strength.push_back(near ? 0.8F : 0.0F);
      fraction.push_back(north ? 1.0F : 0.0F);
      age.push_back(80.0F);
      // 50 mm/yr across the boundary, 30 along it.
      east.push_back(north ? 0.0F : 30.0F);
      this->north.push_back(north ? -20.0F : 30.0F);
    }
  }
};

TEST(ConvergentMargins, TheOceanGoesDownAndDistancesAreTrueOnes) {
  const EquatorialTrench t;
  const auto margins =
      convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.east, t.north);
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    const double latitude_deg = t.grid.latitude_deg(t.grid.row(cell));
    ASSERT_EQ(margins.kind[cell], Convergence::ocean_continent);
    ASSERT_FLOAT_EQ(margins.strength[cell], 0.8F);
    const double expected_km = 6371.0 * kPi / 180.0 * latitude_deg;
    const double half_cell_km = 0.51e-3 * t.grid.spacing_north_m(128);
    ASSERT_NEAR(margins.across_km[cell], expected_km, half_cell_km) << latitude_deg;
  }
}

TEST(ConvergentMargins, AThirdPlateIsOnTheSideWhereItLies) {
  EquatorialTrench t;
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    if (t.grid.row(cell) < 118) t.plate[cell] = 2;
    if (t.grid.row(cell) >= 138) t.plate[cell] = 3;
  }
  const auto margins =
      convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.east, t.north);
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    const int row = t.grid.row(cell);
    if (row == 127 || row == 128) continue;  // the boundary itself
    ASSERT_EQ(margins.across_km[cell] > 0.0F, row > 128) << row;
  }
}

TEST(ConvergentMargins, ClosingIsTheConvergenceAcrossTheBoundary) {
  EquatorialTrench t;
  const auto closing = [&] {
    return convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.east,
                              t.north)
        .closing_mm_yr;
  };
  for (const float mm_yr : closing()) ASSERT_NEAR(mm_yr, 50.0, 0.05);
  std::swap_ranges(t.north.begin(), t.north.begin() + 128 * 512, t.north.begin() + 128 * 512);
  for (const float mm_yr : closing()) ASSERT_EQ(mm_yr, 0.0F);  // they part
}

TEST(ConvergentMargins, ShorteningIsWhatArrivesOverTheWholeSection) {
  for (const double strength : {0.05, 0.4, 1.0, 1.3}) {
    for (const auto section : {andean_shortening, himalayan_shortening}) {
      double sheet = 0.0, wedge = 0.0;
      constexpr double kStep_km = 0.5;
      for (double x = -800.0; x < 3000.0; x += kStep_km) {
        const ShorteningDensity density = section(x, strength);
        sheet += kStep_km * density.sheet;
        wedge += kStep_km * density.wedge;
      }
      EXPECT_NEAR(sheet, 1.0, 1e-9);
      EXPECT_NEAR(wedge, 1.0, 1e-9);
    }
  }
}

TEST(ConvergentMargins, OfTwoOceansTheOlderGoesDown) {
  EquatorialTrench t;
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    t.fraction[cell] = 0.0F;
    t.age[cell] = t.plate[cell] == 1 ? 120.0F : 30.0F;
  }
  const auto margins =
      convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.east, t.north);
  EXPECT_EQ(margins.kind[0], Convergence::oceans);
  EXPECT_LT(margins.across_km[t.grid.cell(7, 200)], 0.0F);
  EXPECT_GT(margins.across_km[t.grid.cell(7, 60)], 0.0F);
}

TEST(ConvergentMargins, ContinentsInAnOceanDoNotMakeItsFloorOlder) {
  EquatorialTrench t;
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    // A third of the younger plate is an old continent.
    const bool continent = t.plate[cell] == 0 && t.grid.column(cell) % 3 == 0;
    t.fraction[cell] = continent ? 1.0F : 0.0F;
    t.age[cell] = continent ? 2000.0F : t.plate[cell] == 1 ? 120.0F : 30.0F;
  }
  const auto margins =
      convergent_margins(t.grid, t.plate, t.type, t.strength, t.fraction, t.age, t.east, t.north);
  for (Index cell = 0; cell < t.grid.size(); ++cell) {
    ASSERT_EQ(margins.kind[cell], Convergence::oceans);
    if (t.type[cell] != 0) continue;  // on the boundary itself
    ASSERT_EQ(margins.across_km[cell] < 0.0F, t.plate[cell] == 1);
  }
}

}  // namespace
}  // namespace geo
