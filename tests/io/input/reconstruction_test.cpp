// Static polygons and rotations of GPlates as what drives a drift.
#include "geo/io/input/reconstruction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "geo/core/error.hpp"
#include "geo/io/input/plate_outlines.hpp"
#include "geo/kernels/plates/region_outline.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

using testing::HasSubstr;

const std::string kRotations =
    "1 0 90 0 0 0 !\n1 80 90 0 80 0 !\n2 0 90 0 0 1 !\n2 80 0 0 40 1 !\n"
    "3 0 90 0 0 2 !\n3 60 90 0 10 2 !\n4 0 0 0 0 9 !\n4 80 0 0 0 9 !\n";
const std::string kRing = "[[0, 0], [90, 0], [90, 45], [0, 0]]";

std::string polygon(const std::string& properties, const std::string& ring = kRing) {
  return R"({"type": "Feature", "properties": {)" + properties +
         R"(}, "geometry": {"type": "Polygon", "coordinates": [)" + ring + "]}}";
}
std::string dated(int plate, double from_ma, double to_ma) {
  return polygon(R"("PLATEID1": )" + std::to_string(plate) + R"(, "NAME": "p)" +
                 std::to_string(plate) + R"(", "FROMAGE": )" + std::to_string(from_ma) +
                 R"(, "TOAGE": )" + std::to_string(to_ma));
}

class Reconstructions : public testing::Test {
 protected:
  GivenReconstruction read(const std::vector<std::string>& features, double start_ma = 50.0,
                           double drift_myr = 40.0, const std::string& rotations = kRotations) {
    std::string all;
    for (const std::string& feature : features) all += (all.empty() ? "" : ", ") + feature;
    std::ofstream(polygons_) << R"({"type": "FeatureCollection", "features": [)" << all << "]}";
    std::ofstream(rotations_) << rotations;
    return read_reconstruction(polygons_.string(), rotations_.string(), start_ma, drift_myr);
  }
  template <class... Given>
  std::string refusal(Given... given) {
    try {
      (void)read(given...);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder_;
  const std::filesystem::path polygons_ = folder_ / "polygons.json", rotations_ = folder_ / "m.rot";
};

TEST_F(Reconstructions, PlatesAreThoseOfPolygonsThatAreValidAtTheBeginning) {
  const GivenReconstruction given =
      read({dated(2, 999, -999), dated(1, 50, 20), dated(2, 70, 50), dated(3, 40, 0),
            dated(1, 49, 0), dated(3, 30, 0), dated(3, 45, 39), dated(4, 10, 0), dated(4, 8, 0)});
  EXPECT_EQ(given.motion.first, (std::vector<int>{2, 1}));
  ASSERT_EQ(given.plates.size(), 2U);
  EXPECT_EQ(given.plates[0].name, "p2");
  EXPECT_EQ(given.plates[0].rings.size(), 2U);
  EXPECT_EQ(given.plates[1].rings.size(), 1U);
  // Plate 3 appears with what is valid at 45 Ma; plate 4, at the end, does not.
  ASSERT_EQ(given.motion.later.size(), 1U);
  EXPECT_EQ(given.motion.later[0].number, 3);
  EXPECT_EQ(given.motion.later[0].from_ma, 45.0);
  EXPECT_EQ(given.motion.later[0].outline.rings.size(), 1U);
}

TEST_F(Reconstructions, TheDriftEndsAtTheYoungestRotationUnlessItIsTold) {
  const std::vector<std::string> two{dated(1, 999, -999), dated(2, 999, -999)};
  EXPECT_EQ(read(two, 0.0, 30.0).motion.start_ma, 30.0);
  EXPECT_EQ(read(two, 70.0, 30.0).motion.start_ma, 70.0);
  EXPECT_EQ(refusal(two, 80.0, 80.0), "accepted");
  EXPECT_THAT(refusal(two, 81.0, 30.0),
              HasSubstr("m.rot: rotations are from 80 to 0 Ma: must reach over the drift, from 81 "
                        "to 51 Ma"));
  EXPECT_THAT(refusal(two, 20.0, 30.0), HasSubstr("from 20 to -10 Ma"));
  EXPECT_THAT(refusal(two, 0.0, 90.0), HasSubstr("from 90 to 0 Ma"));
}

TEST_F(Reconstructions, WhatDoesNotGoTogetherIsRefused) {
  const std::string first = dated(1, 999, -999);
  EXPECT_THAT(refusal(std::vector{first}),
              HasSubstr("polygons.json: has polygons of 1 plate at 50"));
  EXPECT_THAT(refusal(std::vector{first, dated(7, 99, 0)}),
              HasSubstr("feature 2 (p7): plate 7 has no rotation in "));
  EXPECT_THAT(refusal(std::vector{first, dated(4, 99, 0)}),
              HasSubstr("plate 4 has no rotation that leads to plate 000 at 50 Ma in "));
  EXPECT_THAT(refusal(std::vector{first, dated(3, 99, 0)}, 70.0),
              HasSubstr("plate 3 has no rotation that leads to plate 000 at 70 Ma in "));
  EXPECT_THAT(refusal(std::vector{first, polygon(R"("NAME": "x")")}),
              HasSubstr("feature 2 (x): needs the property PLATEID1"));
  EXPECT_THAT(refusal(std::vector{first, polygon(R"("PLATEID1": 2.5)")}),
              HasSubstr("feature 2: PLATEID1 = 2.5: must be a whole number"));
  EXPECT_THAT(refusal(std::vector{first, dated(2, 3, 8)}),
              HasSubstr("FROMAGE = 3 is younger than TOAGE = 8"));
}

TEST_F(Reconstructions, EdgesAreGreatCircles) {
  std::ofstream(polygons_) << R"({"type": "FeatureCollection", "features": [)"
                           << polygon(R"("PLATEID1": 1)",
                                      "[[-60, 45], [-60, -45], [60, -45], [60, 45], [-60, 45]]")
                           << "]}";
  const auto outlines = read_dated_outlines(polygons_.string());
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_TRUE(outlines[0].is_valid_at(4000.0));
  const RegionOutline region(outlines[0].outline.rings);
  // The great circle from 45 N 60 W to 45 N 60 E reaches 63.4 N.
  EXPECT_TRUE(region.holds({63.0, 0.0}));
  EXPECT_FALSE(region.holds({64.0, 0.0}));
  EXPECT_TRUE(region.holds({-63.0, 0.0}));
  EXPECT_FALSE(region.holds({0.0, 61.0}));
}

}  // namespace
}  // namespace geo::io
