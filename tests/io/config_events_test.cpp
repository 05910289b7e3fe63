#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"

namespace geo::io {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<Event> events_of(const std::string& toml) {
  std::vector<Event> events;
  apply_toml(toml, "planet.toml", {}, &events);
  return events;
}

std::string refusal(const std::string& toml) {
  try {
    events_of(toml);
  } catch (const ConfigurationError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "accepted";
}

constexpr const char* kAll = R"([[event]]
kind = "impact"
name = "The \"big\" one"
latitude_deg = -12.5
longitude_deg = 200
diameter_km = 3
age_yr = 1e6

[[event]]
kind = "rift"
path_deg = [[30, -170.25], [10, 175]]
depth_m = 800

[[event]]
kind = "ocean-shift"
water_km3 = -2e6
)";

TEST(ConfigEvents, KindsAndKeysAreRead) {
  const auto events = events_of(kAll);
  ASSERT_EQ(events.size(), 3U);
  const auto& impact = std::get<Impact>(events[0].what);
  EXPECT_EQ(events[0].name, "The \"big\" one");
  EXPECT_EQ(impact.latitude_deg, -12.5);
  EXPECT_EQ(impact.longitude_deg, 200.0);
  EXPECT_EQ(impact.age_yr, 1e6);
  EXPECT_EQ(impact.angle_deg, Impact().angle_deg);
  const auto& rift = std::get<Rift>(events[1].what);
  ASSERT_EQ(rift.path.size(), 2U);
  EXPECT_EQ(rift.path[0].latitude_deg, 30.0);
  EXPECT_EQ(rift.path[0].longitude_deg, -170.25);
  EXPECT_EQ(rift.depth_m, 800.0);
  EXPECT_EQ(std::get<OceanShift>(events[2].what).water_km3, -2e6);
}

TEST(ConfigEvents, WhatIsWrittenIsReadBackAsItWas) {
  const auto events = events_of(kAll);
  const std::string text = write_config({}, "heading", events);
  EXPECT_EQ(write_config({}, "heading", events_of(text)), text);
  EXPECT_THAT(text, HasSubstr("path_deg = [[30.0, -170.25], [10.0, 175.0]]"));
}

TEST(ConfigEvents, TimelinesHaveLinesRegionsAndPlumes) {
  const std::string text =
      "[[event]]\nkind = 'plate-rift'\ntime_myr = 5\npath_deg = [[0, 30], [10, 35]]\n"
      "[[event]]\nkind = 'crust-change'\ntime_myr = 5\npath_deg = [[0, 30], [10, 35], [10, 30]]\n"
      "[[event]]\nkind = 'plume'\ntime_myr = 5\nlatitude_deg = 3\nlongitude_deg = 4\n"
      "active = false\n";
  const auto events = events_of(text);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(std::get<PlateRift>(events[0].what).path.size(), 2U);
  EXPECT_EQ(std::get<CrustChange>(events[1].what).path[2].longitude_deg, 30.0);
  EXPECT_FALSE(std::get<PlumeChange>(events[2].what).active);
  const std::string written = write_config({}, "heading", events);
  EXPECT_EQ(write_config({}, "heading", events_of(written)), written);
  EXPECT_THAT(written, HasSubstr("path_deg = [[0.0, 30.0], [10.0, 35.0], [10.0, 30.0]]"));
  EXPECT_THAT(refusal("[[event]]\nkind = 'plate-rift'\ntime_myr = 5\n"),
              HasSubstr("needs latitude_deg"));
  EXPECT_THAT(
      refusal("[[event]]\nkind = 'crust-change'\ntime_myr = 5\npath_deg = [[0, 3], [1, 3]]\n"),
      HasSubstr("needs three places or more"));
  EXPECT_THAT(refusal("[[event]]\nkind = 'crust-change'\ntime_myr = 5\n"
                      "path_deg = [[0, 0], [10, 0], [10, 10], [5, -5]]\n"),
              HasSubstr("the outline crosses itself behind its places 1 and 3"));
  EXPECT_THAT(
      refusal("[[event]]\nkind = 'plate-rift'\ntime_myr = 5\npath_deg = [[90, 3], [90, 5]]\n"),
      HasSubstr("places 1 and 2 are the same"));
  EXPECT_THAT(refusal("[[event]]\nkind = 'plume'\ntime_myr = 5\npath_deg = [[0, 3], [1, 3]]\n"),
              HasSubstr("unknown key event.path_deg"));
}

TEST(ConfigEvents, AFileReplacesThoseBeforeIt) {
  auto events = events_of(kAll);
  apply_toml("", "planet.toml", {}, &events);
  EXPECT_EQ(events.size(), 3U);
  apply_toml("[[event]]\nkind = 'ocean-shift'\nrise_m = 3.0\n", "planet.toml", {}, &events);
  EXPECT_EQ(events.size(), 1U);
}

TEST(ConfigEvents, DifferencesAreNamed) {
  const std::string before = write_config({}, "", events_of(kAll));
  auto events = events_of(kAll);
  EXPECT_EQ(first_difference(before, write_config({}, "", events)), "");
  std::get<Rift>(events[1].what).path[1].latitude_deg = 11.0;
  EXPECT_EQ(first_difference(before, write_config({}, "", events)), "event 2 is another");
  events = events_of(kAll);
  events.pop_back();
  EXPECT_EQ(first_difference(before, write_config({}, "", events)), "event 3 is absent");
  EXPECT_EQ(first_difference(write_config({}, "", events), before), "event 3 was absent");
  const std::vector<std::string> others{"run"};
  EXPECT_EQ(first_difference(before, write_config({}, "", events), others), "");
}

TEST(ConfigEvents, RefusalsSayWhereAndWhatIsRight) {
  const std::string impact = "[[event]]\nkind = 'impact'\n";
  const std::string place = impact + "latitude_deg = 0\nlongitude_deg = 0\n";
  const std::string rift = "[[event]]\nkind = 'rift'\n";
  EXPECT_THAT(refusal("[event]\nkind = 'impact'\n"),
              testing::AllOf(StartsWith("planet.toml:1: "), HasSubstr("tables [[event]]")));
  EXPECT_THAT(refusal("event = 3\n"), HasSubstr("tables [[event]]"));
  EXPECT_THAT(refusal("\n[[event]]\nname = 'x'\n"),
              StartsWith("planet.toml:2: event needs a kind: one of impact, rift, ocean-shift"));
  EXPECT_THAT(refusal("[[event]]\nkind = 'imapct'\n"), HasSubstr("did you mean impact?"));
  EXPECT_THAT(refusal(impact), HasSubstr("event of kind impact needs latitude_deg"));
  EXPECT_THAT(refusal(place), HasSubstr("needs diameter_km"));
  EXPECT_THAT(refusal(place + "diametre_km = 3\n"),
              testing::AllOf(StartsWith("planet.toml:5: unknown key event.diametre_km"),
                             HasSubstr("did you mean event.diameter_km?")));
  EXPECT_THAT(refusal(place + "diameter_km = -3\n"), HasSubstr("must be in [0.01, 1000]"));
  EXPECT_THAT(refusal(place + "diameter_km = 'big'\n"), HasSubstr("event.diameter_km"));
  EXPECT_THAT(refusal(place + "diameter_km = 1\nname = 7\n"), HasSubstr("event.name: must be"));
  EXPECT_THAT(refusal(place + "diameter_km = 1\npath_deg = [[0, 0], [1, 1]]\n"),
              HasSubstr("unknown key event.path_deg"));
  EXPECT_THAT(refusal(rift), HasSubstr("needs path_deg"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 0]]\n"), HasSubstr("at least two places"));
  EXPECT_THAT(refusal(rift + "path_deg = 5\n"), HasSubstr("at least two places"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 0], [3]]\n"), HasSubstr("[latitude, longitude]"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 0], ['a', 3]]\n"),
              HasSubstr("[latitude, longitude]"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 0], [120, 3]]\n"),
              HasSubstr("120, 3 is no latitude"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 0], [nan, 3]]\n"), HasSubstr("is no latitude"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 180], [0, -180]]\n"),
              HasSubstr("places 1 and 2 are the same"));
  EXPECT_THAT(refusal(rift + "path_deg = [[0, 0], [20, 10], [-20, -170]]\n"),
              HasSubstr("places 2 and 3 are antipodes"));
  EXPECT_THAT(refusal("[[event]]\nkind = 'ocean-shift'\n"),
              HasSubstr("either rise_m or water_km3"));
  EXPECT_THAT(refusal("[[event]]\nkind = 'ocean-shift'\nrise_m = 1\nwater_km3 = 1\n"),
              HasSubstr("either rise_m or water_km3"));
  EXPECT_THROW(apply_toml(kAll, "planet.toml", {}), ConfigurationError);
  EXPECT_THROW(apply_assignment("event.kind=impact", {}), ConfigurationError);
}

}  // namespace
}  // namespace geo::io
