// Fields of a planet between its cells.
#include "geo/kernels/remapping/catmull_rom.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(CatmullRom, GoesThroughTheCellsAndFollowsParabolas) {
  const Grid planet = Grid::sphere(36, 18);
  std::vector<float> values(planet.size());
  for (Index cell = 0; cell < planet.size(); ++cell) {
    const double x = planet.column(cell), y = planet.row(cell);
    values[cell] = static_cast<float>(3.0 + 0.5 * x - 0.02 * x * x + y - 0.1 * y * y);
  }
  const std::span<const float> field(values);
  for (const Index cell : {100, 333, 500}) {
    const CatmullRom at(
        planet, {planet.latitude_deg(planet.row(cell)), planet.longitude_deg(planet.column(cell))});
    EXPECT_NEAR(at.of(field), values[cell], 1e-5);
    EXPECT_EQ(at.nearest(), cell);
  }
  for (const auto& [x, y] : {std::pair{7.3, 6.8}, {20.5, 11.25}}) {
    const CatmullRom at(planet, {-90.0 + (y + 0.5) * 10.0, -180.0 + (x + 0.5) * 10.0});
    EXPECT_NEAR(at.of(field), 3.0 + 0.5 * x - 0.02 * x * x + y - 0.1 * y * y, 1e-4);
  }
}

TEST(CatmullRom, GoesOnOverTheDateLineAndThePole) {
  const Grid planet = Grid::sphere(360, 180);
  std::vector<float> values(planet.size());
  const auto height = [](double lat_deg, double lon_deg) {
    const double lat = lat_deg * kPi / 180.0, lon = lon_deg * kPi / 180.0;
    return std::cos(lat) * std::cos(lon) + 2.0 * std::sin(lat);
  };
  for (Index cell = 0; cell < planet.size(); ++cell) {
    values[cell] = static_cast<float>(
        height(planet.latitude_deg(planet.row(cell)), planet.longitude_deg(planet.column(cell))));
  }
  for (const auto& [lat, lon] :
       {std::pair{10.3, 179.9}, {10.3, -179.9}, {89.9, 33.0}, {-89.95, -120.0}, {45.0, 0.0}}) {
    EXPECT_NEAR(CatmullRom(planet, {lat, lon}).of(std::span<const float>(values)), height(lat, lon),
                1e-4)
        << lat << " " << lon;
  }
}

TEST(CatmullRom, RangeIsThatOfTheFourCellsRoundThePlaceOverTheDateLineAndThePole) {
  const Grid planet = Grid::sphere(36, 18);  // cells of 10 degrees, centres at odd multiples of 5
  std::vector<float> values(planet.size());
  for (Index cell = 0; cell < planet.size(); ++cell) values[cell] = static_cast<float>(cell);
  const auto range = [&](double lat, double lon) {
    return CatmullRom(planet, {lat, lon}).range(values);
  };
  const auto value = [&](int i, int j) { return values[planet.cell(i, j)]; };
  EXPECT_EQ(range(1.0, 1.0), (std::pair{value(17, 8), value(18, 9)}));
  EXPECT_EQ(range(-9.0, 8.0), (std::pair{value(18, 7), value(19, 8)}));
  EXPECT_EQ(range(1.0, 179.0), (std::pair{value(0, 8), value(35, 9)}));
  // Beyond the pole the columns are those half-way round.
  EXPECT_EQ(range(89.0, 1.0), (std::pair{value(0, 17), value(35, 17)}));
  EXPECT_EQ(range(-89.0, -99.0), (std::pair{value(7, 0), value(26, 0)}));
  values[planet.cell(17, 8)] = NAN;
  EXPECT_TRUE(std::isnan(range(1.0, 1.0).first));
  EXPECT_TRUE(std::isnan(range(1.0, 1.0).second));
  EXPECT_FALSE(std::isnan(range(11.0, 1.0).first));  // of the cubic's 16, but not of the four
}

}  // namespace
}  // namespace geo
