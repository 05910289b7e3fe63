#include "geo/kernels/climate/circulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

TEST(ThreeCellWind, BlowsWhereTheAirGoes) {
  EXPECT_LT(three_cell_wind(15).east, -0.9) << "trades come from the east";
  EXPECT_LT(three_cell_wind(15).north, 0.0) << "and head for the equator";
  EXPECT_GT(three_cell_wind(-15).north, 0.0);
  EXPECT_GT(three_cell_wind(45).east, 0.9) << "westerlies";
  EXPECT_GT(three_cell_wind(45).north, 0.0) << "and head for the pole";
  EXPECT_LT(three_cell_wind(75).east, -0.9) << "polar easterlies";
  EXPECT_NEAR(three_cell_wind(30).east, 0.0, 1e-12) << "calm between them";
  EXPECT_NEAR(std::abs(three_cell_wind(90).north), 0.35, 1e-12);
}

TEST(BalancedWinds, HadleyCellsGiveTradesAndLeaveHigherLatitudesCalm) {
  const Grid grid = Grid::sphere(72, 36);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto size = static_cast<std::size_t>(grid.size());
  const std::vector<float> none(size, 0.0F);
  std::vector<float> pressure(size), east(size), north(size);
  for (Index c = 0; c < grid.size(); ++c) {
    pressure[c] = static_cast<float>(hadley_pressure_hpa(latitude[grid.row(c)], {}));
  }
  balanced_winds(grid, {}, latitude, none, pressure, east, north);
  for (int j = 0; j < grid.ny(); ++j) {
    const double distance = std::abs(latitude[j]);
    const double poleward = north[grid.cell(0, j)] * (latitude[j] > 0 ? 1 : -1);
    if (distance > 5 && distance < 27) {
      EXPECT_LT(east[grid.cell(0, j)], 0.0F) << latitude[j];
      EXPECT_LT(poleward, 0.0) << latitude[j];
    } else if (distance > 33) {
      EXPECT_EQ(east[grid.cell(0, j)], 0.0F) << latitude[j];
      EXPECT_EQ(poleward, 0.0) << latitude[j];
    }
  }
}

// Without mixing each row has the wind that balances its own pressure; with it trades blow at the
// equator as well.
TEST(CellWinds, BalancePressureRotationAndDrag) {
  const Grid grid = Grid::sphere(72, 36);
  std::vector<double> latitude, pressure;
  Circulation model;
  for (int j = 0; j < grid.ny(); ++j) {
    latitude.push_back(grid.latitude_deg(j));
    pressure.push_back(hadley_pressure_hpa(latitude[j], model));
  }
  model.cell_mixing_km = 0.0;
  model.overturning_share = 1.0;
  const std::vector<double> none(latitude.size(), 0.0);
  const CellWinds alone = cell_winds(grid, model, latitude, pressure, none);
  for (int j = 1; j + 1 < grid.ny(); ++j) {
    const double f = 2.0 * model.rotation_rad_s() * std::sin(latitude[j] * kRadians);
    const double push = -100.0 * (pressure[j + 1] - pressure[j - 1]) /
                        (2.0 * grid.spacing_north_m(j)) / model.air_density_kg_m3;
    EXPECT_NEAR(model.drag_ocean_s * alone.east[j] - f * alone.north[j], 0.0, 1e-15);
    EXPECT_NEAR(model.drag_ocean_s * alone.north[j] + f * alone.east[j], push, 1e-15);
  }
  model.cell_mixing_km = 800.0;
  const CellWinds mixed = cell_winds(grid, model, latitude, pressure, none);
  const int equator = grid.ny() / 2;
  EXPECT_LT(mixed.east[equator], -0.3) << "trades";
  EXPECT_GT(mixed.east[equator], mixed.east[equator + 2]);
  model.overturning_share = 0.5;
  const CellWinds returning = cell_winds(grid, model, latitude, pressure, none);
  for (int j = 0; j < grid.ny(); ++j) {
    EXPECT_DOUBLE_EQ(returning.east[j], mixed.east[j]);
    EXPECT_DOUBLE_EQ(returning.north[j], 0.5 * mixed.north[j]);
  }
}

/// Rows of a sphere, and a temperature that falls from the equator by 40 K times 1 - cos(latitude).
struct WarmEquator {
  Grid grid;
  std::vector<double> latitude_deg, temperature_c, smooth;
  explicit WarmEquator(int rows)
      : grid(Grid::sphere(2 * rows, rows)),
        latitude_deg(rows),
        temperature_c(rows),
        smooth(rows, 1.0) {
    for (int j = 0; j < rows; ++j) {
      latitude_deg[j] = grid.latitude_deg(j);
      temperature_c[j] = 20.0 - 40.0 * (1.0 - std::cos(latitude_deg[j] * kRadians));
    }
  }
  [[nodiscard]] std::vector<double> wind_m_s(const Circulation& model) const {
    return eddy_driven_wind_m_s(grid, model, latitude_deg, temperature_c, smooth);
  }
};

/// The source is sin^2 there if Hadley cells are narrow, which has an exact answer: with x =
/// sin(latitude) and L in radians
///   S - B = (x^2 - 1/4) 8 L^2 / (1 + 8 L^2),
/// so that the wind turns at 30 degrees.
TEST(EddyDrivenWind, IsTheExactOneOfASourceThatGrowsWithTheSineSquared) {
  const WarmEquator planet(360);
  Circulation model;
  model.stability_1_k = 0.0;
  model.rotation_period_h /= 100.0;  // cells a tenth as wide
  const std::vector<double> wind_m_s = planet.wind_m_s(model);
  const double reach2 = std::pow(0.1 * model.eddy_reach_deg * kRadians, 2);
  const double eddy_rad = 8.0 * kRadians;
  const double gradient = 40.0 / planet.grid.figure().radius_m * std::sin(eddy_rad) / eddy_rad;
  const double most_m_s =
      100.0 * model.eddy_wind_m_s * gradient / 5.0e-6 * 8.0 * reach2 / (1.0 + 8.0 * reach2);
  for (int j = 0; j < planet.grid.ny(); ++j) {
    // Within Hadley cells there is less, and gradients at poles are of one side.
    if (std::abs(planet.latitude_deg[j]) < 3.0 || std::abs(planet.latitude_deg[j]) > 75.0) continue;
    const double sine2 = std::pow(std::sin(planet.latitude_deg[j] * kRadians), 2);
    EXPECT_NEAR(wind_m_s[j], most_m_s * (sine2 - 0.25), 0.02 * most_m_s) << planet.latitude_deg[j];
  }
}

TEST(EddyDrivenWind, TakesNoAngularMomentumFromThePlanet) {
  const WarmEquator planet(90);
  const std::vector<double> wind_m_s = planet.wind_m_s({});
  double sum = 0.0, size = 0.0;
  for (int j = 0; j < planet.grid.ny(); ++j) {
    const double arm2 = std::pow(std::cos(planet.latitude_deg[j] * kRadians), 2);
    sum += arm2 * wind_m_s[j];
    size += arm2 * std::abs(wind_m_s[j]);
  }
  EXPECT_GT(size, 10.0);
  EXPECT_NEAR(sum / size, 0.0, 1e-12);
}

TEST(EddyDrivenWind, GoesWithThePlanetsRotationAndDiesWithIt) {
  const WarmEquator planet(90);
  Circulation model, back, slow;
  back.retrograde = true;
  slow.rotation_period_h *= 100.0;
  const std::vector<double> wind_m_s = planet.wind_m_s(model),
                            backwards_m_s = planet.wind_m_s(back), slow_m_s = planet.wind_m_s(slow);
  for (int j = 0; j < planet.grid.ny(); ++j) {
    EXPECT_NEAR(wind_m_s[j], wind_m_s[planet.grid.ny() - 1 - j], 1e-10);
    EXPECT_DOUBLE_EQ(backwards_m_s[j], -wind_m_s[j]);
    EXPECT_LT(std::abs(slow_m_s[j]), 0.5);
  }
}

TEST(EddyDrivenWind, IsHeldBackByRoughParallelsAndByColdStableAir) {
  const WarmEquator planet(90);
  Circulation model;
  std::vector<double> rough = planet.smooth;
  rough[70] = 4.0;
  const std::vector<double> wind_m_s = planet.wind_m_s(model);
  const std::vector<double> over_land_m_s =
      eddy_driven_wind_m_s(planet.grid, model, planet.latitude_deg, planet.temperature_c, rough);
  EXPECT_DOUBLE_EQ(over_land_m_s[70], 0.25 * wind_m_s[70]);
  EXPECT_DOUBLE_EQ(over_land_m_s[71], wind_m_s[71]);
  model.stability_1_k = 0.0;
  EXPECT_GT(planet.wind_m_s(model)[80], wind_m_s[80]);
}

// What eddies drive is in balance with pressure, and leaves a drift to the pole in the layer that
// rubs on the ground.
TEST(CellWinds, ComeIntoBalanceWithTheWindThatEddiesDrive) {
  const WarmEquator planet(36);
  Circulation model;
  model.cell_mixing_km = 0.0;
  model.overturning_share = 1.0;
  const std::vector<double> level(36, 0.0), driven_m_s = planet.wind_m_s(model);
  const CellWinds winds = cell_winds(planet.grid, model, planet.latitude_deg, level, driven_m_s);
  for (int j = 0; j < planet.grid.ny(); ++j) {
    const double f = 2.0 * model.rotation_rad_s() * std::sin(planet.latitude_deg[j] * kRadians);
    EXPECT_NEAR(model.drag_ocean_s * winds.east[j] - f * winds.north[j], 0.0, 1e-15);
    EXPECT_NEAR(model.drag_ocean_s * winds.north[j] + f * winds.east[j], f * driven_m_s[j], 1e-15);
  }
  EXPECT_GT(winds.east[27], 0.9 * driven_m_s[27]);
  EXPECT_GT(winds.north[27], 0.0) << "47.5 N";
  EXPECT_LT(winds.north[8], 0.0);
}

TEST(CellWinds, EddiesMixTheirMomentum) {
  const Grid grid = Grid::sphere(72, 36);
  std::vector<double> latitude, pressure;
  Circulation model;
  model.cell_mixing_km = 1200.0;
  model.overturning_share = 1.0;
  for (int j = 0; j < grid.ny(); ++j) {
    latitude.push_back(grid.latitude_deg(j));
    pressure.push_back(hadley_pressure_hpa(latitude[j], model));
  }
  const std::vector<double> none(latitude.size(), 0.0);
  const CellWinds winds = cell_winds(grid, model, latitude, pressure, none);
  for (int j = 1; j + 1 < grid.ny(); ++j) {
    const double f = 2.0 * model.rotation_rad_s() * std::sin(latitude[j] * kRadians);
    const double rows = 1.2e6 / grid.spacing_north_m(j);
    const double curvature = winds.east[j + 1] - 2.0 * winds.east[j] + winds.east[j - 1];
    EXPECT_NEAR(model.drag_ocean_s * (winds.east[j] - rows * rows * curvature), f * winds.north[j],
                1e-10);
  }
}

TEST(BalancedWinds, AirFlowsIntoALowAndTurnsCyclonic) {
  const Grid grid = Grid::sphere(72, 36);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto size = static_cast<std::size_t>(grid.size());
  const std::vector<float> land(size, 1.0F);
  std::vector<float> pressure(size), east(size), north(size);
  const int row = 24, column = 36;  // 32.5 N
  for (Index c = 0; c < grid.size(); ++c) {
    const double dx = grid.column(c) - column, dy = grid.row(c) - row;
    pressure[c] = static_cast<float>(-8.0 * std::exp(-(dx * dx + dy * dy) / 8.0));
  }
  balanced_winds(grid, {}, latitude, land, pressure, east, north);
  EXPECT_GT(east[grid.cell(column - 2, row)], 0.0F) << "towards the low from the west";
  EXPECT_LT(east[grid.cell(column + 2, row)], 0.0F);
  EXPECT_LT(north[grid.cell(column - 2, row)], 0.0F) << "anticlockwise in the north";
  EXPECT_GT(north[grid.cell(column + 2, row)], 0.0F);
}

}  // namespace
}  // namespace geo
