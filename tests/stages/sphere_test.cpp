// Planets whose plates have drifted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>

#include "drifted.hpp"
#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

const Drifted& one_planet() {
  static const Drifted kPlanet = drifted(192, 4, quick());
  return kPlanet;
}

double share_where(const State& state, const std::function<bool(Index)>& holds) {
  const Grid& grid = state.grid();
  double area = 0.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (holds(cell)) area += grid.area_m2(grid.row(cell));
  }
  return area / grid.total_area_m2();
}

TEST(DriftedPlates, WriteAllThatTheyDeclareAndItIsFinite) {
  const State& state = one_planet().state;
  const auto stage = make_plates_stage(quick());
  for (const FieldSpec* spec : stage->info().writes) {
    ASSERT_TRUE(state.has(*spec)) << spec->name;
    std::visit(
        [&](const auto& values) {
          for (const auto value : values) ASSERT_TRUE(std::isfinite(static_cast<double>(value)));
        },
        *state.values(*spec));
  }
}

TEST(DriftedPlates, HaveContinentsAboveAndOceansBelow) {
  const State& state = one_planet().state;
  const auto z = state.read(field::crust_elevation);
  const auto fraction = state.read(field::continental_fraction);
  const double land = share_where(state, [&](Index c) { return z[c] > 0.0F; });
  EXPECT_GT(land, 0.15);
  EXPECT_LT(land, 0.6);
  // Two modes with little between them.
  const double between =
      share_where(state, [&](Index c) { return z[c] > -2000.0F && z[c] < -200.0F; });
  EXPECT_LT(between, 0.1);
  const double wrong = share_where(state, [&](Index c) {
    return (fraction[c] > 0.999F && z[c] < -1000.0F) || (fraction[c] < 0.001F && z[c] > 500.0F);
  });
  EXPECT_LT(wrong, 0.005);
}

TEST(DriftedPlates, CountStretchedMarginsAsContinents) {
  PlatesParameters parameters = quick();
  parameters.erosion = "land";
  parameters.sphere.margin_km = 400.0;
  const State state = drifted(192, 4, parameters).state;
  const auto fraction = state.read(field::continental_fraction);
  const auto thickness = state.read(field::crust_thickness), age = state.read(field::crust_age);
  const double thin = share_where(state, [&](Index c) {
    return thickness[c] > 9500.0F && thickness[c] < 20000.0F && fraction[c] >= 0.5F;
  });
  EXPECT_GT(thin, 0.02);
  // No land's age, of a thousand Myr, among that of the floor.
  const double mixed =
      share_where(state, [&](Index c) { return fraction[c] < 0.45F && age[c] > 400.0F; });
  EXPECT_LT(mixed, 1e-4);
}

TEST(DriftedPlates, FloorIsYoungWherePlatesPartAndOldAwayFromThere) {
  const State& state = one_planet().state;
  const auto age = state.read(field::crust_age);
  const auto fraction = state.read(field::continental_fraction);
  const auto type = state.read(field::boundary_type);
  const auto mean = [&](const std::function<bool(Index)>& holds) {
    double sum = 0.0, area = 0.0;
    for (Index c = 0; c < state.grid().size(); ++c) {
      if (fraction[c] > 0.0F || !holds(c)) continue;
      const double weight = state.grid().area_m2(state.grid().row(c));
      sum += weight * age[c];
      area += weight;
    }
    return sum / area;
  };
  const double ridges =
      mean([&](Index c) { return type[c] == static_cast<std::int8_t>(BoundaryType::divergent); });
  const double all = mean([](Index) { return true; });
  EXPECT_LT(ridges, 0.4 * all);
  EXPECT_GT(all, 25.0);
  EXPECT_LT(all, 110.0);
}

TEST(DriftedPlates, CloseTheirBooks) {
  const Budget& budget = one_planet().budget;
  EXPECT_NEAR(budget.at("plates_area_error"), 0.0, 1e-12);
  EXPECT_NEAR(budget.at("continental_closing_error"), 0.0, 1e-6);
  EXPECT_GT(budget.at("crust_created_km2"), 1e8);
  EXPECT_NEAR(budget.at("crust_created_km2"),
              budget.at("crust_consumed_km2") + budget.at("crust_buried_km2"),
              0.1 * budget.at("crust_created_km2"));
}

TEST(DriftedPlates, AreTheSamePlanetOnEveryGrid) {
  // Cells of the coarse grid hold the middle of three cells of the fine one.
  const State& fine = one_planet().state;
  const State coarse = drifted(64, 4, quick()).state;
  int same = 0;
  for (Index c = 0; c < coarse.grid().size(); ++c) {
    const Index f = fine.grid().cell(3 * coarse.grid().column(c) + 1, 3 * coarse.grid().row(c) + 1);
    same += coarse.read(field::plate_id)[c] == fine.read(field::plate_id)[f] &&
            std::abs(coarse.read(field::crust_elevation)[c] -
                     fine.read(field::crust_elevation)[f]) < 1.0F;
  }
  EXPECT_GT(same, 0.99 * coarse.grid().size());
}

TEST(DriftedPlates, BecomeAPlanetWithLandAndSea) {
  Drifted planet = drifted(128, 4, quick());
  IsostasyParameters parameters;
  parameters.crust = "simulated";
  const auto stage = make_isostasy_stage(parameters);
  StageIo io(planet.state, stage->info());
  Context context;
  context.seed = 4;
  stage->run(io, context);
  const auto z = planet.state.read(field::elevation);
  EXPECT_NEAR(share_where(planet.state, [&](Index c) { return z[c] >= 0.0F; }), 0.29, 0.01);
  const auto made = planet.state.read(field::crust_elevation);
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_yy = 0, sum_xy = 0;
  const double n = planet.state.grid().size();
  for (Index c = 0; c < planet.state.grid().size(); ++c) {
    sum_x += made[c];
    sum_y += z[c];
    sum_xx += made[c] * made[c];
    sum_yy += z[c] * z[c];
    sum_xy += made[c] * z[c];
  }
  const double correlation =
      (sum_xy / n - sum_x / n * sum_y / n) /
      std::sqrt((sum_xx / n - sum_x / n * sum_x / n) * (sum_yy / n - sum_y / n * sum_y / n));
  EXPECT_GT(correlation, 0.9);
}

TEST(DriftedPlates, GoOnFromAnyFrameBitForBit) {
  State whole(std::make_shared<Grid>(Grid::sphere(32, 16)));
  const auto frames = frames_of(with_frames(), whole, nullptr);
  ASSERT_EQ(frames.size(), 6U);
  for (const std::size_t k : {1U, 3U}) {
    EXPECT_EQ(frames[k].checkpoint.time_myr, 20.0 * static_cast<double>(k));
    State rest(std::make_shared<Grid>(Grid::sphere(32, 16)));
    const auto later =
        frames_of(with_frames(), rest, std::make_shared<const Checkpoint>(frames[k].checkpoint));
    ASSERT_EQ(later.size(), 5U - k);
    EXPECT_TRUE(same_values(whole, rest)) << k;
    for (std::size_t m = 0; m < later.size(); ++m) {
      EXPECT_TRUE(later[m].checkpoint.arrays == frames[k + 1 + m].checkpoint.arrays);
      EXPECT_TRUE(same_values(later[m].fields, frames[k + 1 + m].fields));
    }
  }
}

TEST(DriftedPlates, GoOnFromAnyFrameWithForcesAndRivers) {
  PlatesParameters p = with_frames();
  p.sphere.by_forces = true;
  p.erosion = "rivers";
  p.overlap = "score";
  p.uplift_sources = "all";
  State whole(std::make_shared<Grid>(Grid::sphere(32, 16)));
  const auto frames = frames_of(p, whole, nullptr);
  State plain(std::make_shared<Grid>(Grid::sphere(32, 16)));
  (void)frames_of(with_frames(), plain, nullptr);
  EXPECT_FALSE(same_values(whole, plain));
  State rest(std::make_shared<Grid>(Grid::sphere(32, 16)));
  (void)frames_of(p, rest, std::make_shared<const Checkpoint>(frames[2].checkpoint));
  EXPECT_TRUE(same_values(whole, rest));
}

TEST(DriftedPlates, GoOnFromAnyFrameWhileRiftsOpenAndContinentsSlow) {
  PlatesParameters p = with_frames();
  p.sphere.rift_per_myr = 0.02;
  p.sphere.rift_onset_myr = 50.0;
  State without(std::make_shared<Grid>(Grid::sphere(32, 16)));
  (void)frames_of(p, without, nullptr);
  p.sphere.suture_drag = 300.0;
  State whole(std::make_shared<Grid>(Grid::sphere(32, 16)));
  const auto frames = frames_of(p, whole, nullptr);
  EXPECT_FALSE(same_values(whole, without));
  for (const std::size_t k : {1U, 2U, 3U, 4U}) {
    State rest(std::make_shared<Grid>(Grid::sphere(32, 16)));
    (void)frames_of(p, rest, std::make_shared<const Checkpoint>(frames[k].checkpoint));
    EXPECT_TRUE(same_values(whole, rest)) << k;
  }
}

TEST(DriftedPlates, AreTheSameWithAndWithoutFrames) {
  State with(std::make_shared<Grid>(Grid::sphere(32, 16)));
  (void)frames_of(with_frames(), with, nullptr);
  PlatesParameters parameters = with_frames();
  parameters.frames_myr = 0.0;
  State without(std::make_shared<Grid>(Grid::sphere(32, 16)));
  EXPECT_TRUE(frames_of(parameters, without, nullptr).empty());
  EXPECT_TRUE(same_values(with, without));
}

TEST(DriftedPlates, ShowEveryMultipleOfTheIntervalThatStepsDoNotMeet) {
  PlatesParameters parameters = with_frames();  // 100 Myr in steps of 2
  const auto times_of = [&](double frames_myr, std::shared_ptr<const Checkpoint> start) {
    parameters.frames_myr = frames_myr;
    State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
    std::vector<double> times_myr;
    for (const Frame& frame : frames_of(parameters, state, std::move(start))) {
      times_myr.push_back(frame.checkpoint.time_myr);
    }
    return times_myr;
  };
  EXPECT_EQ(times_of(25.0, nullptr), (std::vector<double>{0.0, 26.0, 50.0, 76.0, 100.0}));
  EXPECT_EQ(times_of(33.3, nullptr), (std::vector<double>{0.0, 34.0, 68.0, 100.0}));
  EXPECT_EQ(times_of(0.5, nullptr).size(), 51U);  // no more than steps
  State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
  parameters.frames_myr = 20.0;
  const auto frames = frames_of(parameters, state, nullptr);
  EXPECT_EQ(times_of(25.0, std::make_shared<const Checkpoint>(frames[2].checkpoint)),
            (std::vector<double>{50.0, 76.0, 100.0}));
}

TEST(DriftedPlates, RefuseFramesThatDoNotFit) {
  State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
  const auto frames = frames_of(with_frames(), state, nullptr);
  PlatesParameters other = with_frames();
  other.samples = 7000;
  State again(std::make_shared<Grid>(Grid::sphere(32, 16)));
  EXPECT_THROW(
      (void)frames_of(other, again, std::make_shared<const Checkpoint>(frames[2].checkpoint)),
      InputError);
  Checkpoint damaged = frames[2].checkpoint;
  damaged.arrays.erase("plate_alive");
  EXPECT_THROW(
      (void)frames_of(with_frames(), again, std::make_shared<const Checkpoint>(std::move(damaged))),
      InputError);
}

TEST(DriftedPlates, RefuseFramesFromWhichNoStepWouldEnd) {
  State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
  const Frame frame = frames_of(with_frames(), state, nullptr)[2];
  const auto refused = [&](const std::string& name, std::size_t at, double value) {
    auto damaged = std::make_shared<Checkpoint>(frame.checkpoint);
    std::visit(
        [&](auto& array) { array.at(at) = static_cast<std::decay_t<decltype(array[0])>>(value); },
        damaged->arrays.at(name));
    State again(std::make_shared<Grid>(Grid::sphere(32, 16)));
    EXPECT_THROW((void)frames_of(with_frames(), again, damaged), InputError)
        << name << " " << value;
  };
  refused("plate_carrier", 1, 1.0);  // a plate that carries itself
  refused("clock", 0, std::numeric_limits<double>::quiet_NaN());
  refused("clock", 0, -1e300);
  refused("clock", 2, 1e9);
  refused("plate_numbers", 8, std::numeric_limits<double>::infinity());
}

TEST(DriftedPlates, FollowTheTimeline) {
  PlatesParameters parameters = with_frames();
  parameters.sphere.rift_per_myr = 0.0;
  parameters.sphere.slab_pull = 0.0;
  parameters.no_net_rotation = false;
  parameters.time_myr = 30.0;
  parameters.frames_myr = 10.0;
  const std::vector<Event> events{
      {.name = "",
       .what = PlateMotion{.time_myr = 10.0,
                           .latitude_deg = 20.0,
                           .longitude_deg = 50.0,
                           .pole_latitude_deg = -90.0,
                           .speed_mm_yr = 25.0}},
      {.name = "",
       .what =
           CrustChange{
               .time_myr = 10.0, .latitude_deg = 20.0, .longitude_deg = 50.0, .radius_km = 1200.0}},
      {.name = "",
       .what = PlateRift{
           .time_myr = 20.0, .latitude_deg = -60.0, .longitude_deg = -100.0, .fragments = 3}}};
  State state(std::make_shared<Grid>(Grid::sphere(128, 64)));
  Context told;
  const auto frames = frames_of(parameters, state, nullptr, events, &told);
  ASSERT_GE(told.event_records.size(), 3U);  // what happens of itself comes behind
  EXPECT_EQ(told.event_records[2].kind, PlateRift::kKind);
  // 28 samples of 85 000 km2 within 1200 km, less what was continental already.
  const double changed_km2 = figure_of(told.event_records[1], "area_km2", -1.0);
  EXPECT_GT(changed_km2, 0.0);
  EXPECT_LT(changed_km2, 5.0e6);
  // Ten million years later the place has gone 250 km west, and the plate goes on so.
  const Grid& grid = state.grid();
  const Index cell = grid.cell(static_cast<int>((180.0 + 47.5) / 360.0 * 128),
                               static_cast<int>((90.0 + 20.0) / 180.0 * 64));
  EXPECT_NEAR(frames[2].fields.read(field::plate_velocity_east)[cell],
              -25.0 * std::cos(20.0 * 3.14159 / 180.0), 1.0);
  EXPECT_NEAR(frames[2].fields.read(field::plate_velocity_north)[cell], 0.0, 1e-3);
  EXPECT_GT(frames[2].fields.read(field::continental_fraction)[cell], 0.9F);
  const auto plates = [](const Frame& frame) {
    const auto ids = frame.fields.read(field::plate_id);
    return *std::max_element(ids.begin(), ids.end());
  };
  EXPECT_GT(plates(frames[3]), plates(frames[2]));
}

TEST(DriftedPlates, TellWhatEachStepDid) {
  PlatesParameters parameters = with_frames();
  State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
  Context told;
  (void)frames_of(parameters, state, nullptr, {}, &told);
  const StepTable& steps = told.steps;
  ASSERT_EQ(steps.rows.size(), 50U);  // 100 Myr
  const auto column = [&](const std::string& name) {
    const auto at = std::find(steps.columns.begin(), steps.columns.end(), name);
    EXPECT_NE(at, steps.columns.end()) << name;
    return static_cast<std::size_t>(at - steps.columns.begin());
  };
  const auto first_area = column("plate_0_km2");
  const auto plates = column("plates"), volume = column("continental_km3");
  const double sphere_km2 = 4.0 * std::numbers::pi * 6371.0 * 6371.0;
  double created = 0.0, before = 0.0;
  for (std::size_t k = 0; k < steps.rows.size(); ++k) {
    const auto& row = steps.rows[k];
    ASSERT_LE(row.size(), steps.columns.size());
    EXPECT_EQ(row[column("time_myr")], 2.0 * static_cast<double>(k + 1));
    double area = 0.0;
    int alive = 0;
    for (std::size_t p = first_area; p < row.size(); ++p) {
      if (!std::isfinite(row[p])) continue;
      area += row[p];
      ++alive;
    }
    EXPECT_EQ(alive, row[plates]);
    // What collisions have swallowed since the last resampling is no one's.
    EXPECT_LE(area, (1.0 + 1e-9) * sphere_km2);
    EXPECT_GT(area, 0.9 * sphere_km2);
    if (row[column("resampled")] == 1.0) {
      EXPECT_NEAR(area, sphere_km2, 1e-9 * sphere_km2);
    }
    if (k > 0) {
      EXPECT_NEAR(row[volume] - before,
                  row[column("raised_km3")] - row[column("eroded_km3")] +
                      row[column("emerged_km3")] - row[column("lost_km3")] +
                      row[column("resampling_km3")],
                  1e-7 * row[volume]);
    }
    before = row[volume];
    created += row[column("created_km2")];
  }
  EXPECT_GT(created, 0.0);
  EXPECT_GT(steps.rows.back()[column("accreted_km3")], 0.0);
  EXPECT_GT(steps.rows.back()[column("erupted_km3")], 0.0);
}

TEST(DriftedPlates, FollowLinesRegionsAndPlumesOfTheTimeline) {
  PlatesParameters parameters = with_frames();
  parameters.sphere.rift_per_myr = 0.0;
  parameters.no_net_rotation = false;
  parameters.cratons.share = 0.0;
  parameters.plumes = 2.0;
  parameters.time_myr = 20.0;
  parameters.frames_myr = 10.0;
  const std::vector<Centre> region{{-20, 170}, {-20, -150}, {20, -150}, {20, 170}};
  const std::vector<Event> events{
      {.name = "", .what = CrustChange{.time_myr = 0.0, .path = region}},
      {.name = "",
       .what =
           PlateRift{
               .time_myr = 8.0, .path = {{-15, -175}, {0, -165}, {15, -165}}, .fragments = 4}},
      {.name = "",
       .what = PlumeChange{.time_myr = 4.0, .latitude_deg = 40.0, .longitude_deg = 10.0}},
      {.name = "",
       .what =
           PlumeChange{
               .time_myr = 6.0, .latitude_deg = 41.0, .longitude_deg = 10.0, .active = false}},
      {.name = "",
       .what = PlumeChange{
           .time_myr = 14.0, .latitude_deg = -50.0, .longitude_deg = 80.0, .growth_mm_yr = 3.0}}};
  State state(std::make_shared<Grid>(Grid::sphere(64, 32)));
  Context told;
  const auto frames = frames_of(parameters, state, nullptr, events, &told);
  ASSERT_GE(told.event_records.size(), 5U);
  // 40 degrees wide, less what was continental.
  const double box_km2 =
      6371.0 * 6371.0 * 40.0 / 180.0 * std::numbers::pi * 2.0 * std::sin(std::numbers::pi / 9.0);
  EXPECT_NEAR(figure_of(told.event_records[0], "area_km2", 0.0), box_km2, 0.05 * box_km2);
  EXPECT_EQ(told.steps.rows[4][1], told.steps.rows[3][1] + 3.0);  // plates after 10 and 8 Myr
  // Two of the seed, one that came and went, one that came: heat and frames know it.
  EXPECT_EQ(frames[1].checkpoint.get<double>("plumes").size(), 8U);
  ASSERT_EQ(frames[2].checkpoint.get<double>("plumes").size(), 12U);
  EXPECT_EQ(frames[2].checkpoint.get<double>("plumes")[11], 3.0);
  const Grid& grid = state.grid();
  const Index above = grid.cell(46, 7);  // 48 S, 81 E
  EXPECT_GT(frames[2].fields.read(field::heat_anomaly)[above],
            frames[1].fields.read(field::heat_anomaly)[above] + 0.2F);
  // From the frame on, all the same.
  State rest(std::make_shared<Grid>(Grid::sphere(64, 32)));
  (void)frames_of(parameters, rest, std::make_shared<const Checkpoint>(frames[1].checkpoint),
                  events);
  EXPECT_TRUE(same_values(state, rest));
}

TEST(DriftedPlates, AreMissedWhereSimulatedCrustIsAskedFor) {
  PlatesParameters grown;
  State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
  Context context;
  const auto plates = make_plates_stage(grown);
  StageIo first(state, plates->info());
  plates->run(first, context);
  IsostasyParameters parameters;
  parameters.crust = "simulated";
  const auto stage = make_isostasy_stage(parameters);
  EXPECT_THROW(stage->check(state.grid(), [&](const FieldSpec& spec) { return state.has(spec); }),
               ConfigurationError);
}

TEST(DriftingPlates, FoldsLieAcrossTheWayTheirPlatesMeet) {
  double alike = 0.0;
  int places = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const State state = drifted(240, seed, quick()).state;
    const Grid& grid = state.grid();
    const auto plate = state.read(field::plate_id);
    const auto east = state.read(field::plate_velocity_east);
    const auto north = state.read(field::plate_velocity_north);
    const auto fold_east = state.read(field::fold_direction_east);
    const auto fold_north = state.read(field::fold_direction_north);
    const auto type = state.read(field::orogeny_type);
    const auto age = state.read(field::orogeny_age);
    for (Index c = 0; c < grid.size(); ++c) {
      const Index next = grid.neighbour(c, kEast);
      const double fold = std::hypot(fold_east[c], fold_north[c]);
      if (type[c] != static_cast<std::int8_t>(OrogenyType::andean) || !(age[c] < 5.0F)) continue;
      if (plate[next] == plate[c] || fold < 0.3) continue;
      const double e = east[next] - east[c], n = north[next] - north[c], speed = std::hypot(e, n);
      if (speed < 20.0) continue;
      alike += std::pow((fold_east[c] * e + fold_north[c] * n) / (fold * speed), 2.0);
      ++places;
    }
  }
  ASSERT_GT(places, 50);
  EXPECT_LT(alike / places, 0.3);  // of 0.5 for any directions
}

}  // namespace
}  // namespace geo
