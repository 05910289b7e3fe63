#include "geo/core/parameter.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/event.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

using testing::HasSubstr;

std::string complaint(const std::function<void()>& what) {
  try {
    what();
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return {};
}

TEST(Parameter, KnowsItsSectionAndKey) {
  double value = 1.0;
  const Parameter of_model =
      real("plates.sphere.time_myr", value, "Myr", 0.0, 10.0, "how long plates drift", "design");
  EXPECT_EQ(of_model.section(), "plates.sphere");
  EXPECT_EQ(of_model.key(), "time_myr");
  EXPECT_TRUE(is_section_of(of_model.section(), "plates"));
  EXPECT_TRUE(is_section_of(of_model.section(), "plates.sphere"));
  EXPECT_FALSE(is_section_of(of_model.section(), "plates.sph"));
  EXPECT_FALSE(is_section_of("plates", "plates.sphere"));
}

TEST(Parameter, StoresWhatIsInItsRangeAndSaysWhatIsNot) {
  double value = 1.0;
  const Parameter p = real("a.b_km", value, "km", 0.0, 10.0, "a length", "design");
  p.set(2.5);
  EXPECT_EQ(value, 2.5);
  p.set(std::int64_t{3});
  EXPECT_EQ(value, 3.0);
  EXPECT_THAT(complaint([&] { p.set(10.5); }), HasSubstr("a.b_km = 10.5: must be in [0, 10] km"));
  EXPECT_THAT(complaint([&] { p.set(std::nan("")); }), HasSubstr("must be finite"));
  EXPECT_THAT(complaint([&] { p.set_text("far"); }), HasSubstr("must be a real number"));
  EXPECT_THAT(complaint([&] { p.set(true); }), HasSubstr("must be a real number"));
  EXPECT_EQ(value, 3.0);
}

TEST(Parameter, TakesAllBitsOfIntegersFromText) {
  std::int64_t value = 0;
  const Parameter p = integer("a.n", value, "1", std::numeric_limits<std::int64_t>::min(),
                              std::numeric_limits<std::int64_t>::max(), "a number", "design");
  p.set_text("9007199254740993");
  EXPECT_EQ(value, 9007199254740993);
  EXPECT_FALSE(complaint([&] { p.set_text("1.5"); }).empty());
  EXPECT_FALSE(complaint([&] { p.set_text("99999999999999999999"); }).empty());
  EXPECT_EQ(value, 9007199254740993);
}

TEST(Parameter, SuggestsTheNearestChoice) {
  std::string word = "rivers";
  const Parameter p = choice("a.law", word, {"height", "land", "rivers"}, "a law", "design");
  EXPECT_THAT(complaint([&] { p.set_text("river"); }), HasSubstr("did you mean \"rivers\"?"));
  p.set_text("\"land\"");
  EXPECT_EQ(word, "land");
}

TEST(Parameter, IsFoundByTheNameThatItOnceHad) {
  std::string model = "fast", other = "slow";
  double value = 1.0;
  const std::vector<Parameter> all{
      choice("rivers.model", model, {"fast", "slow"}, "how rivers flow", "design"),
      choice("rivers.bed.model", other, {"fast", "slow"}, "how beds wear", "design"),
      real("rivers.fast.depth_m", value, "m", 0.0, 9.0, "how deep they are", "design"),
      real("rivers.bed.grain_m", value, "m", 0.0, 9.0, "how coarse it is", "design"),
      renamed(real("lakes.area_m2", value, "m2", 0.0, 9.0, "how large they are", "design"),
              "ponds.size_m2")};
  const auto today = [&](std::string_view name) {
    const Parameter* found = find_renamed(all, name);
    return found == nullptr ? std::string() : std::string(found->name);
  };
  EXPECT_EQ(today("ponds.size_m2"), "lakes.area_m2");
  EXPECT_EQ(today("rivers.depth_m"), "rivers.fast.depth_m");
  EXPECT_EQ(today("lakes.depth_m"), "");
  EXPECT_EQ(today("rivers.grain_m"), "") << "a process is no model: its keys were always its own";
  EXPECT_EQ(today("rivers.area_m2"), "");
  EXPECT_EQ(today("depth_m"), "");
  EXPECT_EQ(today(""), "");
}

TEST(NearestWord, CountsLettersThatAreMissingAddedOtherOrSwapped) {
  const std::vector<std::string_view> words{"rivers", "height", "land"};
  for (const char* misspelt : {"river", "riverss", "rixers", "rievrs", "rivers"}) {
    EXPECT_EQ(nearest_word(misspelt, words), "rivers") << misspelt;
  }
  // A swap of neighbours is one mistake, not two: "ab" is as near to "ba" as to "b".
  EXPECT_EQ(nearest_word("ba", std::vector<std::string_view>{"ab", "b"}), "ab");
  EXPECT_EQ(nearest_word("ba", std::vector<std::string_view>{"b", "ab"}), "b");
}

TEST(NearestWord, TakesTheFirstOfThoseThatAreEquallyNear) {
  EXPECT_EQ(nearest_word("bat", std::vector<std::string_view>{"cat", "rat", "bats"}), "cat");
  EXPECT_EQ(nearest_word("bat", std::vector<std::string_view>{"rat", "cat", "bat"}), "bat");
}

TEST(NearestWord, IsNoneWhereAllAreFurtherThanAThirdOfTheWordAndOne) {
  const std::vector<std::string_view> words{"elevation"};
  EXPECT_EQ(nearest_word("elev", words), "");                // 5 letters are missing, 2 may
  EXPECT_EQ(nearest_word("elevxxxxn", words), "elevation");  // 4 others of 9
  EXPECT_EQ(nearest_word("elexxxxxn", words), "");
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(nearest_word("elevation", {}), "");
  EXPECT_EQ(nearest_word("", std::vector<std::string_view>{"x"}), "x");
}

/// Optimal string alignment by its recursion, as the definition has it.
int alignment(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return static_cast<int>(a.size() + b.size());
  const auto without = [](std::string_view word, std::size_t letters) {
    return word.substr(0, word.size() - letters);
  };
  int least = std::min({alignment(without(a, 1), b) + 1, alignment(a, without(b, 1)) + 1,
                        alignment(without(a, 1), without(b, 1)) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    least = std::min(least, alignment(without(a, 2), without(b, 2)) + 1);
  }
  return least;
}

TEST(NearestWord, IsTheNearestByItsDefinition) {
  const RandomStream random(7, "nearest_word_test");
  std::uint64_t at = 0;
  const auto word = [&] {
    std::string letters(random.uniform(at++) * 6.0, ' ');
    for (char& letter : letters) letter = static_cast<char>('a' + random.uniform(at++) * 3.0);
    return letters;
  };
  for (int trial = 0; trial < 300; ++trial) {
    const std::string given = word();
    const std::vector<std::string> words{word(), word(), word(), word()};
    const std::vector<std::string_view> candidates(words.begin(), words.end());
    std::string nearest;
    int least = static_cast<int>(given.size() / 3) + 2;
    for (const std::string& candidate : words) {
      if (const int distance = alignment(given, candidate); distance < least) {
        least = distance;
        nearest = candidate;
      }
    }
    EXPECT_EQ(nearest_word(given, candidates), nearest) << "trial " << trial << ": " << given;
  }
}

TEST(Parameter, IsWrittenSoThatEveryBitReturns) {
  double value = 0.0;
  const Parameter p = real("a.b", value, "1", -1e300, 1e300, "a number", "design");
  for (const double number : {0.1, 1.0 / 3.0, -2.5e-17, 6.02214076e23, 5.0, -0.0}) {
    p.set_text(to_toml(ParameterValue(number)));
    EXPECT_EQ(value, number);
  }
}

TEST(Event, DeclaresItsOwnKeys) {
  Event event{.name = "Big", .what = Impact{}};
  EXPECT_EQ(event.kind(), "impact");
  EXPECT_FALSE(event.is_of_plates());
  EXPECT_EQ(event.path(), nullptr);
  const auto keys = event.declarations();
  const Parameter* diameter = find_parameter(keys, "event.diameter_km");
  ASSERT_NE(diameter, nullptr);
  diameter->set(12.0);
  EXPECT_EQ(std::get<Impact>(event.what).diameter_km, 12.0);
  Event rift{.name = "", .what = PlateRift{}};
  EXPECT_TRUE(rift.is_of_plates());
  EXPECT_NE(rift.path(), nullptr);
}

TEST(Event, FigureOfARecordIsTheOtherwiseWhereItIsNot) {
  const EventRecord record{.number = 1, .kind = "impact", .name = "", .figures = {{"a_km", 2.0}}};
  EXPECT_EQ(figure_of(record, "a_km", 9.0), 2.0);
  EXPECT_EQ(figure_of(record, "b_km", 9.0), 9.0);
}

}  // namespace
}  // namespace geo
