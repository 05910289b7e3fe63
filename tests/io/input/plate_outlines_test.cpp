// Plates of GeoJSON files.
#include "geo/io/input/plate_outlines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "geo/core/error.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kPole =
    R"("pole_latitude_deg": 60, "pole_longitude_deg": -80, "rate_deg_myr": 0.5)";
const std::string kRing = "[[0, 0], [90, 0], [90, 45], [0, 0]]";

std::string feature(const std::string& properties, const std::string& ring = kRing) {
  return R"({"type": "Feature", "properties": {)" + properties +
         R"(}, "geometry": {"type": "Polygon", "coordinates": [)" + ring + "]}}";
}
std::string collection(const std::string& features) {
  return R"({"type": "FeatureCollection", "features": [)" + features + "]}";
}

class PlateOutlines : public testing::Test {
 protected:
  std::vector<PlateOutline> read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_plate_outlines(file_.string());
  }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "plates.geojson";
};

TEST_F(PlateOutlines, NamesRingsAndPolesAreRead) {
  const auto plates =
      read(collection(feature(R"("name": "a", )" + kPole) + "," +
                      feature(R"("Name": "b", "pole_lat": -5, "pole_lon": 200.5, "rate": -1)") +
                      "," + R"({"type": "Feature", "properties": {"name": "a", )" + kPole +
                      R"(}, "geometry": {"type": "MultiPolygon", "coordinates": [[)" + kRing + "," +
                      kRing + "],[" + kRing + "]]}}"));
  ASSERT_EQ(plates.size(), 2U);
  EXPECT_EQ(plates[0].name, "a");
  EXPECT_EQ(plates[0].rings.size(), 4U);  // features of one name are one plate
  EXPECT_EQ(plates[0].pole.latitude_deg, 60.0);
  EXPECT_EQ(plates[0].pole.longitude_deg, -80.0);
  EXPECT_EQ(plates[0].rate_deg_myr, 0.5);
  EXPECT_EQ(plates[0].rings[0][2].latitude_deg, 45.0);
  EXPECT_EQ(plates[0].rings[0][2].longitude_deg, 90.0);
  EXPECT_EQ(plates[1].name, "b");
  EXPECT_EQ(plates[1].pole.longitude_deg, 200.5);
  EXPECT_EQ(plates[1].rate_deg_myr, -1.0);
}

TEST_F(PlateOutlines, PlatesOfPb2002KnowTheirPoles) {
  const auto plates =
      read(collection(feature(R"("LAYER": "plate", "Code": "AF", "PlateName": "Africa")") + "," +
                      feature(R"("LAYER": "plate", "Code": "PA", "PlateName": "Pacific")")));
  EXPECT_EQ(plates[0].name, "Africa");
  // Bird (2003), table 1.
  EXPECT_EQ(plates[0].pole.latitude_deg, 59.160);
  EXPECT_EQ(plates[0].pole.longitude_deg, -73.174);
  EXPECT_EQ(plates[0].rate_deg_myr, 0.9270);
  EXPECT_EQ(plates[1].rate_deg_myr, 0.0);
}

TEST_F(PlateOutlines, RefusalsSayWhereAndWhatIsRight) {
  EXPECT_THAT(refusal("{\"type\": "), AllOf(HasSubstr("plates.geojson"), HasSubstr("no JSON")));
  EXPECT_THAT(refusal("[1, 2]"), HasSubstr("must be a GeoJSON FeatureCollection"));
  EXPECT_THAT(refusal(collection(feature(kPole))), HasSubstr("has 1 plate: must have 2 to 200"));
  const auto second = [&](const std::string& one) {
    return refusal(collection(feature(kPole) + "," + one));
  };
  EXPECT_THAT(second("7"), HasSubstr("feature 2: must be a Feature"));
  EXPECT_THAT(second(feature(R"("name": "x")")),
              AllOf(HasSubstr("feature 2 (x): needs the properties pole_latitude_deg")));
  EXPECT_THAT(second(feature(R"("Code": "XY")")),
              HasSubstr("feature 2 (XY): XY is no Code of PB2002: needs the properties"));
  EXPECT_THAT(second(feature(R"("Code": "AF", "rate": 2)")), HasSubstr("(AF): needs the"));
  EXPECT_THAT(second(feature(R"("pole_lat": "north", "pole_lon": 0, "rate": 1)")),
              HasSubstr("property pole_lat must be a number"));
  EXPECT_THAT(second(feature(R"("pole_lat": 91, "pole_lon": 0, "rate": 1)")),
              HasSubstr("0, 91 is no longitude"));
  EXPECT_THAT(second(feature(R"("pole_lat": 9, "pole_lon": 0, "rate": 1e9)")),
              HasSubstr("must be in [-100, 100]"));
  EXPECT_THAT(second(feature(kPole, "[[0, 0], [90, 0], [0, 0]]")),
              HasSubstr("four positions or more"));
  EXPECT_THAT(second(feature(kPole, "[[0, 0], [90, 0], [90, 45], [0, 1]]")),
              HasSubstr("the last one as the first"));
  EXPECT_THAT(second(feature(kPole, "[[0, 0], [90, 0], [90, 145], [0, 0]]")),
              HasSubstr("90, 145 is no longitude"));
  EXPECT_THAT(second(feature(kPole, "[[0, 0], [90], [90, 45], [0, 0]]")),
              HasSubstr("position 2 of a ring"));
  EXPECT_THAT(second(feature(kPole, "[[0, 0], [40, 0], [10, 30], [40, 20], [0, 0]]")),
              HasSubstr("a ring crosses itself: its edges behind positions 2 and 4 do"));
  EXPECT_THAT(second(feature(kPole, "[[500000, 0], [600000, 0], [600000, 45], [500000, 0]]")),
              HasSubstr("500000, 0 is no longitude"));  // metres of a projection
  EXPECT_THAT(second(R"({"properties": {}})"), HasSubstr("has no geometry"));
  EXPECT_THAT(second(R"({"geometry": {"type": "LineString", "coordinates": []}})"),
              HasSubstr("geometry is a LineString"));
  EXPECT_THAT(second(R"({"geometry": {"type": 3, "coordinates": []}})"),
              HasSubstr("geometry is of no type"));
  try {
    (void)read_plate_outlines("nowhere.geojson");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere.geojson: no such file; must be earth"));
  }
  EXPECT_THROW((void)read_plate_outlines(folder_.path().string()), IoError);
}

TEST_F(PlateOutlines, PositionsAreDegreesInEverySystemThatIsTaken) {
  const std::string plates =
      feature(R"("name": "a", )" + kPole) + "," + feature(R"("name": "b", )" + kPole);
  const auto with = [&](const std::string& crs) {
    return R"({"type": "FeatureCollection", "crs": )" + crs + R"(, "features": [)" + plates + "]}";
  };
  const auto named = [&](const std::string& name) {
    return with(R"({"type": "name", "properties": {"name": ")" + name + R"("}})");
  };
  for (const auto* name : {"urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326"}) {
    EXPECT_EQ(read(named(name)).size(), 2U);
  }
  EXPECT_EQ(read(with("null")).size(), 2U);
  EXPECT_THAT(refusal(named("urn:ogc:def:crs:EPSG::3857")),
              HasSubstr("crs is urn:ogc:def:crs:EPSG::3857: positions must be longitude and "
                        "latitude in degrees (CRS84)"));
  EXPECT_THAT(refusal(with("7")), HasSubstr("crs is unknown"));
}

TEST_F(PlateOutlines, EarthHasItsLargestPlates) {
  const auto plates = read_plate_outlines("earth");
  EXPECT_EQ(plates.size(), 16U);
  EXPECT_EQ(plates.front().name, "Pacific");
}

TEST_F(PlateOutlines, NumbersBeyondWhatANumberCanBeAreRefused) {
  const std::string huge =
      R"("pole_latitude_deg": 1e999, "pole_longitude_deg": 0, "rate_deg_myr": 1)";
  EXPECT_THAT(refusal(collection(feature(R"("name": "a", )" + huge))),
              AllOf(HasSubstr(file_.string()), HasSubstr("number that is too large")));
}

}  // namespace
}  // namespace geo::io
