#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bibliography.hpp"
#include "support.hpp"

namespace geo {
namespace {

std::vector<std::string> words(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// How a name may spell one factor of a unit: "day" is d, "degC" c or degc.
std::vector<std::string> spellings(std::string base) {
  static const std::map<std::string, std::vector<std::string>> kShort{
      {"day", {"d"}},     {"degree", {"deg"}}, {"degC", {"degc", "c"}}, {"K", {"k", "c"}},
      {"Mm", {"1000km"}}, {"hPa", {"hpa"}},    {"Pa", {"pa"}},          {"N", {"n"}},
      {"W", {"w"}},       {"J", {"j"}},        {"Myr", {"myr"}},        {"kPa", {"kpa"}}};
  const auto known = kShort.find(base);
  if (known != kShort.end()) return known->second;
  return {base};
}

/// Whether the key ends in its unit: "W m-2 K-1" in w_m2_k, "yr-1" in yr, "m-1" in 1_m or m.
bool ends_in(const std::string& key, const std::string& units) {
  std::vector<std::string> endings{""};
  for (const std::string& factor : words(units, ' ')) {
    const auto digits = factor.find_first_of("-0123456789");
    std::string power = digits == std::string::npos ? "" : factor.substr(digits);
    if (!power.empty() && power[0] == '-') power.erase(0, 1);
    if (power == "1") power.clear();
    std::vector<std::string> longer;
    for (const std::string& before : endings) {
      for (const std::string& word : spellings(factor.substr(0, digits))) {
        longer.push_back(before + "_" + word + power);
      }
    }
    endings = longer;
  }
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return key.ends_with(ending); });
}

const std::set<std::string> kUnitWords{"km", "m", "mm",  "yr",  "k",  "c",  "degc", "deg", "d",
                                       "h",  "s", "bar", "hpa", "m2", "m3", "km2",  "w"};

class EveryParameter : public testing::Test {
 protected:
  test::Declarations declarations;
  std::vector<Parameter> all = declarations.all();
};

TEST_F(EveryParameter, HasANameOfItsOwnInTheSectionOfItsOwner) {
  std::set<std::string_view> names;
  for (const Parameter& p : all) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " is declared twice";
    // "stage.key", "stage.model.key" of one of the stage's models, or "stage.process.key" of a
    // process that has models of its own.
    const std::string_view section = p.section();
    const bool is_process = find_parameter(all, std::string(section) + ".model") != nullptr;
    if (const auto dot = section.find('.'); dot != std::string_view::npos && !is_process) {
      const Parameter* model = find_parameter(all, std::string(section.substr(0, dot)) + ".model");
      ASSERT_NE(model, nullptr) << p.name;
      EXPECT_THAT(model->choices, testing::Contains(section.substr(dot + 1))) << p.name;
    }
    EXPECT_FALSE(section.empty() || p.key().empty()) << p.name;
    EXPECT_EQ(p.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_."),
              std::string_view::npos)
        << p.name;
  }
  for (const StageEntry& entry : stage_table()) {
    const auto stage = entry.make();
    EXPECT_EQ(stage->info().name, entry.name);
    for (const Parameter& p : stage->parameters()) {
      EXPECT_TRUE(p.name.starts_with(std::string(entry.name) + ".")) << p.name;
    }
  }
}

TEST_F(EveryParameter, IsFoundByItsFormerNameWhichNoOtherHas) {
  std::set<std::string_view> former;
  for (const Parameter& p : all) {
    if (p.former_name.empty()) continue;
    EXPECT_TRUE(former.insert(p.former_name).second) << p.former_name << " is two parameters now";
    EXPECT_EQ(find_parameter(all, p.former_name), nullptr) << p.former_name << " is there today";
    EXPECT_EQ(find_renamed(all, p.former_name)->name, p.name);
  }
  EXPECT_GE(former.size(), 7U);
  // What moved from a stage's section into those of its models has one home.
  for (const Parameter& p : all) {
    const std::string_view stage = p.section().substr(0, p.section().find('.'));
    if (stage != "plates" || p.section() == stage) continue;
    const std::string moved = std::string(stage) + "." + std::string(p.key());
    EXPECT_EQ(find_parameter(all, moved), nullptr) << moved << " is there today";
    ASSERT_NE(find_renamed(all, moved), nullptr) << moved;
    EXPECT_EQ(find_renamed(all, moved)->name, p.name) << moved << " is two parameters now";
  }
}

TEST_F(EveryParameter, HasUnitsThatUdunitsReadsAndNoneForWords) {
  const test::Units units;
  for (const Parameter& p : all) {
    const bool is_number = p.type_name() == "real" || p.type_name() == "integer";
    if (is_number) {
      EXPECT_FALSE(p.units.empty()) << p.name << ": pure numbers have the unit 1";
      EXPECT_TRUE(units.reads(p.units)) << p.name << " in " << p.units;
    } else {
      EXPECT_EQ(p.units, "") << p.name;
    }
  }
}

TEST_F(EveryParameter, EndsInItsUnit) {
  for (const Parameter& p : all) {
    const std::string key(p.key()), units(p.units);
    if (units.empty() || units == "1") {
      const auto last = words(key, '_').back();
      EXPECT_FALSE(kUnitWords.contains(last)) << p.name << " has no unit but ends in one";
    } else {
      EXPECT_TRUE(ends_in(key, units)) << p.name << " in " << units;
    }
  }
}

TEST_F(EveryParameter, SaysInOneLineWhatItIs) {
  for (const Parameter& p : all) {
    EXPECT_GE(p.doc.size(), 8U) << p.name;
    EXPECT_EQ(p.doc.find_first_of("\n|"), std::string_view::npos)
        << p.name << ": the line goes into a table";
    EXPECT_FALSE(p.doc.ends_with('.')) << p.name << ": a phrase, without a full stop";
  }
}

TEST_F(EveryParameter, HasADefaultWithinItsRange) {
  for (const Parameter& p : all) {
    EXPECT_LE(p.min, p.max) << p.name;
    EXPECT_EQ(p.value(), p.default_value) << p.name;
    EXPECT_NO_THROW(p.set(p.default_value)) << p.name;
    EXPECT_NO_THROW(p.set_text(to_toml(p.default_value))) << p.name;
  }
}

TEST_F(EveryParameter, RefusesWhatLiesOutsideItsRange) {
  for (const Parameter& p : all) {
    if (p.type_name() == "real" && std::isfinite(p.max)) {
      EXPECT_THROW(p.set(p.max + 1 + std::abs(p.max)), ConfigurationError) << p.name;
      EXPECT_THROW(p.set(p.min - 1 - std::abs(p.min)), ConfigurationError) << p.name;
      EXPECT_THROW(p.set(std::nan("")), ConfigurationError) << p.name;
    }
    if (!p.choices.empty()) {
      EXPECT_THROW(p.set(std::string("nonsense")), ConfigurationError) << p.name;
    }
    EXPECT_EQ(p.value(), p.default_value) << p.name << ": a refused value leaves no trace";
  }
}

TEST_F(EveryParameter, HasASourceInTheBibliography) {
  const auto entries = test::bibliography();
  for (const Parameter& p : all) {
    if (p.source == "design") continue;
    EXPECT_TRUE(entries.contains(std::string(p.source))) << p.name << " from " << p.source;
  }
}

}  // namespace
}  // namespace geo
