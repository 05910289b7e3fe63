// Planets whose plates have drifted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/kernels/ocean_depth.hpp"
#include "geo/stages/isostasy.hpp"
#include "geo/stages/plates.hpp"

namespace geo {
namespace {

struct Drifted {
  State state;
  Budget budget;
};

PlatesParameters quick() {
  PlatesParameters p;
  p.model = "sphere";
  p.growth.count = 30;
  p.samples = 12000;
  p.time_myr = 120.0;
  p.ocean_floor = "age";
  return p;
}

Drifted drifted(int nx, std::uint64_t seed, const PlatesParameters& parameters) {
  Drifted out{State(std::make_shared<Grid>(Grid::sphere(nx, nx / 2))), {}};
  const auto stage = make_plates_stage(parameters);
  StageIo io(out.state, stage->info());
  Context context;
  context.seed = seed;
  stage->run(io, context);
  out.budget = context.budget;
  return out;
}

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

/// Runs the stage with frames every 20 Myr, from the beginning or from a checkpoint.
std::vector<Frame> frames_of(const PlatesParameters& parameters, State& state,
                             std::shared_ptr<const Checkpoint> from, std::vector<Event> events = {},
                             Context* told = nullptr) {
  std::vector<Frame> frames;
  const auto stage = make_plates_stage(parameters);
  StageIo io(state, stage->info());
  Context context;
  context.seed = 6;
  context.events = std::move(events);
  context.checkpoint = std::move(from);
  context.on_frame = [&](Frame frame) { frames.push_back(std::move(frame)); };
  stage->run(io, context);
  if (told != nullptr) *told = context;
  return frames;
}

PlatesParameters with_frames() {
  PlatesParameters p = quick();
  p.samples = 6000;
  p.time_myr = 100.0;
  p.frames_myr = 20.0;
  p.sphere.rift_per_myr = 0.02;
  return p;
}

bool same_values(const State& a, const State& b) {
  bool same = a.present() == b.present();
  for (const FieldSpec* spec : a.present()) same = same && *a.values(*spec) == *b.values(*spec);
  return same;
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

TEST(DriftedPlates, AreTheSameWithAndWithoutFrames) {
  State with(std::make_shared<Grid>(Grid::sphere(32, 16)));
  (void)frames_of(with_frames(), with, nullptr);
  PlatesParameters parameters = with_frames();
  parameters.frames_myr = 0.0;
  State without(std::make_shared<Grid>(Grid::sphere(32, 16)));
  EXPECT_TRUE(frames_of(parameters, without, nullptr).empty());
  EXPECT_TRUE(same_values(with, without));
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
  parameters.sphere.plume_mm_yr = 1.0;
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

/// Two caps and the belt between them, which leaves a gap of 10 degrees below the northern cap and
/// covers a part of the southern one.
std::vector<PlateOutline> three_plates() {
  return {{"north", {{{50, -180}, {50, -60}, {50, 60}, {50, 180}}}, {90, 0}, 0.25},
          {"south", {{{-30, -180}, {-30, -60}, {-30, 60}, {-30, 180}}}, {0, 90}, 0.5},
          {"belt", {{{-40, -180}, {40, -180}, {40, 180}, {-40, 180}, {-40, -180}}}, {-90, 0}, 0.1},
          {"rock", {{{0, 0}, {0, 0.01}, {0.01, 0.01}}}, {90, 0}, 0.1}};
}

Drifted begun(const PlatesParameters& parameters, Context context) {
  Drifted out{State(std::make_shared<Grid>(Grid::sphere(96, 48))), {}};
  const auto stage = make_plates_stage(parameters);
  StageIo io(out.state, stage->info());
  context.seed = 6;
  stage->run(io, context);
  out.budget = context.budget;
  return out;
}

TEST(DriftedPlates, BeginWithPlatesThatAreGiven) {
  PlatesParameters p = quick();
  p.time_myr = 0.0;
  p.no_net_rotation = false;
  Context context;
  context.plates = three_plates();
  const State& state = begun(p, context).state;
  const Grid& grid = state.grid();
  const auto plate = state.read(field::plate_id);
  const auto east = state.read(field::plate_velocity_east);
  const auto north = state.read(field::plate_velocity_north);
  for (Index c = 0; c < grid.size(); ++c) {
    const double latitude = grid.latitude_deg(grid.row(c));
    // The gap goes to the nearer side; of overlaps the later plate has it. Outlines bend by 3
    // degrees on samples as coarse as these.
    if (std::abs(latitude - 45.0) < 6.0 || std::abs(latitude + 40.0) < 6.0) continue;
    const double equator_mm_yr = 6371.0 * std::numbers::pi / 180.0;
    const double cosine = std::cos(latitude * std::numbers::pi / 180.0);
    const double longitude = grid.longitude_deg(grid.column(c)) * std::numbers::pi / 180.0;
    if (latitude > 45.0) {
      ASSERT_EQ(plate[c], plate[grid.cell(0, 47)]) << latitude;
      ASSERT_NEAR(east[c], 0.25 * equator_mm_yr * cosine, 0.05);
    } else if (latitude > -40.0) {
      ASSERT_EQ(plate[c], plate[grid.cell(0, 24)]) << latitude;
      ASSERT_NEAR(east[c], -0.1 * equator_mm_yr * cosine, 0.05);
    } else {
      ASSERT_EQ(plate[c], plate[grid.cell(0, 0)]) << latitude;
      // About 0 N 90 E: v = w x r, northwards where longitudes are below 90 degrees.
      ASSERT_NEAR(north[c], -0.5 * equator_mm_yr * std::cos(longitude), 0.05);
    }
  }
  EXPECT_NE(plate[grid.cell(0, 0)], plate[grid.cell(0, 24)]);
  EXPECT_NE(plate[grid.cell(0, 47)], plate[grid.cell(0, 24)]);
}

TEST(DriftedPlates, SayWhatGivenPlatesLeaveOpen) {
  PlatesParameters p = quick();
  p.time_myr = 0.0;
  State state(std::make_shared<Grid>(Grid::sphere(32, 16)));
  const auto stage = make_plates_stage(p);
  StageIo io(state, stage->info());
  Context context;
  context.plates = three_plates();
  stage->run(io, context);
  // From 40 to 50 N and from 30 to 40 S, by Archimedes.
  const auto said = [&](const char* what) {
    return std::count_if(context.warnings.begin(), context.warnings.end(),
                         [&](const auto& one) { return one.find(what) != std::string::npos; });
  };
  ASSERT_EQ(context.warnings.size(), 3U);
  EXPECT_EQ(said("6.2 % of the planet lies within no outline"), 1);
  EXPECT_EQ(said("7.1 % of the planet lies within several outlines"), 1);
  EXPECT_EQ(said("rock is too small"), 1);
  EXPECT_EQ(context.budget.at("plates"), 3);
}

/// v = w x r of an Euler pole, mm/yr east and north, from spherical trigonometry.
std::pair<double, double> pole_velocity(const Centre& pole, double rate_deg_myr, const Centre& at) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double speed = 6371.0 * rate_deg_myr * kRadians;
  const double phi = at.latitude_deg * kRadians, pole_phi = pole.latitude_deg * kRadians;
  const double apart = (at.longitude_deg - pole.longitude_deg) * kRadians;
  return {speed * (std::sin(pole_phi) * std::cos(phi) -
                   std::cos(pole_phi) * std::sin(phi) * std::cos(apart)),
          speed * std::cos(pole_phi) * std::sin(apart)};
}

/// A round outline about a place.
std::vector<Centre> circle_about(const Centre& middle, double radius_deg) {
  std::vector<Centre> ring;
  for (double turn = 0.0; turn < 360.0; turn += 10.0) {
    const double angle = turn * std::numbers::pi / 180.0;
    ring.push_back({middle.latitude_deg + radius_deg * std::sin(angle),
                    middle.longitude_deg + radius_deg * std::cos(angle)});
  }
  return ring;
}

/// Three plates of NNR-MORVEL56 (Argus et al. 2011) on one that is at rest.
std::vector<PlateOutline> known_plates() {
  return {{"rest", {{{-90, -180}, {90, -180}, {90, 180}, {-90, 180}}}, {90, 0}, 0.0},
          {"Pacific", {circle_about({19.5, -155.5}, 25.0)}, {-63.58, 114.70}, 0.651},
          {"Australia", {circle_about({-25.0, 135.0}, 25.0)}, {33.86, 37.94}, 0.632},
          {"India", {circle_about({20.0, 77.0}, 15.0)}, {50.37, -3.29}, 0.544}};
}

TEST(DriftedPlates, MoveAsTheirPolesSay) {
  PlatesParameters p = quick();
  p.sphere.rift_per_myr = 0.0;
  p.no_net_rotation = false;
  Context context;
  context.plates = known_plates();
  for (const double time_myr : {0.0, 6.0}) {
    p.time_myr = time_myr;
    State state(std::make_shared<Grid>(Grid::sphere(360, 180)));
    const auto stage = make_plates_stage(p);
    StageIo io(state, stage->info());
    context.seed = 6;
    stage->run(io, context);
    const auto east = state.read(field::plate_velocity_east);
    const auto north = state.read(field::plate_velocity_north);
    const Grid& grid = state.grid();
    // Hawaii, worked out by hand.
    const Index hawaii = grid.cell(24, 109);
    ASSERT_EQ(grid.latitude_deg(109), 19.5);
    ASSERT_EQ(grid.longitude_deg(24), -155.5);
    EXPECT_NEAR(east[hawaii], -61.147, 0.1);
    EXPECT_NEAR(north[hawaii], 32.209, 0.1);
    // Four cells about 25 S 135 E and 20 N 77 E.
    const auto mean = [&](std::span<const float> values, int i, int j) {
      return 0.25 * (values[grid.cell(i, j)] + values[grid.cell(i - 1, j)] +
                     values[grid.cell(i, j - 1)] + values[grid.cell(i - 1, j - 1)]);
    };
    EXPECT_NEAR(mean(east, 315, 65), 32.455, 0.1);
    EXPECT_NEAR(mean(north, 315, 65), 57.914, 0.1);
    EXPECT_NEAR(mean(east, 257, 110), 41.553, 0.1);
    EXPECT_NEAR(mean(north, 257, 110), 38.029, 0.1);
  }
}

TEST(DriftedPlates, GoAsFarAsTheirPolesSay) {
  PlatesParameters p = quick();
  p.sphere.rift_per_myr = 0.0;
  p.no_net_rotation = false;
  p.samples = 40000;
  p.cratons.share = 0.0;
  p.sphere.law.uplift_mm_yr = 0.0;  // no arcs
  p.time_myr = 24.0;
  p.frames_myr = 12.0;
  const std::vector<Event> events{
      {.name = "",
       .what = CrustChange{
           .time_myr = 0.0, .latitude_deg = -25.0, .longitude_deg = 135.0, .radius_km = 900.0}}};
  State state(std::make_shared<Grid>(Grid::sphere(360, 180)));
  Context context;
  context.plates = known_plates();
  context.events = events;
  context.seed = 6;
  std::vector<Frame> frames;
  context.on_frame = [&](Frame frame) { frames.push_back(std::move(frame)); };
  const auto stage = make_plates_stage(p);
  StageIo io(state, stage->info());
  stage->run(io, context);
  const auto fraction = state.read(field::continental_fraction);
  Vector3 sum{};
  for (Index c = 0; c < state.grid().size(); ++c) {
    const Vector3 at = unit_vector_of({state.grid().latitude_deg(state.grid().row(c)),
                                       state.grid().longitude_deg(state.grid().column(c))});
    sum = add(sum, at, fraction[c] * state.grid().area_m2(state.grid().row(c)));
  }
  const Vector3 pole = unit_vector_of({33.86, 37.94});
  const Vector3 wanted = rotated(unit_vector_of({-25.0, 135.0}),
                                 scaled(pole, 24.0 * 0.632 * std::numbers::pi / 180.0));
  // A third of a sample's width; it went 1590 km.
  EXPECT_LT(6371.0 * angle_between(normalised(sum), wanted), 70.0);
  // From a frame on, all the same: what is held stays so.
  State rest(std::make_shared<Grid>(Grid::sphere(360, 180)));
  (void)frames_of(p, rest, std::make_shared<const Checkpoint>(frames[1].checkpoint), events);
  EXPECT_TRUE(same_values(state, rest));
}

TEST(DriftedPlates, ThatAreGivenHaveNoNetRotationUnlessItIsKept) {
  PlatesParameters p = quick();
  p.time_myr = 0.0;
  Context context;
  context.plates = known_plates();
  const auto net_mm_yr = [&] {
    const State state = begun(p, context).state;
    const Grid& grid = state.grid();
    const auto east = state.read(field::plate_velocity_east);
    const auto north = state.read(field::plate_velocity_north);
    Vector3 sum{};
    for (Index c = 0; c < grid.size(); ++c) {
      const Vector3 r =
          unit_vector_of({grid.latitude_deg(grid.row(c)), grid.longitude_deg(grid.column(c))});
      const Vector3 eastward = normalised(cross({0.0, 0.0, 1.0}, r));
      const Vector3 v = add(scaled(eastward, east[c]), cross(r, eastward), north[c]);
      sum = add(sum, cross(r, v), 1.5 * grid.area_m2(grid.row(c)) / grid.total_area_m2());
    }
    return length(sum);
  };
  // Outlines on cells and on samples differ by a cell's width.
  EXPECT_LT(net_mm_yr(), 0.3);
  p.no_net_rotation = false;
  EXPECT_GT(net_mm_yr(), 2.0);
}

TEST(DriftedPlates, TakeAMotionOfTheTimelineAsItIs) {
  PlatesParameters p = with_frames();
  p.sphere.rift_per_myr = 0.0;
  p.cratons.share = 0.0;
  p.time_myr = 8.0;
  p.frames_myr = 4.0;
  const Centre at{20.0, 50.0}, pole{-30.0, 120.0};
  for (const double time_myr : {0.0, 4.0}) {
    const std::vector<Event> events{{.name = "",
                                     .what = PlateMotion{.time_myr = time_myr,
                                                         .latitude_deg = at.latitude_deg,
                                                         .longitude_deg = at.longitude_deg,
                                                         .pole_latitude_deg = pole.latitude_deg,
                                                         .pole_longitude_deg = pole.longitude_deg,
                                                         .speed_mm_yr = 70.0}}};
    State state(std::make_shared<Grid>(Grid::sphere(128, 64)));
    (void)frames_of(p, state, nullptr, events);
    const Grid& grid = state.grid();
    const Index cell = grid.cell(81, 39);
    const auto [east, north] = pole_velocity(pole, 70.0 / 6371.0 * 180.0 / std::numbers::pi,
                                             {grid.latitude_deg(39), grid.longitude_deg(81)});
    // In the frame without net rotation, slab pull or not.
    EXPECT_NEAR(state.read(field::plate_velocity_east)[cell], east, 0.1) << time_myr;
    EXPECT_NEAR(state.read(field::plate_velocity_north)[cell], north, 0.1) << time_myr;
  }
}

/// A continent of 800 m round 0 N 0 E with a shelf, a slope, an apron that fills its foot, and
/// floor that deepens with age to the west.
GivenRelief made_relief() {
  GivenRelief given{Grid::sphere(720, 360), {}, {}};
  for (int j = 0; j < 360; ++j) {
    for (int i = 0; i < 720; ++i) {
      const double longitude = given.grid.longitude_deg(i), latitude = given.grid.latitude_deg(j);
      const double from_middle = std::hypot(longitude, latitude);
      const double age = 0.5 * (longitude + 180.0);
      const double sediment = 250.0 * (1.0 - std::exp(-age / 8.0)) + 4.5 * age;
      double z = -ocean_depth_m(age) + 0.5 * sediment;
      if (from_middle < 31.0) z = -3200.0;
      if (from_middle < 30.0) z = 800.0 * (1.0 - std::pow(from_middle / 29.0, 8));
      given.elevation_m.push_back(static_cast<float>(z));
    }
  }
  return given;
}

TEST(DriftedPlates, BeginWithARealReliefAsItIs) {
  PlatesParameters p = quick();
  p.samples = 40000;
  p.time_myr = 0.0;
  p.first_relief = "given";
  p.oldest_floor_myr = 180.0;
  p.cratons.share = 0.0655;  // within 30 degrees of the middle, less the rim
  Context context;
  context.first_relief = std::make_shared<const GivenRelief>(made_relief());
  const State& state = begun(p, context).state;
  const Grid& grid = state.grid();
  const auto z = state.read(field::crust_elevation);
  const auto age = state.read(field::crust_age);
  const auto thickness = state.read(field::crust_thickness);
  const auto fraction = state.read(field::continental_fraction);
  for (Index c = 0; c < grid.size(); ++c) {
    const double longitude = grid.longitude_deg(grid.column(c));
    const double latitude = grid.latitude_deg(grid.row(c));
    const double from_middle = std::hypot(longitude, latitude);
    if (from_middle < 20.0) {
      ASSERT_NEAR(z[c], 800.0, 50.0);
      ASSERT_EQ(fraction[c], 1.0F);
      ASSERT_NEAR(thickness[c], 36000.0, 1000.0);  // under land of 800 m
    } else if (from_middle > 30.0 && from_middle < 31.0 && longitude > 0.0) {
      // The apron's own depth would make it 3 Myr old; the nearest plain floor is 90 Myr and more.
      ASSERT_GT(age[c], 80.0);
    } else if (from_middle > 40.0 && std::abs(latitude) < 70.0 && std::abs(longitude) < 170.0) {
      ASSERT_EQ(fraction[c], 0.0F);
      const double made = 0.5 * (longitude + 180.0);
      if (made < 90.0) {
        ASSERT_NEAR(age[c], made, 4.0) << longitude << ' ' << latitude;
      } else {
        ASSERT_GT(age[c], 85.0);
        ASSERT_LE(age[c], 120.0);
      }
    }
  }
}

TEST(DriftedPlates, BelieveAnAgeGridWhereItHasOne) {
  PlatesParameters p = quick();
  p.time_myr = 0.0;
  p.first_relief = "given";
  p.cratons.share = 0.0655;
  Context context;
  GivenRelief given = made_relief();
  given.age_myr.assign(given.elevation_m.size(), std::numeric_limits<float>::quiet_NaN());
  for (Index c = 0; c < given.grid.size(); ++c) {
    if (given.grid.longitude_deg(given.grid.column(c)) > 60.0) given.age_myr[c] = 33.0F;
  }
  context.first_relief = std::make_shared<const GivenRelief>(std::move(given));
  const State& state = begun(p, context).state;
  const auto age = state.read(field::crust_age);
  const Grid& grid = state.grid();
  EXPECT_NEAR(age[grid.cell(90, 24)], 33.0, 1e-3);  // 159 E
  EXPECT_NEAR(age[grid.cell(20, 24)], 38.0, 4.0);   // 103 W: by depth
}

TEST(DriftedPlates, AskForTheReliefThatTheyAreToBeginWith) {
  PlatesParameters p = quick();
  p.first_relief = "given";
  EXPECT_THROW((void)begun(p, {}), InputError);
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
  StageIo io(state, stage->info());
  EXPECT_THROW(stage->run(io, context), InputError);
}

}  // namespace
}  // namespace geo
