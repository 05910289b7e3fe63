#include <gtest/gtest.h>

#include <map>

#include "support.hpp"

namespace geo {
namespace {

/// Of the CF standard name table, with canonical units: the names that fields may bear.
const std::map<std::string_view, std::string_view> kStandardNames{
    {"height_above_mean_sea_level", "m"},
    {"air_temperature", "K"},
    {"lwe_precipitation_rate", "m s-1"},
    {"eastward_wind", "m s-1"},
    {"northward_wind", "m s-1"},
    {"water_volume_transport_in_river_channel", "m3 s-1"},
    {"land_ice_thickness", "m"},
    {"sea_ice_area_fraction", "1"},
    {"eastward_sea_water_velocity", "m s-1"},
    {"northward_sea_water_velocity", "m s-1"},
};

TEST(Vocabulary, HasOneRowPerName) {
  std::set<std::string_view> names;
  for (const FieldSpec* spec : field::all()) {
    EXPECT_TRUE(names.insert(spec->name).second) << spec->name;
    EXPECT_EQ(field::find(spec->name), spec);
    EXPECT_EQ(spec->name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos)
        << spec->name;
  }
  EXPECT_EQ(field::find("no_such_field"), nullptr);
}

TEST(Vocabulary, HasUnitsThatUdunitsReadsAndNoneForFlags) {
  const test::Units units;
  for (const FieldSpec* spec : field::all()) {
    if (spec->flags.empty()) {
      EXPECT_FALSE(spec->units.empty()) << spec->name << ": pure numbers have the unit 1";
      EXPECT_TRUE(units.reads(spec->units)) << spec->name << " in " << spec->units;
    } else {
      EXPECT_EQ(spec->units, "") << spec->name;
    }
  }
}

TEST(Vocabulary, UsesStandardNamesOfCfWithUnitsThatFit) {
  const test::Units units;
  for (const FieldSpec* spec : field::all()) {
    if (spec->standard_name.empty()) continue;
    const auto name = kStandardNames.find(spec->standard_name);
    ASSERT_NE(name, kStandardNames.end()) << spec->name << " is no " << spec->standard_name;
    EXPECT_TRUE(units.converts(spec->units, name->second)) << spec->name << " in " << spec->units;
  }
}

TEST(Vocabulary, SaysInOneLineWhatEachFieldIs) {
  for (const FieldSpec* spec : field::all()) {
    EXPECT_GE(spec->doc.size(), 8U) << spec->name;
    EXPECT_EQ(spec->doc.find_first_of("\n|"), std::string_view::npos) << spec->name;
    EXPECT_TRUE(spec->cell_methods.starts_with("area: ")) << spec->name;
  }
}

TEST(Vocabulary, HasFlagsOfOneWordEachThatFitTheirType) {
  for (const FieldSpec* spec : field::all()) {
    std::set<int> values;
    std::set<std::string_view> meanings;
    for (const Flag& flag : spec->flags) {
      EXPECT_TRUE(values.insert(flag.value).second) << spec->name << ' ' << flag.value;
      EXPECT_TRUE(meanings.insert(flag.meaning).second) << spec->name << ' ' << flag.meaning;
      EXPECT_EQ(flag.meaning.find(' '), std::string_view::npos) << flag.meaning;
      EXPECT_EQ(spec->type, Type::int8) << spec->name;
      EXPECT_NE(flag.value, spec->missing) << spec->name;
    }
  }
}

TEST(Vocabulary, HasNoFieldThatNoStageKnows) {
  std::set<std::string_view> known;
  for (const StageEntry& entry : stage_table()) {
    for (const std::string& model : test::models_of(entry)) {
      const auto stage = test::stage_of(entry, model);
      for (const auto* list :
           {&stage->info().reads, &stage->info().optional, &stage->info().writes}) {
        for (const FieldSpec* spec : *list) {
          EXPECT_EQ(field::find(spec->name), spec);
          known.insert(spec->name);
        }
      }
    }
  }
  for (const FieldSpec* spec : field::all()) EXPECT_TRUE(known.contains(spec->name)) << spec->name;
}

}  // namespace
}  // namespace geo
