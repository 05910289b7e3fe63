#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/landscape/impact_crater.hpp"
#include "geo/stages/climate/climate.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {
namespace {

struct Outcome {
  std::vector<float> z;
  Budget budget;
  std::vector<EventRecord> records;
  std::vector<std::string> warnings;
};

Outcome strike(const Grid& grid, std::vector<float> z, std::vector<Event> events, int steps = 0) {
  const auto stage = make_erosion_stage();
  const auto parameters = stage->parameters();
  find_parameter(parameters, "erosion.steps")->set(std::int64_t{steps});
  find_parameter(parameters, "erosion.time_step_yr")->set(1e6);
  find_parameter(parameters, "erosion.warping_m")->set(0.0);
  State state(std::make_shared<const Grid>(grid));
  state.set(field::elevation, std::move(z));
  Context context;
  context.events = std::move(events);
  StageIo io(state, stage->info());
  stage->run(io, context);
  const auto out = state.read(field::elevation);
  return {{out.begin(), out.end()}, context.budget, context.event_records, context.warnings};
}

std::vector<float> plain(const Grid& grid, float height_m) {
  return std::vector<float>(grid.size(), height_m);
}

Event impact_at(double latitude_deg, double longitude_deg, double diameter_km = 12.0) {
  return {.name = "Test",
          .what = Impact{.latitude_deg = latitude_deg,
                         .longitude_deg = longitude_deg,
                         .diameter_km = diameter_km,
                         .velocity_km_s = 20.0}};
}

double volume_m3(const Grid& grid, const std::vector<float>& z, double ground_m) {
  double sum = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      sum += (z[grid.cell(i, j)] - ground_m) * grid.area_m2(j);
    }
  }
  return sum;
}

/// Volume that the profile moves on a sphere: cavity less rim and ejecta, by shells.
double volume_of_profile_m3(const Crater& crater, double planet_m) {
  double sum = 0.0;
  constexpr double kShell_m = 20.0;
  for (double r = 0.5 * kShell_m; r < 0.5 * std::numbers::pi * planet_m; r += kShell_m) {
    sum += crater_profile_m(crater, r) * 2.0 * std::numbers::pi * planet_m *
           std::sin(r / planet_m) * kShell_m;
    if (crater_profile_m(crater, r) < 1e-3 && r > crater.diameter_m) break;
  }
  return sum;
}

TEST(Events, CraterMovesTheSameVolumeAtAnyResolutionAndPlace) {
  const Crater crater = crater_of({.diameter_m = 12e3,
                                   .density_kg_m3 = 3000.0,
                                   .velocity_m_s = 20e3,
                                   .angle_deg = 45.0,
                                   .ground_density_kg_m3 = 2700.0,
                                   .gravity_m_s2 = 9.81});
  constexpr float kGround_m = 2000.0F;
  const double expected = volume_of_profile_m3(crater, 6371e3);
  const double cavity =
      std::numbers::pi / 4.0 * crater.diameter_m * crater.diameter_m * crater.depth_m;
  for (const int nx : {128, 512, 1024}) {
    const Grid grid = Grid::sphere(nx, nx / 2);
    for (const auto& [latitude, longitude] : {std::pair{3.0, 20.0}, {-48.7, 179.9}, {89.5, 10.0}}) {
      const Outcome out = strike(grid, plain(grid, kGround_m), {impact_at(latitude, longitude)});
      EXPECT_NEAR(volume_m3(grid, out.z, kGround_m), expected, 0.03 * cavity)
          << nx << " cells, latitude " << latitude;
    }
  }
}

TEST(Events, CraterHasRimFloorAndEjecta) {
  const Grid grid = Grid::window(400, 400, {-1.5, 1.5, -1.5, 1.5});  // cells of 830 m
  const Outcome out = strike(grid, plain(grid, 500.0F), {impact_at(0.0, 0.0, 5.0)});
  ASSERT_EQ(out.records.size(), 1U);
  const EventRecord& record = out.records[0];
  EXPECT_EQ(record.kind, "impact");
  EXPECT_EQ(record.name, "Test");
  const double radius_m = 500.0 * figure_of(record, "crater_diameter_km", 0.0);
  const double floor_m =
      500.0 + figure_of(record, "rim_m", 0.0) - figure_of(record, "crater_depth_m", 0.0);
  const auto height_at = [&](double distance_m) {
    const int column = 200 + static_cast<int>(distance_m / grid.spacing_east_m(200));
    return out.z[grid.cell(column, 200)];
  };
  EXPECT_NEAR(height_at(0.25 * radius_m), floor_m, 5.0);
  EXPECT_GT(height_at(radius_m), 500.0 + 0.7 * figure_of(record, "rim_m", 0.0));
  EXPECT_NEAR(height_at(2.0 * radius_m), 500.0 + figure_of(record, "rim_m", 0.0) / 8.0, 10.0);
  EXPECT_TRUE(out.warnings.empty());
}

TEST(Events, OldCratersAreWornDown) {
  const Grid grid = Grid::sphere(512, 256);
  auto fresh = impact_at(20.0, 40.0, 40.0), old = fresh;
  std::get<Impact>(old.what).age_yr = 5e6;
  const Outcome young = strike(grid, plain(grid, 3000.0F), {fresh}, 6);
  const Outcome aged = strike(grid, plain(grid, 3000.0F), {old}, 6);
  const auto highest = [](const Outcome& out) {
    return *std::max_element(out.z.begin(), out.z.end());
  };
  EXPECT_LT(highest(aged), highest(young) - 50.0F);
  EXPECT_EQ(figure_of(aged.records.at(0), "age_yr", 0.0), 5e6);
}

TEST(Events, EachComesOnceAndTheRockBudgetCloses) {
  const Grid grid = Grid::sphere(256, 128);
  std::vector<float> z = plain(grid, 800.0F);
  for (Index cell = 0; cell < grid.size() / 3; ++cell) z[cell] = -3000.0F;
  std::vector<Event> events{impact_at(30.0, -50.0, 30.0), impact_at(40.0, 100.0, 20.0)};
  std::get<Impact>(events[1].what).age_yr = 1e9;
  events.push_back(
      {.name = "Valley", .what = Rift{.path = {{20.0, 0.0}, {40.0, 10.0}}, .age_yr = 2.2e6}});
  events.push_back({.name = "", .what = OceanShift{.rise_m = 35.0}});
  const Outcome out = strike(grid, z, events, 4);
  ASSERT_EQ(out.records.size(), 4U);
  std::vector<int> numbers;
  for (const EventRecord& record : out.records) numbers.push_back(record.number);
  EXPECT_EQ(numbers, (std::vector<int>{2, 3, 1, 4}));  // as time passes
  EXPECT_LT(std::abs(out.budget.at("rock_closing_error")), 1e-9);
  ASSERT_EQ(out.warnings.size(), 1U);
  EXPECT_NE(out.warnings[0].find("event 2 (impact, Test): its age of 1e+09 yr is before"),
            std::string::npos)
      << out.warnings[0];
}

TEST(Events, SmallCratersAreToldToVanishInTheirCell) {
  const Grid grid = Grid::sphere(128, 64);
  const Outcome out = strike(grid, plain(grid, 100.0F), {impact_at(0.0, 0.0, 0.2)});
  ASSERT_EQ(out.warnings.size(), 1U);
  EXPECT_NE(out.warnings[0].find("smaller than a cell"), std::string::npos) << out.warnings[0];
}

TEST(Events, EvenRiftIsItsCrossSection) {
  const Grid grid = Grid::sphere(720, 360);
  const Event rift{.name = "",
                   .what = Rift{.path = {{0.0, -150.0}, {0.0, -90.0}},
                                .width_km = 600.0,
                                .depth_m = 900.0,
                                .shoulder_m = 400.0,
                                .shoulder_km = 300.0,
                                .roughness = 0.0}};
  const Outcome out = strike(grid, plain(grid, 2000.0F), {rift});
  const auto change_at = [&](double latitude_deg) {
    const int row = static_cast<int>((latitude_deg + 90.0) * 2.0);
    return out.z[grid.cell((180 - 120) * 2, row)] - 2000.0F;  // longitude -120
  };
  EXPECT_NEAR(change_at(0.0), -900.0, 1.0);
  EXPECT_NEAR(change_at(1.0), -900.0, 1.0);
  const double crest_deg = 300.0 / 111.195;
  EXPECT_NEAR(change_at(crest_deg), 400.0, 25.0);
  EXPECT_NEAR(change_at(-crest_deg), 400.0, 25.0);
  EXPECT_NEAR(change_at(crest_deg + 1.5 * 300.0 / 111.195), 400.0 * std::exp(-1.5) * std::cos(1.5),
              8.0);
  EXPECT_EQ(out.z[grid.cell(0, 0)], 2000.0F);
}

TEST(Events, OceanRisesByMetresOrByItsVolume) {
  const Grid grid = Grid::sphere(128, 64);
  std::vector<float> z(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    z[cell] = static_cast<float>(4000.0 * std::sin(0.1 * grid.column(cell)) - 1000.0);
  }
  const Outcome up = strike(grid, z, {{.name = "", .what = OceanShift{.rise_m = 80.0}}});
  for (Index cell = 0; cell < grid.size(); ++cell) ASSERT_FLOAT_EQ(up.z[cell], z[cell] - 80.0F);
  const double added_km3 = figure_of(up.records.at(0), "water_km3", 0.0);
  EXPECT_NEAR(added_km3, 80e-3 * 0.55 * 5.1e8, 0.1 * 80e-3 * 0.55 * 5.1e8);
  const Outcome same = strike(grid, z, {{.name = "", .what = OceanShift{.water_km3 = added_km3}}});
  EXPECT_NEAR(figure_of(same.records.at(0), "rise_m", 0.0), 80.0, 1e-3);
  try {
    strike(grid, z, {{.name = "Drain", .what = OceanShift{.water_km3 = -1e10}}});
    FAIL() << "more water was taken than there is";
  } catch (const ConfigurationError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("event 1 (ocean-shift, Drain): water_km3 = -1e+10 "
                        "takes more than the"),
              std::string::npos)
        << error.what();
  }
}

TEST(Events, DustCoolsAndDriesEverywhereAlikeAndNoOldImpactDoes) {
  const auto grid = std::make_shared<const Grid>(Grid::sphere(120, 60));
  std::vector<float> z(grid->size(), -3000.0F);
  for (int j = 25; j < 45; ++j) {
    for (int i = 20; i < 60; ++i) z[grid->cell(i, j)] = 300.0F;
  }
  const auto climate_with = [&](const std::string& model, std::vector<Event> events) {
    ClimateParameters parameters;
    parameters.model = model;
    parameters.resolution_deg = 6.0;
    State state(grid);
    state.set(field::elevation, z);
    const auto stage = make_climate_stage(std::move(parameters));
    StageIo io(state, stage->info());
    Context context;
    context.events = std::move(events);
    stage->run(io, context);
    return std::pair(std::move(state), context.event_records);
  };
  for (const char* model : {"energy-balance", "blueprint"}) {
    const auto [before, none] = climate_with(model, {});
    EXPECT_TRUE(none.empty());
    const auto [winter, records] = climate_with(model, {impact_at(0.0, 0.0, 1.0)});
    ASSERT_EQ(records.size(), 1U);
    const double cooling = figure_of(records[0], "cooling_k", 0.0);
    EXPECT_GT(cooling, 1.0);
    EXPECT_LT(cooling, 10.0);
    // The blueprint's 5.10 takes 200 mm per unit of optical depth from land, before its limits.
    const bool closed = model == std::string("blueprint");
    const double left = closed ? 1.0 : figure_of(records[0], "rain_left", 0.0);
    const double lost = closed ? figure_of(records[0], "rain_lost_mm_yr", 0.0) : 0.0;
    if (closed) {
      EXPECT_NEAR(lost, 200.0 * figure_of(records[0], "optical_depth", 0.0), 1e-9);
      EXPECT_GT(lost, 20.0);
    } else {
      EXPECT_NEAR(left, std::exp(-0.024 * cooling), 1e-12);
    }
    for (Index cell = 0; cell < grid->size(); ++cell) {
      ASSERT_NEAR(winter.read(field::temperature)[cell],
                  before.read(field::temperature)[cell] - cooling, 1e-3);
      const double usual = before.read(field::precipitation)[cell];
      const bool dries = !closed || z[cell] >= 0.0F;
      ASSERT_NEAR(winter.read(field::precipitation)[cell],
                  dries ? std::max(closed ? 20.0 : 0.0, left * usual - lost) : usual, 0.1);
      ASSERT_LE(winter.read(field::potential_evapotranspiration)[cell],
                before.read(field::potential_evapotranspiration)[cell]);
    }
    auto old = impact_at(0.0, 0.0, 1.0);
    std::get<Impact>(old.what).age_yr = 1e4;
    const auto [after, old_records] = climate_with(model, {old});
    EXPECT_TRUE(
        std::ranges::equal(after.read(field::temperature), before.read(field::temperature)));
  }
}

TEST(Events, AnyNumberOfThreadsGivesTheSameBits) {
  const Grid grid = Grid::sphere(256, 128);
  const std::vector<Event> events{
      impact_at(80.0, 170.0, 20.0),
      {.name = "", .what = Rift{.path = {{-60.0, 170.0}, {-70.0, -140.0}, {-50.0, -120.0}}}}};
  const int most = omp_get_max_threads();
  omp_set_num_threads(1);
  const Outcome one = strike(grid, plain(grid, 500.0F), events, 2);
  omp_set_num_threads(3);
  const Outcome three = strike(grid, plain(grid, 500.0F), events, 2);
  omp_set_num_threads(most);
  EXPECT_EQ(one.z, three.z);
}

}  // namespace
}  // namespace geo
