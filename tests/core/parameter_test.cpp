#include "geo/core/parameter.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "geo/core/error.hpp"
#include "geo/core/event.hpp"

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
