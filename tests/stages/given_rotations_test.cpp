// Drifts whose plates a reconstruction drives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "drifted.hpp"
#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "geo/kernels/plates/plate_reconstruction.hpp"

namespace geo {
namespace {

using testing::HasSubstr;

constexpr double kRadians = std::numbers::pi / 180.0;

Quaternion turned(const Centre& pole, double angle_deg) {
  return Quaternion::about(scaled(unit_vector_of(pole), angle_deg * kRadians));
}

std::vector<Centre> cap(double edge_latitude_deg) {
  std::vector<Centre> ring;
  for (double longitude = -180.0; longitude <= 180.0; longitude += 30.0) {
    ring.push_back({edge_latitude_deg, longitude});
  }
  return ring;
}

/// Today the northern hemisphere is plate 11, the southern one plate 12, which turned faster up to
/// 30 Ma; plate 11 was fixed to it before 20 Ma. Plate 13 is the land of 11 north of 50 degrees. It
/// goes its own way since 37 Ma.
Context two_hemispheres() {
  const Centre pole{20.0, 40.0};
  const Quaternion north = turned({0.0, 90.0}, 15.0);
  const Quaternion at_20 = turned(pole, 10.0).after(turned({80.0, 0.0}, 4.0));
  PlateReconstruction given{
      "test.rot",
      RotationModel(
          {{12, 0, {{0.0, {}}, {30.0, turned(pole, 15.0)}, {50.0, turned(pole, 45.0)}}},
           {11, 0, {{0.0, {}}, {20.0, at_20}}},
           {11, 12, {{20.0, turned({80.0, 0.0}, 4.0)}, {50.0, north}}},
           {13,
            11,
            {{0.0, {}}, {37.0, turned({50.0, 60.0}, 8.0)}, {50.0, turned({50.0, 60.0}, 8.0)}}}}),
      50.0,
      0.0,
      {12, 11},
      {{13, 37.0, {"cap", {cap(50.0)}, {}, 0.0}}}};
  Context context;
  context.seed = 6;
  context.plates = {{"south", {cap(0.0)}, {}, 0.0}, {"north", {cap(0.0)}, {}, 0.0}};
  // The same line encloses both sides: a ring down to the pole tells the southern one.
  context.plates[0].rings[0].insert(context.plates[0].rings[0].begin(), {-90.0, -180.0});
  context.plates[0].rings[0].push_back({-90.0, 180.0});
  context.plates[1].rings[0].insert(context.plates[1].rings[0].begin(), {90.0, -180.0});
  context.plates[1].rings[0].push_back({90.0, 180.0});
  context.reconstruction = std::make_shared<const PlateReconstruction>(std::move(given));
  return context;
}

PlatesParameters driven() {
  PlatesParameters p = quick();
  p.samples = 6000;
  p.time_myr = 40.0;
  p.sphere.rift_per_myr = 0.1;
  return p;
}

State drift(const PlatesParameters& parameters, Context& context) {
  State state(std::make_shared<Grid>(Grid::sphere(64, 32)));
  const auto stage = make_plates_stage(parameters);
  StageIo io(state, stage->info());
  stage->run(io, context);
  return state;
}

const TextTable& table_of(const Context& context, const std::string& name) {
  for (const TextTable& table : context.tables) {
    if (table.name == name) return table;
  }
  throw Bug("no table " + name);
}

/// Rotation of a row of the table of rotations, rad/Myr.
Vector3 rotation_of(const std::vector<std::string>& row) {
  return euler_rotation(std::stod(row[3]), std::stod(row[4]), std::stod(row[5]));
}

constexpr double kDigits_rad_myr = 1e-12;

TEST(GivenRotations, PlatesBeginWhereTheyWereAndTurnByTheStageRotations) {
  Context context = two_hemispheres();
  const State state = drift(driven(), context);
  const auto& given = *context.reconstruction;
  int rows = 0;
  for (const auto& row : table_of(context, "rotations").rows) {
    const int plate = std::stoi(row[2]);
    if (plate > 1) continue;
    const double from_ma = 50.0 - std::stod(row[0]), to_ma = 50.0 - std::stod(row[1]);
    const auto wanted = given.rotations.stage_rad_myr(given.first[plate], from_ma, to_ma);
    EXPECT_LT(length(add(rotation_of(row), *wanted, -1.0)), kDigits_rad_myr)
        << "plate " << plate << " at " << from_ma << " Ma";
    ++rows;
  }
  EXPECT_EQ(rows, 40);
}

TEST(GivenRotations, OutlinesAreCarriedToTheBeginning) {
  Context context = two_hemispheres();
  PlatesParameters p = driven();
  p.time_myr = 0.0;
  const State state = drift(p, context);
  const Grid& grid = state.grid();
  const auto plate = state.read(field::plate_id);
  const auto& given = *context.reconstruction;
  const Matrix3 south = given.rotations.at(12, 50.0)->matrix(),
                north = given.rotations.at(11, 50.0)->matrix();
  int compared = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    const Vector3 at = unit_vector_of(grid.position(grid.column(c), grid.row(c)));
    const double in_south = back(south, at)[2], in_north = back(north, at)[2];
    // Away from edges, where outlines bend, and from gaps and overlaps.
    constexpr double kEdge = 0.15;
    if (std::abs(in_south) < kEdge || std::abs(in_north) < kEdge || in_south * in_north < 0.0) {
      continue;
    }
    EXPECT_EQ(plate[c], in_south < 0.0 ? 0 : 1);
    ++compared;
  }
  EXPECT_GT(compared, grid.size() / 2);
}

TEST(GivenRotations, ALaterPlateIsCutOutInTheStepOfItsBeginning) {
  Context context = two_hemispheres();
  (void)drift(driven(), context);
  const auto& lives = table_of(context, "lives").rows;
  ASSERT_GT(lives.size(), 2U);
  EXPECT_EQ(lives[2][1], "rift");
  EXPECT_EQ(lives[2][2], "1");
  EXPECT_EQ(lives[2][3], "12");
  const auto& given = *context.reconstruction;
  int rows = 0;
  for (const auto& row : table_of(context, "rotations").rows) {
    if (row[2] != "2") continue;
    const double from_ma = 50.0 - std::stod(row[0]), to_ma = 50.0 - std::stod(row[1]);
    const auto wanted = given.rotations.stage_rad_myr(13, from_ma, to_ma);
    EXPECT_LT(length(add(rotation_of(row), *wanted, -1.0)), kDigits_rad_myr) << from_ma;
    ++rows;
  }
  EXPECT_EQ(rows, 14);
  // By chance none rifts.
  EXPECT_EQ(context.budget.at("rifts"), 1);
}

TEST(GivenRotations, AnEventTakesAPlateOutOfTheReconstruction) {
  Context context = two_hemispheres();
  context.events = {Event{"", PlateMotion{.time_myr = 20.0,
                                          .latitude_deg = -80.0,
                                          .longitude_deg = 0.0,
                                          .pole_latitude_deg = 90.0,
                                          .pole_longitude_deg = 0.0,
                                          .speed_mm_yr = 30.0}}};
  (void)drift(driven(), context);
  for (const auto& row : table_of(context, "rotations").rows) {
    if (row[2] != "0" || std::stod(row[0]) < 20.0) continue;
    EXPECT_NEAR(rotation_of(row)[2], 30.0 / 6371.0088, 1e-8) << row[0];
  }
}

TEST(GivenRotations, APlateWhoseRotationsEndMovesOnWithAWarning) {
  Context context = two_hemispheres();
  PlateReconstruction given = *context.reconstruction;
  std::vector<RotationSequence> sequences(given.rotations.sequences().begin(),
                                          given.rotations.sequences().end());
  sequences[0].rotations.front().time_ma = 25.0;  // plate 12
  sequences.erase(sequences.begin() + 1);         // plate 11 since 20 Ma
  given.rotations = RotationModel(std::move(sequences));
  given.later.clear();
  context.reconstruction = std::make_shared<const PlateReconstruction>(std::move(given));
  (void)drift(driven(), context);
  ASSERT_EQ(std::ranges::count_if(context.warnings,
                                  [](const std::string& one) {
                                    return one.find("moves on as it did") != std::string::npos;
                                  }),
            2);
  EXPECT_THAT(
      context.warnings,
      testing::Contains(HasSubstr("plate 12 has no rotation from 26 to 24 Ma: it moves on")));
}

TEST(GivenRotations, GoOnFromAFrameToTheSameBits) {
  PlatesParameters p = driven();
  p.frames_myr = 10.0;
  const auto frames_from = [&](std::shared_ptr<const Checkpoint> from, State& state) {
    Context context = two_hemispheres();
    context.checkpoint = std::move(from);
    std::vector<Frame> frames;
    context.on_frame = [&](Frame frame) { frames.push_back(std::move(frame)); };
    state = drift(p, context);
    return frames;
  };
  State whole(std::make_shared<Grid>(Grid::sphere(64, 32))), rest = whole;
  const auto frames = frames_from(nullptr, whole);
  ASSERT_EQ(frames.size(), 5U);
  for (const std::size_t k : {1U, 2U}) {  // before and after plate 13 appears
    (void)frames_from(std::make_shared<const Checkpoint>(frames[k].checkpoint), rest);
    EXPECT_TRUE(same_values(whole, rest)) << "from frame " << k;
  }
  // From another time of the reconstruction it would not be the same drift.
  Context other = two_hemispheres();
  PlateReconstruction given = *other.reconstruction;
  given.start_ma = 49.0;
  other.reconstruction = std::make_shared<const PlateReconstruction>(std::move(given));
  other.checkpoint = std::make_shared<const Checkpoint>(frames[1].checkpoint);
  EXPECT_THROW((void)drift(p, other), InputError);
}

}  // namespace
}  // namespace geo
