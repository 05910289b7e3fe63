#include "geo/io/config/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "geo/core/error.hpp"
#include "geo/core/planet.hpp"
#include "geo/io/config/presets.hpp"

namespace geo::io {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Settings {
  double length_km = 12.5;
  std::int64_t steps = 3;
  bool carve = true;
  std::string routing = "mfd";
  std::string file;
  std::vector<Parameter> parameters() {
    return {real("rivers.length_km", length_km, "km", 0.0, 100.0, "length of a reach", "design"),
            integer("rivers.steps", steps, "1", 1, 50, "number of steps", "design"),
            flag("rivers.carve", carve, "cut valleys", "design"),
            choice("rivers.routing", routing, {"d8", "mfd"}, "how water parts", "design"),
            text("source.file", file, "where the relief comes from", "design")};
  }
};

std::string refusal(const std::string& toml) {
  Settings settings;
  const auto parameters = settings.parameters();
  try {
    apply_toml(toml, "planet.toml", parameters);
  } catch (const ConfigurationError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "accepted";
}

TEST(Config, SetsWhatTheFileNamesAndSaysSo) {
  Settings settings;
  const auto names = apply_toml("[source]\nfile = 'a b.nc'\n[rivers]\nsteps = 7\nlength_km = 4\n",
                                "planet.toml", settings.parameters());
  EXPECT_THAT(names, testing::ElementsAre("source.file", "rivers.steps", "rivers.length_km"));
  EXPECT_EQ(settings.steps, 7);
  EXPECT_EQ(settings.length_km, 4.0);
  EXPECT_EQ(settings.file, "a b.nc");
  EXPECT_TRUE(settings.carve);
}

TEST(Config, RefusalsNameFileLineKeyAndRemedy) {
  EXPECT_THAT(refusal("[rivers]\n\nstesp = 4\n"),
              testing::AllOf(StartsWith("planet.toml:3: unknown key rivers.stesp"),
                             HasSubstr("did you mean rivers.steps?")));
  EXPECT_THAT(refusal("[rivres]\nsteps = 4\n"),
              testing::AllOf(StartsWith("planet.toml:1: "), HasSubstr("did you mean rivers?")));
  EXPECT_EQ(refusal("[rivers]\nlength_km = 200.0\n"),
            "planet.toml:2: rivers.length_km = 200.0: must be in [0, 100] km");
  EXPECT_THAT(refusal("[rivers]\nlength_km = nan\n"), HasSubstr("must be finite"));
  EXPECT_THAT(refusal("[rivers]\nsteps = 2.5\n"), HasSubstr("must be an integer"));
  EXPECT_THAT(refusal("[rivers]\nsteps = [1, 2]\n"), HasSubstr("rivers.steps: is an array"));
  EXPECT_THAT(refusal("[rivers]\nsteps = 1979-05-27\n"), HasSubstr("is a date or time"));
  EXPECT_THAT(refusal("[rivers]\nrouting = 'd7'\n"), HasSubstr("did you mean \"d8\"?"));
  EXPECT_THAT(refusal("steps = 4\n"), HasSubstr("must stand in a section; did you mean [rivers]?"));
  EXPECT_THAT(refusal("[rivers]\nsteps = 4\nsteps = 5\n"), StartsWith("planet.toml:3: "));
  EXPECT_THAT(refusal("[rivers]\nsteps = \n"), StartsWith("planet.toml:2: "));
  EXPECT_THAT(refusal("[rivers\nsteps = 3\n"), StartsWith("planet.toml:1: "));
}

TEST(Config, AssignmentsAreCheckedLikeTheFile) {
  Settings settings;
  const auto parameters = settings.parameters();
  EXPECT_EQ(apply_assignment("rivers.steps=9", parameters), "rivers.steps");
  EXPECT_EQ(settings.steps, 9);
  apply_assignment("rivers.carve = false", parameters);
  EXPECT_FALSE(settings.carve);
  apply_assignment("source.file=a=b.nc", parameters);
  EXPECT_EQ(settings.file, "a=b.nc");
  EXPECT_THROW(apply_assignment("rivers.steps", parameters), ConfigurationError);
  EXPECT_THROW(apply_assignment("=3", parameters), ConfigurationError);
  EXPECT_THROW(apply_assignment("rivers.steps=many", parameters), ConfigurationError);
  EXPECT_THROW(apply_assignment("rivers.step=3", parameters), ConfigurationError);
  EXPECT_EQ(settings.steps, 9) << "a refused value changes nothing";
}

TEST(Config, WrittenConfigurationReadsBackBitForBit) {
  Settings settings;
  settings.length_km = 0.1 + 0.2;
  settings.file = "quotes \" and \\ and \ttab";
  settings.steps = 50;
  settings.carve = false;
  const auto text = write_config(settings.parameters(), "all there is");
  Settings again;
  apply_toml(text, "config.toml", again.parameters());
  EXPECT_EQ(again.length_km, settings.length_km);
  EXPECT_EQ(again.file, settings.file);
  EXPECT_EQ(again.steps, settings.steps);
  EXPECT_EQ(again.carve, settings.carve);
  EXPECT_EQ(write_config(again.parameters(), "all there is"), text);
  EXPECT_THAT(text, HasSubstr("# length of a reach; real in km, [0, 100]\nlength_km = "));
}

TEST(Config, FirstDifferenceNamesKeyAndBothValues) {
  Settings settings;
  const auto before = write_config(settings.parameters(), "before");
  EXPECT_EQ(first_difference(before, before), "");
  settings.steps = 8;
  settings.file = "other.nc";
  const auto after = write_config(settings.parameters(), "after");
  EXPECT_EQ(first_difference(before, after), "rivers.steps is 8, was 3");
  const std::vector<std::string> only_source{"source"};
  EXPECT_EQ(first_difference(before, after, only_source), "source.file is \"other.nc\", was \"\"");
  const std::vector<std::string_view> ignored{"rivers.steps"};
  EXPECT_EQ(first_difference(before, after, {}, ignored), "source.file is \"other.nc\", was \"\"");
}

TEST(Presets, EarthComesFirstAndAllHaveASummary) {
  ASSERT_FALSE(presets().empty());
  EXPECT_EQ(presets().front().name, "earth");
  for (const Preset& preset : presets()) EXPECT_FALSE(preset.summary.empty()) << preset.name;
  EXPECT_EQ(find_preset("preview").name, "preview");
  try {
    find_preset("earth-dme");
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean earth-dem?"));
  }
}

}  // namespace
}  // namespace geo::io
