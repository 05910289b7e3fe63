// Section 5: temperature, winds, precipitation.
#include <gtest/gtest.h>

#include "blueprint.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"

namespace geo {
namespace {

using test::kRadians;
using test::planet;

struct Climate {
  std::span<const float> z, temperature, rain, coast_m;
};
Climate climate_of(const test::BlueprintPlanet& made) {
  const State& state = made.after.at("climate");
  return {planet().read("erosion", field::elevation), state.read(field::temperature),
          state.read(field::precipitation), state.read(field::distance_to_coast)};
}

double value_noise(const char* stream, Index cell) {
  return test::octave(Noise(planet().seed, stream), test::place(planet().grid(), cell),
                      test::kRadius_km / 500.0);
}

TEST(BlueprintClimate, TemperatureIsThatOfItsEquations) {
  const Grid& grid = planet().grid();
  const Climate climate = climate_of(planet());
  double least = 0.0, most = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    const double lat = grid.latitude_deg(grid.row(c));
    const bool underwater = climate.z[c] < 0.0F;
    const double t_sea = 28.0 - 0.007 * lat * lat;                       // (5.1)
    const double t_noise = 2.0 * value_noise("climate.temperature", c);  // +-2
    const double d_coast_km = underwater ? 0.0 : 1e-3 * climate.coast_m[c];
    const double t = t_sea - 0.006 * std::max(0.0F, climate.z[c]) +  // (5.2)
                     (underwater ? 2.0 : 0.0) + 5.0 * std::log(1.0 + 1.0) + t_noise -
                     0.008 * d_coast_km * std::sin(std::abs(lat) * kRadians);  // (5.3), (5.3a)
    ASSERT_NEAR(climate.temperature[c], std::clamp(t, -70.0, 55.0), 1e-3);
    least = std::min(least, t_noise);
    most = std::max(most, t_noise);
  }
  EXPECT_LT(least, -1.5);
  EXPECT_GT(most, 1.5);
}

double p_hadley(double latitude) {  // (5.4)
  const double lat = std::abs(latitude);
  const auto between = [&](double from, double to, double p_from, double p_to) {
    return p_from + (p_to - p_from) * (lat - from) / (to - from);
  };
  if (lat < 10) return 2000;
  if (lat < 20) return between(10, 20, 2000, 600);
  if (lat < 35) return between(20, 35, 600, 250);
  if (lat < 50) return between(35, 50, 250, 900);
  if (lat < 70) return between(50, 70, 900, 400);
  return between(70, 90, 400, 150);
}

/// The whole of (5.10) at a cell, with the part that the relief makes as the kernel traces it.
std::vector<double> rain_by_its_equation(double pressure_bar, double aerosol) {
  const Grid& grid = planet().grid();
  const Climate climate = climate_of(planet());
  std::vector<double> latitude(grid.ny());
  for (int j = 0; j < grid.ny(); ++j) latitude[j] = grid.latitude_deg(j);
  std::vector<float> land(grid.size()), height(grid.size()), relief(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    land[c] = climate.z[c] >= 0.0F ? 1.0F : 0.0F;
    height[c] = std::max(0.0F, climate.z[c]);
  }
  blueprint_orographic_precipitation(grid, {}, latitude, land, height, relief);
  // It comes to the grid by splines, whatever the grid of the trace.
  const ConservativeRemapping remapping(grid, grid);
  const Interpolator smooth(remapping, std::vector<float>(relief));
  std::vector<float> scratch(smooth.scratch_size());
  for (int j = 0; j < grid.ny(); ++j) {
    smooth.row(j, std::span(relief).subspan(grid.cell(0, j), grid.nx()), scratch);
  }
  std::vector<double> rain(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const double f_atmosphere = std::sqrt(pressure_bar), hadley = p_hadley(latitude[grid.row(c)]);
    if (climate.z[c] < 0.0F) {
      rain[c] = hadley * 1.2 * f_atmosphere;
      continue;
    }
    const double f_cont = std::exp(-1e-3 * climate.coast_m[c] / 800.0);         // (5.10a)
    const double f_altitude = std::max(0.1, std::exp(-climate.z[c] * 0.0004));  // (5.9)
    const double p =
        (hadley * f_cont + relief[c]) * f_altitude + value_noise("climate.precipitation", c) * 60.0;
    rain[c] = std::clamp(p * f_atmosphere - aerosol * 200.0, 20.0, 4500.0);  // (5.10)
  }
  return rain;
}

TEST(BlueprintClimate, PrecipitationIsThatOfItsEquation) {
  const auto expected = rain_by_its_equation(1.0, 0.0);
  const Climate climate = climate_of(planet());
  for (Index c = 0; c < planet().grid().size(); ++c) {
    ASSERT_NEAR(climate.rain[c], expected[c], 0.05) << "cell " << c << " at " << climate.z[c];
  }
}

TEST(BlueprintClimate, ImpactWinterTakesItsRainBeforeTheLimits) {
  // Little more than a kilometre of stone: some land keeps more than 20 mm and some does not.
  Impact impact;
  impact.diameter_km = 1.2;
  const double mass_kg = 0.1 * 3000.0 * std::numbers::pi / 6.0 * std::pow(1200.0, 3);
  const double sphere_m2 = 4.0 * std::numbers::pi * std::pow(6371e3, 2);
  const double aerosol = 2500.0 * mass_kg / sphere_m2;
  const auto made = test::go_on(planet().after.at("erosion"), "climate", "climate", {},
                                {{.name = "Winter", .what = impact}});
  const auto expected = rain_by_its_equation(1.0, aerosol);
  const Climate winter = climate_of(made), before = climate_of(planet());
  const double cooling = before.temperature[0] - winter.temperature[0];
  EXPECT_GT(cooling, 0.5);
  int dry = 0, wet = 0;
  for (Index c = 0; c < planet().grid().size(); ++c) {
    ASSERT_NEAR(winter.rain[c], expected[c], 0.05) << "cell " << c;
    if (winter.z[c] >= 0.0F) ++(expected[c] > 20.0 ? wet : dry);
    if (before.temperature[c] - cooling > -69.0) {
      ASSERT_NEAR(winter.temperature[c], before.temperature[c] - cooling, 1e-3);
    }
  }
  EXPECT_GT(dry, 50);
  EXPECT_GT(wet, 50);
}

TEST(BlueprintClimate, WindsAreTheThreeCells) {
  const Grid& grid = planet().grid();
  const auto east = planet().read("climate", field::wind_east);
  const auto north = planet().read("climate", field::wind_north);
  for (int j = 0; j < grid.ny(); ++j) {
    const double lat = grid.latitude_deg(j), far = std::abs(lat);
    double towards_east = -1.0;  // from the east
    if (far > 25 && far < 35) towards_east = (far - 30) / 5;
    if (far >= 35 && far <= 55) towards_east = 1.0;
    if (far > 55 && far < 65) towards_east = (60 - far) / 5;
    ASSERT_NEAR(east[grid.cell(0, j)], 7.0 * towards_east, 1e-4) << lat;
    // Westerlies bend to the pole, easterlies to the equator.
    const double deflection = 0.35 * std::sin(lat * kRadians) * towards_east;
    ASSERT_NEAR(north[grid.cell(0, j)], 7.0 * deflection, 1e-4) << lat;
  }
}

TEST(BlueprintClimate, ReliefMakesRainByTheDistancesOfTheDocument) {
  // Sea in the west, then a plain, a ramp and a wall, uniform to the north; westerlies at 45 deg go
  // 0.35 sin 45 to the north for each step to the east.
  constexpr int kShore = 60, kRamp = 100, kWall = 130, kWidth = 200;
  constexpr double kCell_km = 10.0, kSlope_m_km = 5.0, kWall_m = 2000.0;
  const Grid grid = Grid::plane(kWidth, 160, 1e3 * kCell_km, 1e3 * kCell_km);
  const std::vector<double> latitude(160, 45.0);
  std::vector<float> land(grid.size()), height(grid.size()), rain(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c);
    land[c] = i >= kShore ? 1.0F : 0.0F;
    if (i >= kRamp && i < kWall) {
      height[c] = static_cast<float>(kSlope_m_km * kCell_km * (i - kRamp));
    }
    if (i >= kWall && i < kWall + 4) height[c] = kWall_m;
  }
  blueprint_orographic_precipitation(grid, {}, latitude, land, height, rain);
  const double along = 1.0 / std::hypot(1.0, 0.35 * std::sin(45.0 * kRadians));  // east per km
  const auto at = [&](int column) { return rain[grid.cell(column, 80)]; };
  const auto inland_km = [&](int column) { return (column - kShore + 0.5) * kCell_km / along; };
  const auto windward = [&](int column) {  // 1000 km of land at most
    return 600.0 * std::exp(-std::min(1000.0, inland_km(column)) / 1000.0);
  };
  // (5.5): 0.02 a cell of 20 km.
  EXPECT_NEAR(at(kShore + 20), windward(kShore + 20), 15.0);
  EXPECT_NEAR(at(kShore + 35), windward(kShore + 35), 15.0);
  // (5.6): 5 km inland of a straight shore the circle's segment beyond a twelfth of its radius.
  const double sea = (std::acos(1.0 / 12) - std::sqrt(1.0 - 1.0 / 144) / 12) / std::numbers::pi;
  EXPECT_NEAR(at(kShore) - windward(kShore), 600.0 * sea, 600.0 * 0.04);
  // (5.7): the rise from 20 km upwind.
  EXPECT_NEAR(at(kRamp + 20) - windward(kRamp + 20), 0.8 * kSlope_m_km * 20.0 * along, 15.0);
  // (5.8): behind the wall, 200 km on.
  const double behind_km = 200.0 / along;  // the nearest sample of the wall is up to 20 km further
  EXPECT_NEAR(windward(kWall + 23) - at(kWall + 23),
              kWall_m * 0.40 * std::exp(-(behind_km + 10.0) / 250.0), 25.0);
  EXPECT_NEAR(at(kWall + 58), windward(kWall + 58), 15.0);  // 550 km: beyond the trace
}

}  // namespace
}  // namespace geo
