// Planets whose drift begins with plates, a relief or ages that are given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "drifted.hpp"
#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"

namespace geo {
namespace {

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

TEST(GivenPlates, BeginWithPlatesThatAreGiven) {
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

TEST(GivenPlates, SayWhatGivenPlatesLeaveOpen) {
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

TEST(GivenPlates, MoveAsTheirPolesSay) {
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

TEST(GivenPlates, GoAsFarAsTheirPolesSay) {
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

TEST(GivenPlates, ThatAreGivenHaveNoNetRotationUnlessItIsKept) {
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

TEST(GivenPlates, TakeAMotionOfTheTimelineAsItIs) {
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
GivenElevation made_relief() {
  GivenElevation given{Grid::sphere(720, 360), {}, {}};
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

TEST(GivenPlates, BeginWithARealReliefAsItIs) {
  PlatesParameters p = quick();
  p.samples = 40000;
  p.time_myr = 0.0;
  p.initial_elevation = "given";
  p.oldest_floor_myr = 180.0;
  p.cratons.share = 0.0655;  // within 30 degrees of the middle, less the rim
  Context context;
  context.initial_elevation = std::make_shared<const GivenElevation>(made_relief());
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

TEST(GivenPlates, BelieveAnAgeGridWhereItHasOne) {
  PlatesParameters p = quick();
  p.time_myr = 0.0;
  p.initial_elevation = "given";
  p.cratons.share = 0.0655;
  Context context;
  GivenElevation given = made_relief();
  given.age_myr.assign(given.elevation_m.size(), std::numeric_limits<float>::quiet_NaN());
  for (Index c = 0; c < given.grid.size(); ++c) {
    if (given.grid.longitude_deg(given.grid.column(c)) > 60.0) given.age_myr[c] = 33.0F;
  }
  context.initial_elevation = std::make_shared<const GivenElevation>(std::move(given));
  const State& state = begun(p, context).state;
  const auto age = state.read(field::crust_age);
  const Grid& grid = state.grid();
  EXPECT_NEAR(age[grid.cell(90, 24)], 33.0, 1e-3);  // 159 E
  EXPECT_NEAR(age[grid.cell(20, 24)], 38.0, 4.0);   // 103 W: by depth
}

TEST(GivenPlates, AskForTheReliefThatTheyAreToBeginWith) {
  PlatesParameters p = quick();
  p.initial_elevation = "given";
  EXPECT_THROW((void)begun(p, {}), InputError);
}

}  // namespace
}  // namespace geo
