// Rotation files of GPlates.
#include "geo/io/input/rotation_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

using testing::HasSubstr;

constexpr double kRadians = std::numbers::pi / 180.0;

Quaternion about_pole(double angle_deg) {
  return Quaternion::about({0.0, 0.0, angle_deg * kRadians});
}

/// Angle between two rotations, degrees.
double apart_deg(const Quaternion& a, const Quaternion& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(a.w * b.w + dot(a.v, b.v)))) / kRadians;
}

std::string refusal(const std::string& text) {
  try {
    (void)rotations_of(text, "model.rot");
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "accepted";
}

TEST(RotationFile, CommentsBlankLinesAndUnsortedTimesAreRead) {
  const RotationModel model = rotations_of(
      "\xEF\xBB\xBF! all of it\r\n"
      "\r\n"
      "999 0.0 what GPlates takes for a comment\n"
      "101\t20.0  90.0 0.0 +40.0 000 !BRK-NAM a ! in a comment\n"
      "101 0.0 90.0 0.0 0.0 000!\n"
      "101 10.0 90.0 0.0 10.0 0",
      "model.rot");
  EXPECT_EQ(model.plates(), std::vector<int>{101});
  ASSERT_EQ(model.sequences().size(), 1U);
  EXPECT_LT(apart_deg(model.at(101, 5.0).value(), about_pole(5.0)), 1e-6);
  EXPECT_LT(apart_deg(model.at(101, 15.0).value(), about_pole(25.0)), 1e-6);
  EXPECT_FALSE(model.at(101, 20.1).has_value());
}

TEST(RotationFile, ACrossoverChangesTheFixedPlateWhereverItsLinesStand) {
  // Plate 2 turns with plate 1 before 30 Ma, by itself from 30 to 10 Ma, with plate 1 again since.
  const char* const kInOrder =
      "1 0 90 0 0 0 !\n1 50 90 0 50 0 !\n"
      "2 0 90 0 0 1 !\n2 10 90 0 0 1 !\n2 10 90 0 10 0 !\n2 30 90 0 50 0 !\n"
      "2 30 90 0 20 1 !\n2 50 90 0 20 1 !\n";
  const char* const kMixed =
      "2 50 90 0 20 1 !\n2 30 90 0 20 1 !\n2 10 90 0 10 0 !\n1 50 90 0 50 0 !\n"
      "2 30 90 0 50 0 !\n2 0 90 0 0 1 !\n2 10 90 0 0 1 !\n1 0 90 0 0 0 !\n";
  for (const char* text : {kInOrder, kMixed}) {
    const RotationModel model = rotations_of(text, "model.rot");
    EXPECT_EQ(model.sequences().size(), 4U);
    for (const auto& [time_ma, angle_deg] :
         {std::pair{5.0, 5.0}, {10.0, 10.0}, {20.0, 30.0}, {30.0, 50.0}, {45.0, 65.0}}) {
      EXPECT_LT(apart_deg(model.at(2, time_ma).value(), about_pole(angle_deg)), 1e-6) << time_ma;
    }
  }
}

TEST(RotationFile, TheSameLineTwiceCountsOnce) {
  const RotationModel model = rotations_of(
      "1 0 90 0 0 0 !\n1 5 10 20 30 0 !\n1 5 -10 200 -30 0 !\n1 9 10 20 50 0 !\n", "x");
  EXPECT_EQ(model.sequences().front().rotations.size(), 3U);
}

TEST(RotationFile, WhatIsWrongIsRefusedByItsLine) {
  const std::string good = "1 0 90 0 0 0 !\n1 50 90 0 50 0 !\n";
  EXPECT_EQ(refusal(good), "accepted");
  const auto third = [&](const std::string& line) { return refusal(good + line + "\n" + good); };
  EXPECT_THAT(refusal(""), HasSubstr("model.rot: holds no rotations"));
  EXPECT_THAT(third("2 0 90 0 0"), HasSubstr("model.rot:3: has 5 columns: must have 6"));
  EXPECT_THAT(third("2 0 90 0 0 1 1"), HasSubstr("model.rot:3: has 7 columns"));
  EXPECT_THAT(third("2 0 9O 0 0 1"), HasSubstr("model.rot:3: the latitude is 9O"));
  EXPECT_THAT(third("2 0 91 0 0 1"), HasSubstr("the latitude is 91: must be in [-90, 90]"));
  EXPECT_THAT(third("2 0 nan 0 0 1"), HasSubstr("the latitude is nan: must be in"));
  EXPECT_THAT(third("2 0 9 361 0 1"), HasSubstr("the longitude is 361"));
  EXPECT_THAT(third("2 0 9 0 inf 1"), HasSubstr("the angle is inf"));
  EXPECT_THAT(third("2 -1 9 0 0 1"), HasSubstr("the time is -1"));
  EXPECT_THAT(third("x 0 9 0 0 1"), HasSubstr("the moving plate is x"));
  EXPECT_THAT(third("2 0 9 0 0 1.5"), HasSubstr("the fixed plate is 1.5"));
  EXPECT_THAT(third("-2 0 9 0 0 1"), HasSubstr("the moving plate is -2"));
  EXPECT_THAT(third("0 0 9 0 0 1"), HasSubstr("moves plate 000"));
  EXPECT_THAT(third("2 0 9 0 0 2"), HasSubstr("model.rot:3: plate 2 is fixed to itself"));
  EXPECT_THAT(third("1 50 90 0 51 0"),
              HasSubstr("model.rot:3: plate 1 has another rotation relative to plate 0 at 50 Ma in "
                        "line 2"));
  EXPECT_THAT(
      refusal("3 0 9 0 0 0 !\n1 0 9 0 0 2 !\n1 9 9 0 0 2 !\n2 0 9 0 0 1 !\n2 9 9 0 0 1 !\n"),
      testing::ContainsRegex("model.rot:[24]: rotations of plate [12]: its circuit"));
}

}  // namespace
}  // namespace geo::io
