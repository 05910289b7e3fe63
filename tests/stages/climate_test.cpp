#include "geo/stages/climate/climate.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <set>

namespace geo {
namespace {

/// A northern continent with a meridional range, a southern one, and sea.
float relief_at(double latitude_deg, double longitude_deg) {
  const double lon = longitude_deg;
  const bool north = latitude_deg > 5 && latitude_deg < 65 && lon > -60 && lon < 60;
  const bool south = latitude_deg < -10 && latitude_deg > -45 && lon > 100 && lon < 150;
  if (!north && !south) return -4000.0F;
  const double range = std::exp(-std::pow((lon - 20.0) / 6.0, 2));
  return static_cast<float>(200.0 + (north ? 2500.0 * range : 0.0));
}

std::vector<float> relief(const Grid& grid, double turn_deg = 0.0) {
  std::vector<float> h(static_cast<std::size_t>(grid.size()));
  for (Index c = 0; c < grid.size(); ++c) {
    const double lon = std::remainder(grid.longitude_deg(grid.column(c)) - turn_deg, 360.0);
    h[c] = relief_at(grid.latitude_deg(grid.row(c)), lon);
  }
  return h;
}

/// Coarse air makes the tests fast; nothing that they claim depends on it.
ClimateParameters quick() {
  ClimateParameters p;
  p.resolution_deg = 5.0;
  return p;
}

State run(std::shared_ptr<const Grid> grid, std::vector<float> elevation,
          ClimateParameters parameters, Context& context) {
  State state(std::move(grid));
  state.set(field::elevation, std::move(elevation));
  const auto stage = make_climate_stage(std::move(parameters));
  StageIo io(state, stage->info());
  stage->run(io, context);
  return state;
}

State run(std::shared_ptr<const Grid> grid, std::vector<float> elevation,
          ClimateParameters parameters = quick(), Context&& context = {}) {
  return run(std::move(grid), std::move(elevation), std::move(parameters), context);
}

const Field<float>* const kOutputs[] = {
    &field::temperature,        &field::temperature_range,
    &field::precipitation,      &field::precipitation_seasonality,
    &field::wind_east,          &field::wind_north,
    &field::distance_to_coast,  &field::potential_evapotranspiration,
    &field::ocean_current_east, &field::ocean_current_north};

void expect_sound(const State& state, const std::string& which) {
  for (const auto* spec : kOutputs) {
    for (const float value : state.read(*spec)) {
      ASSERT_TRUE(std::isfinite(value)) << which << ": " << spec->name;
    }
  }
  const auto rain = state.read(field::precipitation);
  const auto temperature = state.read(field::temperature);
  const auto season = state.read(field::precipitation_seasonality);
  for (std::size_t c = 0; c < rain.size(); ++c) {
    ASSERT_GE(rain[c], 0.0F) << which;
    ASSERT_GE(temperature[c], -270.0F) << which;
    ASSERT_LE(std::abs(season[c]), 1.0F) << which;
    ASSERT_GE(state.read(field::potential_evapotranspiration)[c], 0.0F) << which;
  }
}

double area_mean(const State& state, const Field<float>& spec) {
  const Grid& grid = state.grid();
  double sum = 0.0;
  for (Index c = 0; c < grid.size(); ++c) sum += grid.area_m2(grid.row(c)) * state.read(spec)[c];
  return sum / grid.total_area_m2();
}

double rain_m3_s(const State& state) {
  return area_mean(state, field::precipitation) * state.grid().total_area_m2() * 1e-3 /
         (365.25 * 86400.0);
}

TEST(Climate, MonthsAddUpToTheYear) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(96, 48));
  Context context;
  const State state = run(grid, relief(*grid), quick(), context);
  ASSERT_TRUE(context.monthly_fields);
  const auto size = static_cast<std::size_t>(grid->size());
  std::vector<float> values(size);
  std::vector<double> rain(size), warmth(size), east(size);
  std::vector<float> warmest(size, -1e9F), coldest(size, 1e9F);
  for (int m = 0; m < kMonths; ++m) {
    context.monthly_fields(field::precipitation_monthly, m, state.read(field::precipitation),
                           values);
    for (std::size_t c = 0; c < size; ++c) rain[c] += values[c];
    context.monthly_fields(field::temperature_monthly, m, state.read(field::temperature), values);
    for (std::size_t c = 0; c < size; ++c) {
      warmth[c] += values[c] / 12.0;
      warmest[c] = std::max(warmest[c], values[c]);
      coldest[c] = std::min(coldest[c], values[c]);
    }
    context.monthly_fields(field::wind_east_monthly, m, {}, values);
    for (std::size_t c = 0; c < size; ++c) east[c] += values[c] / 12.0;
  }
  for (std::size_t c = 0; c < size; ++c) {
    ASSERT_NEAR(rain[c], state.read(field::precipitation)[c],
                1e-5 * state.read(field::precipitation)[c] + 1e-3);
    ASSERT_NEAR(warmth[c], state.read(field::temperature)[c], 1e-4);
    ASSERT_NEAR(east[c], state.read(field::wind_east)[c], 1e-4);
    ASSERT_NEAR(warmest[c] - coldest[c], state.read(field::temperature_range)[c], 1e-4);
  }
}

TEST(Climate, SlowPlanetsHaveWideCellsAndRetrogradeOnesTradesFromTheWest) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(64, 32));
  const std::vector<float> sea(static_cast<std::size_t>(grid->size()), -3000.0F);
  const auto zonal_wind = [&](double hours, bool retrograde) {
    ClimateParameters p = quick();
    p.seasonal.circulation.rotation_period_h = hours;
    p.seasonal.circulation.retrograde = retrograde;
    const State state = run(grid, sea, p);
    const auto wind = state.read(field::wind_east);
    return std::vector<float>(wind.begin(), wind.end());
  };
  const auto trades_to_deg = [&](const std::vector<float>& wind) {
    for (int j = 17; j < 32; ++j) {
      if (wind[grid->cell(0, j)] > 0.0F) return grid->latitude_deg(j);
    }
    return 90.0;
  };
  EXPECT_GT(trades_to_deg(zonal_wind(72.0, false)),
            trades_to_deg(zonal_wind(23.934, false)) + 10.0);
  EXPECT_LT(zonal_wind(23.934, false)[grid->cell(0, 18)], 0.0F);
  EXPECT_GT(zonal_wind(23.934, true)[grid->cell(0, 18)], 0.0F);
}

TEST(Climate, DaysAsLongAsAirTakesToCoolAreWarnedOf) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(64, 32));
  const std::vector<float> sea(static_cast<std::size_t>(grid->size()), -3000.0F);
  const auto warnings = [&](double hours) {
    ClimateParameters p = quick();
    p.seasonal.circulation.rotation_period_h = hours;
    Context context;
    run(grid, sea, p, context);
    return context.warnings;
  };
  EXPECT_TRUE(warnings(240.0).empty());
  ASSERT_EQ(warnings(2000.0).size(), 1U);
  EXPECT_NE(warnings(2000.0).front().find("tidally locked"), std::string::npos);
}

TEST(Climate, ColdSeaIsUnderIceAndLandAndWarmSeaAreNot) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(64, 32));
  std::vector<float> elevation(static_cast<std::size_t>(grid->size()), -3000.0F);
  for (Index c = 0; c < grid->size(); ++c) {
    if (grid->column(c) < 16) elevation[c] = 100.0F;
  }
  const State state = run(grid, elevation, quick());
  const auto ice = state.read(field::sea_ice_area_fraction), mean = state.read(field::temperature);
  double most = 0.0;
  for (Index c = 0; c < grid->size(); ++c) {
    if (elevation[c] >= 0.0F) {
      ASSERT_EQ(ice[c], 0.0F);
    } else if (mean[c] > 10.0F) {
      ASSERT_LT(ice[c], 0.01F);
    } else if (mean[c] < -20.0F) {
      ASSERT_GT(ice[c], 0.9F);
    }
    most = std::max<double>(most, ice[c]);
  }
  EXPECT_GT(most, 0.5);
}

TEST(Climate, AllThatEvaporatesRains) {
  const double precise = 1e-6;  // floats hold each cell's rain to 6e-8
  for (const double lift_height_m : {300.0, 1450.0, 1e6}) {
    for (const double noise_mm_yr : {0.0, 300.0}) {
      for (const int nx : {36, 64, 200}) {  // coarser and finer than the air's own grid
        const auto grid = std::make_shared<Grid>(Grid::sphere(nx, nx / 2));
        ClimateParameters p = quick();
        p.lift_height_m = lift_height_m;
        p.precipitation_noise_mm_yr = noise_mm_yr;
        Context context;
        const State state = run(grid, relief(*grid), p, context);
        const double evaporation =
            context.budget.at("sea_evaporation_m3_s") + context.budget.at("land_evaporation_m3_s");
        EXPECT_NEAR(rain_m3_s(state) / evaporation, 1.0, precise)
            << nx << " columns, lift " << lift_height_m << " m, noise " << noise_mm_yr;
        EXPECT_NEAR(context.budget.at("precipitation_m3_s") / rain_m3_s(state), 1.0, 1e-9);
        EXPECT_LT(context.budget.at("air_water_closing_error"), precise);
        EXPECT_GT(evaporation, 1e6);
      }
    }
  }
  const auto torus = std::make_shared<Grid>(Grid::torus(64, 48, 200e3, 200e3));
  std::vector<float> half(64 * 48, -100.0F);
  std::fill(half.begin() + 1000, half.begin() + 2000, 1500.0F);
  Context context;
  run(torus, half, quick(), context);
  EXPECT_LT(context.budget.at("air_water_closing_error"), precise);
}

TEST(Climate, WhatRangesTakeOthersLack) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(200, 100));
  ClimateParameters none = quick();
  none.lift_height_m = 1e6;  // ranges lift the air and nothing follows
  const State with = run(grid, relief(*grid)), without = run(grid, relief(*grid), none);
  double more = 0.0, less = 0.0;
  const auto a = with.read(field::precipitation), b = without.read(field::precipitation);
  for (Index c = 0; c < grid->size(); ++c) {
    (a[c] > b[c] ? more : less) += (a[c] - b[c]) * grid->area_m2(grid->row(c));
  }
  EXPECT_GT(more, 0.0);
  // Air that is dried takes up more from the sea, but not all of it.
  EXPECT_LT(less, -0.3 * more);
}

TEST(Climate, TemperaturesThatAreHeldAreTold) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(72, 36));
  Context mild;
  run(grid, relief(*grid), quick(), mild);
  EXPECT_EQ(mild.budget.at("temperature_held_share"), 0.0);
  EXPECT_TRUE(mild.warnings.empty());
  ClimateParameters dark = quick();
  dark.seasonal.energy.solar_constant_w_m2 = 100.0;
  Context cold;
  const State state = run(grid, relief(*grid), dark, cold);
  double held = 0.0;
  for (Index c = 0; c < grid->size(); ++c) {
    if (state.read(field::temperature)[c] == -70.0F) held += grid->area_m2(grid->row(c));
  }
  EXPECT_GT(held, 0.0);
  EXPECT_NEAR(cold.budget.at("temperature_held_share"), held / grid->total_area_m2(), 1e-12);
  EXPECT_EQ(cold.warnings.size(), 1u);
}

TEST(Climate, DeclarationsAreSoundAndUnique) {
  const auto stage = make_climate_stage();
  std::set<std::string_view> names;
  for (const Parameter& p : stage->parameters()) {
    EXPECT_TRUE(p.name.starts_with("climate."));
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_FALSE(p.doc.empty()) << p.name;
    EXPECT_FALSE(p.source.empty()) << p.name;
    EXPECT_NO_THROW(p.set(p.default_value)) << p.name;
  }
}

TEST(Climate, OutputsAreSoundOnEveryTopologyAndModel) {
  for (const char* model : {"energy-balance", "blueprint"}) {
    ClimateParameters p = quick();
    p.model = model;
    const auto sphere = std::make_shared<Grid>(Grid::sphere(96, 48));
    expect_sound(run(sphere, relief(*sphere), p), "sphere");
    const auto window = std::make_shared<Grid>(Grid::window(60, 40, {30, 50, -10, 30}));
    expect_sound(run(window, relief(*window), p), "window");
    const auto plane =
        std::make_shared<Grid>(Grid::plane(50, 30, 1000, 1000, Edges::open, Centre{-20.0, 179.0}));
    expect_sound(run(plane, std::vector<float>(1500, 50.0F), p), "plane with a centre");
    const auto nowhere = std::make_shared<Grid>(Grid::plane(40, 30, 30e3, 30e3));
    std::vector<float> island(1200, -100.0F);
    island[15 * 40 + 20] = 900.0F;
    expect_sound(run(nowhere, island, p), "plane without latitude");
    const auto torus = std::make_shared<Grid>(Grid::torus(64, 48, 40e3, 40e3));
    std::vector<float> half(64 * 48, -100.0F);
    std::fill(half.begin() + 1000, half.begin() + 2000, 1500.0F);
    expect_sound(run(torus, half, p), "torus");
  }
}

TEST(Climate, OddPlanetsHaveAClimate) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(72, 36));
  const auto size = static_cast<std::size_t>(grid->size());
  const State sea = run(grid, std::vector<float>(size, -3000.0F));
  expect_sound(sea, "all sea");
  EXPECT_GT(area_mean(sea, field::precipitation), 300.0);
  const State land = run(grid, std::vector<float>(size, 300.0F));
  expect_sound(land, "all land");
  EXPECT_LT(area_mean(land, field::precipitation), 100.0) << "no sea, no rain";
  for (const double obliquity : {0.0, 60.0, 90.0, 120.0, 177.4}) {
    for (const double pressure : {0.05, 1.0, 10.0}) {
      Context context;
      context.planet.obliquity_deg = obliquity;
      context.planet.eccentricity = 0.0;
      context.planet.pressure_bar = pressure;
      const State state = run(grid, relief(*grid), quick(), context);
      // All the sunshine of the planet could evaporate S0/4 over 28.36 W m-2 per mm a day.
      EXPECT_LT(area_mean(state, field::precipitation), 1361.0 / 4 / 28.36 * 365.25);
      expect_sound(state, "obliquity " + std::to_string(obliquity));
      if (obliquity == 0.0) {
        for (const float range : state.read(field::temperature_range)) ASSERT_LT(range, 1e-3F);
      }
    }
  }
}

TEST(Climate, SymmetricPlanetHasASymmetricClimate) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(72, 36));
  std::vector<float> h(static_cast<std::size_t>(grid->size()));
  for (Index c = 0; c < grid->size(); ++c) {
    const double lat = std::abs(grid->latitude_deg(grid->row(c)));
    h[c] = lat > 20 && lat < 50 && std::abs(grid->longitude_deg(grid->column(c))) < 60 ? 500.0F
                                                                                       : -100.0F;
  }
  Context context;
  context.planet.eccentricity = 0.0;  // both hemispheres have the same summers
  const State state = run(grid, h, quick(), context);
  for (const auto* spec : {&field::temperature, &field::precipitation, &field::temperature_range,
                           &field::wind_east, &field::potential_evapotranspiration}) {
    const auto values = state.read(*spec);
    double worst = 0.0, largest = 0.0;
    for (int j = 0; j < 18; ++j) {
      for (int i = 0; i < 72; ++i) {
        const double south = values[grid->cell(i, j)], north = values[grid->cell(i, 35 - j)];
        worst = std::max(worst, std::abs(north - south));
        largest = std::max(largest, std::abs(north));
      }
    }
    EXPECT_LT(worst, 0.01 * largest) << spec->name;
  }
}

TEST(Climate, TurningThePlanetTurnsItsClimate) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(96, 48));
  const State here = run(grid, relief(*grid)), there = run(grid, relief(*grid, 90.0));
  for (const auto* spec : kOutputs) {
    const auto a = here.read(*spec), b = there.read(*spec);
    double worst = 0.0, largest = 0.0;
    for (int j = 0; j < 48; ++j) {
      for (int i = 0; i < 96; ++i) {
        worst = std::max<double>(worst,
                                 std::abs(a[grid->cell(i, j)] - b[grid->cell((i + 24) % 96, j)]));
        largest = std::max<double>(largest, std::abs(a[grid->cell(i, j)]));
      }
    }
    EXPECT_LT(worst, 2e-3 * largest) << spec->name;
  }
}

TEST(Climate, SameBitsForAnyNumberOfThreads) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(96, 48));
  for (const char* model : {"energy-balance", "blueprint"}) {
    ClimateParameters p = quick();
    p.model = model;
    p.temperature_noise_k = 2.0;
    p.precipitation_noise_mm_yr = 60.0;
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const State one = run(grid, relief(*grid), p);
    omp_set_num_threads(4);
    const State four = run(grid, relief(*grid), p);
    omp_set_num_threads(before);
    for (const auto* spec : kOutputs) {
      const auto a = one.read(*spec), b = four.read(*spec);
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << spec->name;
    }
  }
}

TEST(Climate, DoesNotDependOnResolution) {
  const auto coarse = std::make_shared<Grid>(Grid::sphere(180, 90));
  const auto fine = std::make_shared<Grid>(Grid::sphere(540, 270));
  const State a = run(coarse, relief(*coarse)), b = run(fine, relief(*fine));
  for (const auto* spec : {&field::temperature, &field::precipitation, &field::temperature_range}) {
    double difference = 0.0, size = 0.0;
    for (Index c = 0; c < coarse->size(); ++c) {
      const Index centre = fine->cell(3 * coarse->column(c) + 1, 3 * coarse->row(c) + 1);
      const double area = coarse->area_m2(coarse->row(c));
      difference += area * std::abs(a.read(*spec)[c] - b.read(*spec)[centre]);
      size += area * std::abs(a.read(*spec)[c]);
    }
    EXPECT_LT(difference / size, 0.03) << spec->name;
  }
}

TEST(Climate, TemperatureFallsByTheLapseRate) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(360, 180));
  auto h = relief(*grid);
  const Index here = grid->cell(180, 120);  // 30 N in the middle of the continent
  const State flat = run(grid, h);
  const float before = h[here];
  h[here] = before + 1000.0F;
  const State high = run(grid, h);
  const double fall_k = flat.read(field::temperature)[here] - high.read(field::temperature)[here];
  EXPECT_NEAR(fall_k, 1000.0 * ClimateParameters{}.seasonal.energy.lapse_k_m, 0.3);
}

TEST(Climate, InteriorsAreMoreSeasonalAndDrierThanCoasts) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(180, 90));
  const State state = run(grid, relief(*grid), {});
  const auto at = [&](const Field<float>& spec, double lat, double lon) {
    return state.read(
        spec)[grid->cell(static_cast<int>((lon + 180) / 2), static_cast<int>((lat + 90) / 2))];
  };
  EXPECT_GT(at(field::temperature_range, 55, 0), 1.5F * at(field::temperature_range, 55, 150));
  EXPECT_GT(at(field::precipitation, 50, -57), 1.2F * at(field::precipitation, 50, 0))
      << "westerlies lose their water on the way";
}

// Against the same continent without the range, whose rain falls off inland by itself, on a planet
// whose eddies make it windy all over.
TEST(Climate, LeeOfARangeIsDrierThanItsWindwardFoot) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(720, 360));
  auto plain = relief(*grid);
  for (float& height : plain) height = std::min(height, 200.0F);
  ClimateParameters windy = quick();
  windy.seasonal.circulation.eddy_wind_m_s = 60.0;
  const State state = run(grid, relief(*grid), windy), flat = run(grid, plain, windy);
  const int row = static_cast<int>((52 + 90) * 2);
  const auto gain = [&](double longitude_deg) {
    const Index cell = grid->cell(static_cast<int>((longitude_deg + 180) * 2), row);
    return state.read(field::precipitation)[cell] / flat.read(field::precipitation)[cell];
  };
  const float wind_m_s =
      state.read(field::wind_east)[grid->cell(static_cast<int>((14.0 + 180) * 2), row)];
  ASSERT_GT(std::abs(wind_m_s), 2.0F);
  const bool westerly = wind_m_s > 0.0F;
  const double windward = gain(westerly ? 14.0 : 26.0), lee = gain(westerly ? 26.0 : 14.0);
  EXPECT_LT(lee, 0.8 * windward);
}

TEST(Climate, NoiseIsBoundedByItsAmplitude) {
  const auto grid = std::make_shared<Grid>(Grid::sphere(96, 48));
  ClimateParameters p = quick();
  p.temperature_noise_k = 2.0;
  const State calm = run(grid, relief(*grid)), noisy = run(grid, relief(*grid), p);
  double largest = 0.0;
  for (Index c = 0; c < grid->size(); ++c) {
    largest = std::max<double>(
        largest, std::abs(noisy.read(field::temperature)[c] - calm.read(field::temperature)[c]));
  }
  EXPECT_GT(largest, 0.4);
  EXPECT_LE(largest, 2.2);
}

TEST(Climate, BlueprintFollowsItsFormulaOnThePlane) {
  const auto grid = std::make_shared<Grid>(Grid::plane(20, 20, 1000, 1000));
  ClimateParameters p = quick();
  p.model = "blueprint";
  p.latitude_deg = 0.0;
  const State state = run(grid, std::vector<float>(400, -10.0F), p);
  EXPECT_NEAR(state.read(field::temperature)[210], 28 + 2 + 5 * std::log(2.0), 0.01);
  EXPECT_NEAR(state.read(field::precipitation)[210], 2400.0, 1.0);
  EXPECT_LT(state.read(field::wind_east)[210], -6.9F) << "trades, 7 m s-1";
}

TEST(Climate, SeesTheIceThatLiesOnLand) {
  const auto grid = std::make_shared<const Grid>(Grid::sphere(72, 36));
  std::vector<float> polar(static_cast<std::size_t>(grid->size()), -4000.0F), ice(polar.size());
  for (Index c = 0; c < grid->size(); ++c) {
    const double latitude = grid->latitude_deg(grid->row(c));
    if (latitude > 60.0) ice[c] = 500.0F;
    // A neck of land bars the way round: gyres bring it warmth.
    if (latitude > 60.0 || (latitude > 0.0 && grid->column(c) == 20)) polar[c] = 300.0F;
  }
  const State bare = run(grid, polar);
  State iced(grid);
  iced.set(field::elevation, std::move(polar));
  iced.set(field::ice_thickness, std::move(ice));
  const auto stage = make_climate_stage(quick());
  StageIo io(iced, stage->info());
  Context context;
  stage->run(io, context);
  const Index cell = grid->cell(0, 33);
  const auto warmest = [&](const State& state) {
    return state.read(field::temperature)[cell] + 0.5F * state.read(field::temperature_range)[cell];
  };
  EXPECT_LT(warmest(iced), warmest(bare) - 5.0F);
}

}  // namespace
}  // namespace geo
