#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include "geo/kernels/climate/energy_balance.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/ocean_heat.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "geo/kernels/numerics/area_sum.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr Orbit kCircle{23.44, 0.0, 0.0};

TemperatureCycle solve(const Grid& grid, const EnergyBalance& model, float land,
                       float height_m = 0.0F) {
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto size = static_cast<std::size_t>(grid.size());
  return solve_energy_balance(grid, model, false, latitude, std::vector<float>(size, land),
                              std::vector<float>(size, height_m));
}

EnergyBalance constant_albedo() {
  EnergyBalance model;
  model.solar_constant_w_m2 = 1360.0;
  model.outgoing_w_m2 = 210.0;
  model.outgoing_slope_w_m2_k = 2.0;
  model.diffusivity_w_m2_k = 0.55;
  model.moist_transport = 0.0;
  model.channel_share = 0.0;
  model.coalbedo = 0.7;
  model.coalbedo_p2 = 0.0;
  model.ice_width_k = 0.0;
  model.orbit = kCircle;
  model.gyre_heat_w_m2 = model.subpolar_heat_w_m2 = model.upwelling_w_m2 = 0.0;
  return model;
}

TEST(EnergyBalance, ConstantAlbedoMatchesLegendreSolution) {
  // T0 = (Q a - A)/B and T2 = Q a s2/(6 D + B) are exact for each degree. The textbook number
  // -21.5547 is T2 at s2 = -0.48; the sun of obliquity 23.44 has s2 = -0.47665.
  const Grid grid = Grid::sphere(90, 90);
  const auto s = solve(grid, constant_albedo(), 1.0F);
  double mean = 0.0, second = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    const double x = std::sin(grid.latitude_deg(j) * kRadians);
    const double share = grid.area_m2(j) * grid.nx() / grid.total_area_m2();
    mean += share * s.mean_c(grid.cell(0, j));
    second += 5.0 * share * s.mean_c(grid.cell(0, j)) * 0.5 * (3 * x * x - 1);
  }
  EXPECT_NEAR(mean, 14.000, 0.005);
  EXPECT_NEAR(second / -0.47665 * -0.48, -21.5547, 0.03) << "second order in the spacing of 2 deg";
}

/// What a field has of the first Legendre degree, times an area.
std::complex<double> first_degree(const Grid& grid, std::span<const std::complex<double>> values) {
  std::complex<double> sum = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    sum += grid.area_m2(j) * std::sin(grid.latitude_deg(j) * kRadians) * values[grid.cell(0, j)];
  }
  return sum;
}

/// The same of the annual harmonic of the insolation at 1360 W m-2.
std::complex<double> first_degree_insolation(const Grid& grid, const Orbit& orbit) {
  std::vector<std::complex<double>> harmonic(static_cast<std::size_t>(grid.size()));
  for (int j = 0; j < grid.ny(); ++j) {
    for (int m = 0; m < kMonths; ++m) {
      harmonic[grid.cell(0, j)] += 2.0 / kMonths *
                                   monthly_insolation_w_m2(grid.latitude_deg(j), orbit, 1360.0)[m] *
                                   std::polar(1.0, -2 * std::numbers::pi * (m + 0.5) / kMonths);
    }
  }
  return first_degree(grid, harmonic);
}

TEST(EnergyBalance, HarmonicSolvesTheStoringPlanet) {
  // On a uniform planet degree 1 dominates the annual harmonic: T1 = Q1 a / (2 D + B + i omega C).
  const Grid grid = Grid::sphere(90, 90);
  EnergyBalance model = constant_albedo();
  model.land_heat_capacity_w_yr_m2_k = 3.0;
  const auto s = solve(grid, model, 1.0F);
  const std::complex<double> expected =
      first_degree_insolation(grid, kCircle) * 0.7 /
      std::complex<double>(2 * 0.55 + 2.0, 2 * std::numbers::pi * 3.0);
  EXPECT_NEAR(std::abs(first_degree(grid, s.harmonic(1)) / expected - 1.0), 0.0, 1e-3);
}

// The slab of water answers through its exchange g with the air: i omega C becomes
// i omega C g / (g + i omega C), and of the sun's heat that it takes g / (g + i omega C) comes
// back. Where the year's sun is the same at all latitudes, so are temperature (14 degC) and g.
TEST(EnergyBalance, SeaAnswersThroughItsExchangeWithTheAir) {
  const Grid grid = Grid::sphere(90, 90);
  EnergyBalance model = constant_albedo();
  model.orbit = {54.7356, 0.0, 0.0};
  model.diffusivity_w_m2_k = 5.0;
  model.ocean_heat_capacity_w_yr_m2_k = 5.0;
  model.sunlit_air_share = 0.2;
  for (const double at_15_c : {5.0, 20.0, 1e4}) {
    model.sea_exchange_w_m2_k = at_15_c;
    const auto s = solve(grid, model, 0.0F);
    const double exchange =
        at_15_c * (1.0 + latent_to_sensible_slope(14.0)) / (1.0 + latent_to_sensible_slope(15.0));
    const std::complex<double> stored(0.0, 2 * std::numbers::pi * 5.0);
    const std::complex<double> passed = exchange / (exchange + stored);
    const std::complex<double> expected = first_degree_insolation(grid, model.orbit) * 0.7 *
                                          (0.2 + 0.8 * passed) / (2 * 5.0 + 2.0 + stored * passed);
    EXPECT_NEAR(std::abs(first_degree(grid, s.harmonic(1)) / expected - 1.0), 0.0, 1e-3) << at_15_c;
  }
}

TEST(EnergyBalance, HeightsMatterThroughSnowIceAndTheHeatThatTheyHoldBack) {
  const Grid grid = Grid::sphere(60, 30);
  EnergyBalance open;
  open.blocking_height_m = 1e12;
  const Index cell = grid.cell(0, 3);
  EXPECT_LT(solve(grid, open, 1.0F, 3000.0F).mean_c(cell), solve(grid, open, 1.0F).mean_c(cell))
      << "a high plateau near the pole is icier";
  EnergyBalance without = open;
  without.ice_width_k = 0.0;
  const double low_c = solve(grid, without, 1.0F).mean_c(cell);
  EXPECT_NEAR(solve(grid, without, 1.0F, 3000.0F).mean_c(cell), low_c, 1e-6);
  // Where the diffusivity is that of a fraction, so is the temperature.
  EnergyBalance blocked = without, slow = without;
  blocked.blocking_height_m = 3000.0;
  slow.diffusivity_w_m2_k *= 0.5;
  EXPECT_NEAR(solve(grid, blocked, 1.0F, 3000.0F).mean_c(cell),
              solve(grid, slow, 1.0F).mean_c(cell), 1e-6);
  EXPECT_LT(solve(grid, slow, 1.0F).mean_c(cell), low_c - 1.0);
}

// Behind a range that holds heat back the far side keeps its own climate.
TEST(EnergyBalance, RangesKeepWarmGroundFromCold) {
  const Grid grid = Grid::sphere(90, 45);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  EnergyBalance model = constant_albedo();
  model.blocking_height_m = 100.0;  // next to nothing passes
  std::vector<float> land(grid.size(), 1.0F), flat(grid.size(), 0.0F), range = flat;
  for (Index c = 0; c < grid.size(); ++c) {
    if (std::abs(grid.latitude_deg(grid.row(c)) - 32.0) < 3.0) range[c] = 5000.0F;
  }
  const auto contrast_k = [&](const std::vector<float>& height_m) {
    const auto year = solve_energy_balance(grid, model, false, latitude, land, height_m);
    return year.month_c(grid.cell(0, 29), 0) - year.month_c(grid.cell(0, 33), 0);
  };
  // Radiation alone holds the two sides together: 1.37 times as far apart as on level ground.
  EXPECT_GT(contrast_k(range), 1.3 * contrast_k(flat));
}

/// A planet of sea from which a wall of land rises along one meridian, from 80 S to `end_deg`.
std::vector<float> wall(const Grid& grid, double end_deg) {
  std::vector<float> land(grid.size(), 0.0F);
  for (int j = 0; j < grid.ny(); ++j) {
    if (grid.latitude_deg(j) > -80.0 && grid.latitude_deg(j) < end_deg)
      land[grid.cell(3, j)] = 1.0F;
  }
  return land;
}

TEST(OceanHeat, ChannelsAreWhereNoCoastBarsTheWayRound) {
  const Grid grid = Grid::sphere(60, 90);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  const auto behind_wall = open_channels(grid, latitude, wall(grid, 58.0));
  const auto at_sea = open_channels(grid, latitude, std::vector<float>(grid.size(), 0.0F));
  for (int j = 0; j < grid.ny(); ++j) {
    const double degrees = latitude[j];
    if (std::abs(degrees) > 51.0) {
      EXPECT_NEAR(at_sea[j], 1.0, 1e-12) << degrees;
    }
    if (std::abs(degrees) < 30.0) {
      EXPECT_EQ(at_sea[j], 0.0) << degrees;
    }
    if (degrees > -71.0 && degrees < 49.0) {
      EXPECT_EQ(behind_wall[j], 0.0) << degrees;
    }
    if (degrees > 67.0) {
      EXPECT_NEAR(behind_wall[j], 1.0, 1e-12) << degrees;
    }
  }
}

// As round Antarctica, without gyres the sea keeps its warmth from the pole.
TEST(EnergyBalance, PolarSeaBehindAChannelIsCold) {
  const Grid grid = Grid::sphere(60, 90);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  EnergyBalance model = constant_albedo();
  const std::vector<float> flat(grid.size(), 0.0F);
  const auto pole_c = [&](double channel_share, double end_deg) {
    model.channel_share = channel_share;
    return solve_energy_balance(grid, model, false, latitude, wall(grid, end_deg), flat)
        .mean_c(static_cast<std::size_t>(grid.cell(30, grid.ny() - 1)));
  };
  EXPECT_NEAR(pole_c(0.0, 50.0), pole_c(0.0, 88.0), 0.2) << "a wall takes hardly any room";
  EXPECT_LT(pole_c(0.5, 50.0), pole_c(0.5, 88.0) - 3.0);
}

/// A northern polar continent, and the year on it with and without ice.
struct PolarContinent {
  static constexpr int kCoast = 25;  ///< first row of land, 60 N
  Grid grid = Grid::sphere(60, 30);
  std::vector<double> latitude;
  std::vector<float> land, flat, iced;
  PolarContinent() : land(grid.size(), 0.0F), flat(land), iced(land) {
    for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
    for (Index c = 0; c < grid.size(); ++c) {
      if (grid.row(c) >= kCoast) land[c] = iced[c] = 1.0F;
    }
  }
  [[nodiscard]] TemperatureCycle year(const EnergyBalance& model, bool under_ice) const {
    return solve_energy_balance(
        grid, model, false, latitude, land, flat, {},
        under_ice ? std::span<const float>(iced) : std::span<const float>());
  }
  [[nodiscard]] Index inland() const { return grid.cell(0, grid.ny() - 2); }
};

double warmest_c(const TemperatureCycle& year, Index cell) {
  double warmest = -1e9;
  for (int m = 0; m < kMonths; ++m) warmest = std::max(warmest, year.month_c(cell, m));
  return warmest;
}

TEST(EnergyBalance, IceOnLandMakesSummersColdAndFarClimatesHardly) {
  const PolarContinent planet;
  EnergyBalance model;
  model.channel_share = 0.0;  // else it has ice of its own accord
  const auto bare = planet.year(model, false), iced = planet.year(model, true);
  EXPECT_LT(warmest_c(iced, planet.inland()), warmest_c(bare, planet.inland()) - 5.0);
  const Index tropics = planet.grid.cell(0, 15);
  EXPECT_NEAR(iced.mean_c(tropics), bare.mean_c(tropics), 1.5);
  // Without sunlight to reflect and without melting, ice is ground like any other that is frozen.
  EnergyBalance dark = model;
  dark.glacier_coalbedo = dark.ice_coalbedo;
  dark.melt_w_m2_k = 0.0;
  EXPECT_LT(warmest_c(planet.year(dark, true), planet.inland()),
            warmest_c(iced, planet.inland()) + 1.0);
}

TEST(EnergyBalance, MeltingHoldsSummersOverIceNearFreezing) {
  const PolarContinent planet;
  EnergyBalance model;
  model.channel_share = 0.0;
  model.glacier_coalbedo = 0.6;  // dark enough to melt
  model.melt_w_m2_k = 0.0;
  const double unmelted_c = warmest_c(planet.year(model, true), planet.inland());
  model.melt_w_m2_k = 20.0;
  const double melting_c = warmest_c(planet.year(model, true), planet.inland());
  ASSERT_GT(unmelted_c, 4.0);
  EXPECT_LT(melting_c, 0.5 * unmelted_c);
  EXPECT_GT(melting_c, -1.0);
}

TEST(EnergyBalance, SnowAndIceNeverDarkenWhatTheyLieOn) {
  const PolarContinent planet;
  EnergyBalance model;
  model.snow_coalbedo = model.open_snow_coalbedo = model.sea_ice_coalbedo = 0.9;
  const auto year = planet.year(model, false);
  model.snow_coalbedo = model.open_snow_coalbedo = model.sea_ice_coalbedo = 1.0;
  const auto darker = planet.year(model, false);
  for (Index c = 0; c < planet.grid.size(); ++c) ASSERT_EQ(year.mean_c(c), darker.mean_c(c));
}

TEST(EnergyBalance, OpenSnowDelaysSpringWhereSummersAreTooColdForTrees) {
  const PolarContinent planet;
  EnergyBalance model;
  model.channel_share = 0.0;  // else it has ice of its own accord
  model.freezing_heat_w_yr_m2 = 0.0;
  model.open_snow_coalbedo = 0.4;
  model.tree_temperature_c = 60.0;  // trees nowhere
  const auto bright = planet.year(model, false);
  model.tree_temperature_c = -60.0;  // trees everywhere
  const auto wooded = planet.year(model, false);
  constexpr int kMay = 4;
  EXPECT_LT(bright.month_c(planet.inland(), kMay), wooded.month_c(planet.inland(), kMay) - 2.0);
}

// The heat of freezing is lent, not made: it warms the autumn by what it takes from the spring.
TEST(EnergyBalance, FreezingGroundDelaysTheSeasons) {
  const PolarContinent planet;
  EnergyBalance model = constant_albedo();
  model.ice_width_k = 2.0;
  model.snow_coalbedo = model.open_snow_coalbedo = model.ice_coalbedo = model.coalbedo;
  model.sea_ice_coalbedo = model.coalbedo;
  model.freezing_heat_w_yr_m2 = 0.0;
  const auto dry = planet.year(model, false);
  model.freezing_heat_w_yr_m2 = 2.0;
  const auto wet = planet.year(model, false);
  const Index cell = planet.grid.cell(0, PolarContinent::kCoast + 1);
  EXPECT_NEAR(wet.mean_c(cell), dry.mean_c(cell), 0.1);
  EXPECT_LT(std::arg(wet.harmonic(1)[cell] / dry.harmonic(1)[cell]), -0.02) << "later";
}

TEST(EnergyBalance, SeaWindsMakeWesternCoastsMild) {
  const Grid grid = Grid::sphere(90, 45);
  std::vector<double> latitude;
  for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
  std::vector<float> land(grid.size());
  for (Index c = 0; c < grid.size(); ++c) land[c] = grid.column(c) < 30 ? 1.0F : 0.0F;
  EnergyBalance model;
  model.advected_heat_j_m2_k = 9.5e6;
  model.gyre_heat_w_m2 = model.subpolar_heat_w_m2 = model.upwelling_w_m2 = 0.0;
  const std::vector<float> flat(land.size(), 0.0F);
  const auto range = [&](bool retrograde, int column) {
    const auto year =
        solve_energy_balance(grid, model, retrograde, latitude, land, flat,
                             [&](auto, auto, std::span<float> east, std::span<float> north) {
                               std::fill(east.begin(), east.end(), retrograde ? -5.0F : 5.0F);
                               std::fill(north.begin(), north.end(), 0.0F);
                             });
    const Index cell = grid.cell(column, 34);  // 50 N
    return 2.0 * std::abs(year.harmonic(1)[cell]);
  };
  EXPECT_LT(range(false, 1), range(false, 28)) << "the western coast has the smaller range";
  EXPECT_NEAR(range(true, 28), range(false, 1), 1e-3) << "mirrored on a planet that turns back";
}

/// A planet of one continent, a third of its meridians, and winds that change with the months.
struct WindyPlanet {
  Grid grid = Grid::sphere(60, 30);
  std::vector<double> latitude;
  std::vector<float> land, flat;
  WindyPlanet() : land(grid.size()), flat(land.size(), 0.0F) {
    for (int j = 0; j < grid.ny(); ++j) latitude.push_back(grid.latitude_deg(j));
    for (Index c = 0; c < grid.size(); ++c) land[c] = grid.column(c) < 20 ? 1.0F : 0.0F;
  }
  [[nodiscard]] TemperatureCycle year(float speed_m_s) const {
    EnergyBalance model = constant_albedo();
    model.advected_heat_j_m2_k = 5e6;
    model.gyre_heat_w_m2 = model.subpolar_heat_w_m2 = model.upwelling_w_m2 = 0.0;
    return solve_energy_balance(
        grid, model, false, latitude, land, flat,
        [&](std::span<const float> month_c, auto, std::span<float> east, std::span<float> north) {
          for (std::size_t c = 0; c < month_c.size(); ++c) {
            const Index cell = static_cast<Index>(c);
            east[c] = speed_m_s * (month_c[c] > 10.0F ? 1.0F : -0.5F);
            north[c] = grid.column(cell) < 20 ? -speed_m_s : 0.5F * speed_m_s;
          }
        });
  }
  [[nodiscard]] double mean_c(const TemperatureCycle& year) const {
    double sum = 0.0;
    for (Index c = 0; c < grid.size(); ++c) sum += year.mean_c(c) * grid.area_m2(grid.row(c));
    return sum / grid.total_area_m2();
  }
};

TEST(EnergyBalance, WindsMoveHeatAndMakeNone) {
  const WindyPlanet planet;
  const auto still = planet.year(0.0F), windy = planet.year(3.0F);
  EXPECT_NEAR(planet.mean_c(windy), planet.mean_c(still), 1e-3);
  const Index inland = planet.grid.cell(10, 24);  // 57 N, under wind from the north
  EXPECT_LT(windy.mean_c(inland), still.mean_c(inland) - 1.0);
}

/// Heat of currents on that planet, row 15 the first north of the equator.
struct Currents {
  WindyPlanet planet;
  std::vector<double> heat_w_m2;
  Currents(const EnergyBalance& model, bool retrograde, int land_columns = 20)
      : heat_w_m2(planet.land.size()) {
    for (Index c = 0; c < planet.grid.size(); ++c) {
      planet.land[c] = planet.grid.column(c) < land_columns ? 1.0F : 0.0F;
    }
    ocean_heat(planet.grid, model, retrograde, planet.latitude, planet.land, heat_w_m2);
  }
  [[nodiscard]] double at(int column, int row) const {
    return heat_w_m2[planet.grid.cell(column, row)];
  }
  [[nodiscard]] double sum_w() const {
    return area_sum<double>(planet.grid, [&](Index cell) { return heat_w_m2[cell]; });
  }
};

EnergyBalance only_upwelling() {
  EnergyBalance model;
  model.gyre_heat_w_m2 = model.subpolar_heat_w_m2 = model.coastal_upwelling_w_m2 = 0.0;
  model.upwelling_w_m2 = 50.0;
  model.upwelling_reach_km = 6000.0;
  model.upwelling_width_deg = 5.0;
  return model;
}

TEST(OceanHeat, WellsUpAtTheEquatorOffTheCoastThatTradesLeave) {
  const Currents forward(only_upwelling(), false), back(only_upwelling(), true);
  EXPECT_LT(forward.at(59, 15), -30.0) << "beside the eastern coast";
  EXPECT_GT(forward.at(20, 15), forward.at(59, 15) * 0.2) << "the west of the basin is warm";
  EXPECT_EQ(forward.at(10, 15), 0.0) << "on land";
  EXPECT_NEAR(back.at(20, 15), forward.at(59, 15), 1e-9) << "mirrored";
  const Currents narrow(only_upwelling(), false, 50);
  EXPECT_GT(narrow.at(59, 15), 0.7 * forward.at(59, 15)) << "a narrow ocean is tilted less";
}

TEST(OceanHeat, WellsUpAtTheEquatorUnderTradesAlone) {
  EnergyBalance model = only_upwelling();
  model.upwelling_trades_m_s = 6.0;
  for (const bool retrograde : {false, true}) {
    const double forward = retrograde ? -1.0 : 1.0;
    const Currents always(model, retrograde);
    const auto& planet = always.planet;
    const auto under = [&](double wind_m_s) {
      std::vector<double> heat_w_m2(planet.land.size());
      const std::vector<double> winds_m_s(planet.grid.nx(), forward * wind_m_s);
      ocean_heat(planet.grid, model, retrograde, planet.latitude, planet.land, heat_w_m2,
                 winds_m_s);
      return heat_w_m2;
    };
    EXPECT_EQ(under(-9.0), always.heat_w_m2);
    const auto half = under(-2.0), none = under(2.0);
    for (Index c = 0; c < planet.grid.size(); ++c) {
      ASSERT_NEAR(half[c], 0.5 * always.heat_w_m2[c], 1e-9);
      ASSERT_EQ(none[c], 0.0);
    }
  }
}

// What is known when the winds are is what would have been found with them from the start.
TEST(OceanHeat, TemperaturesFollowTheWindsAlongTheEquator) {
  const EnergyBalance model;
  const Currents currents(model, false);
  const WindyPlanet& planet = currents.planet;
  const std::vector<float> flat(planet.land.size(), 0.0F);
  const auto begin = [&](const EnergyBalance& energy) {
    return EnergyBalanceYear(planet.grid, energy, false, planet.latitude, planet.land, flat, {},
                             {});
  };
  const auto differ_most_k = [&](const TemperatureCycle& a, const TemperatureCycle& b) {
    double most = 0.0;
    for (std::size_t c = 0; c < flat.size(); ++c) {
      most = std::max(most, std::abs(a.mean_c(c) - b.mean_c(c)));
    }
    return most;
  };
  EnergyBalanceYear year = begin(model);
  const TemperatureCycle first = year.temperature();
  year.upwell(std::vector<double>(planet.grid.nx(), -1e3));
  EXPECT_LT(differ_most_k(year.temperature(), first), 0.01) << "trades all along, as assumed";
  EnergyBalance without = model;
  without.upwelling_w_m2 = 0.0;
  const EnergyBalanceYear expected = begin(without);
  EXPECT_GT(differ_most_k(first, expected.temperature()), 1.0);
  year.upwell(std::vector<double>(planet.grid.nx(), 1e3));
  EXPECT_LT(differ_most_k(year.temperature(), expected.temperature()), 0.3) << "westerlies";
}

TEST(OceanHeat, WellsUpOffEasternCoastsBelowTheSubtropicalHighs) {
  EnergyBalance model = only_upwelling();
  model.upwelling_w_m2 = 0.0;
  model.coastal_upwelling_w_m2 = 40.0;
  model.coastal_upwelling_reach_km = 1500.0;
  const Currents forward(model, false), back(model, true);
  const int below_highs = 18, polar = 24;  // 21 and 57 N
  EXPECT_LT(forward.at(59, below_highs), forward.at(22, below_highs) - 25.0) << "by the coast";
  EXPECT_GT(forward.at(22, below_highs), 0.0) << "far from it";
  EXPECT_NEAR(forward.at(59, polar), forward.at(40, polar), 1e-9) << "poleward of the highs";
  EXPECT_GT(forward.at(59, 15), forward.at(22, 15) - 3.0) << "near the equator";
  EXPECT_NEAR(back.at(20, below_highs), forward.at(59, below_highs), 1e-9) << "mirrored";
}

TEST(OceanHeat, MakesTheSeaWarmerThanTheAirByWhatItPassesOn) {
  const EnergyBalance model;
  const Currents currents(model, false);
  const auto& planet = currents.planet;
  std::vector<double> annual_mean_c(planet.land.size(), 20.0);
  const Index frozen = planet.grid.cell(40, 28), open = planet.grid.cell(59, 18);
  annual_mean_c[frozen] = -40.0;
  const auto warmer_k =
      sea_warmth_k(planet.grid, model, false, planet.latitude, planet.land, annual_mean_c);
  EXPECT_NEAR(warmer_k[open] * sea_exchange_w_m2_k(model, 20.0), currents.heat_w_m2[open], 1e-4);
  EXPECT_LT(warmer_k[open], -0.5F);
  EXPECT_NEAR(warmer_k[frozen], 0.0F, 1e-3F) << "ice keeps the air from the water";
  EXPECT_EQ(warmer_k[planet.grid.cell(10, 18)], 0.0F) << "on land";
  EXPECT_DOUBLE_EQ(sea_exchange_w_m2_k(model, 15.0), model.sea_exchange_w_m2_k);
  EXPECT_GT(sea_exchange_w_m2_k(model, 25.0), 1.2 * model.sea_exchange_w_m2_k);
  EXPECT_LT(dry_sea_exchange_w_m2_k(model), 0.6 * model.sea_exchange_w_m2_k);
}

TEST(OceanHeat, IsMovedAndNotMade) {
  for (const bool retrograde : {false, true}) {
    const Currents currents(EnergyBalance{}, retrograde);
    double released = 0.0;
    for (Index c = 0; c < currents.planet.grid.size(); ++c) {
      released += std::abs(currents.heat_w_m2[c]) *
                  currents.planet.grid.area_m2(currents.planet.grid.row(c));
    }
    EXPECT_LT(std::abs(currents.sum_w()), 1e-12 * released);
  }
}

TEST(OceanHeat, WarmsTheEasternCoastsOfSubpolarSeas) {
  EnergyBalance model;
  model.gyre_heat_w_m2 = model.upwelling_w_m2 = model.coastal_upwelling_w_m2 = 0.0;
  model.subpolar_heat_w_m2 = 40.0;
  const Currents currents(model, false);
  const int subpolar = 25, subtropical = 20;  // 63 and 33 N
  EXPECT_GT(currents.at(59, subpolar), 5.0);
  EXPECT_LT(currents.at(20, subpolar), -5.0);
  EXPECT_NEAR(currents.at(59, subtropical), currents.at(20, subtropical), 1e-9);
}

TEST(Budyko, SpotValueAndLimits) {
  EXPECT_NEAR(800.0 * budyko_evaporated_share(1000.0 / 800.0), 615.65, 0.01);
  EXPECT_EQ(budyko_evaporated_share(0.0), 0.0);
  EXPECT_NEAR(budyko_evaporated_share(1e-4), 1e-4, 1e-7) << "wet: all of the energy evaporates";
  EXPECT_NEAR(budyko_evaporated_share(50.0), 1.0, 1e-3) << "dry: all of the rain evaporates";
}

TEST(Clearness, FallsFromDesertsToRainforests) {
  EXPECT_NEAR(clearness(0.0, 2000.0), (0.25 + 0.5 * 0.9) / 0.5, 1e-12);
  EXPECT_NEAR(clearness(1e6, 1500.0), (0.25 + 0.5 * 0.35) / 0.5, 1e-12);
  EXPECT_EQ(clearness(500.0, 0.0), 1.0);
  for (double rain = 100.0; rain < 4000.0; rain *= 1.3) {
    EXPECT_LT(clearness(1.3 * rain, 1500.0), clearness(rain, 1500.0)) << rain;
  }
}

TEST(Oudin, FollowsItsFormula) {
  // 300 W m-2 for a day over 2.45 MJ kg-1 is 10.58 mm; (15 + 5)/100 of it.
  EXPECT_NEAR(oudin_evaporation_mm_d(300.0, 15.0), 300.0 * 86400 / 2.45e6 * 0.2, 1e-12);
  EXPECT_EQ(oudin_evaporation_mm_d(300.0, -5.0), 0.0);
}

}  // namespace
}  // namespace geo
