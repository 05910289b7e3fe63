// Finite rotations of plates through time.
#include "geo/kernels/plates/rotation_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geo/core/error.hpp"
#include "geo/core/random.hpp"

namespace geo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRoundOff = 1e-12;

Vector3 moved(const std::optional<Quaternion>& rotation, const Vector3& at) {
  return times(rotation.value().matrix(), at);
}
double far_apart(const Vector3& a, const Vector3& b) { return length(add(a, b, -1.0)); }

TEST(RotationVector, IsTheShorterWayRound) {
  const Vector3 rotation{0.3, -1.0, 0.5};
  EXPECT_LT(far_apart(rotation_vector(Quaternion::about(rotation)), rotation), kRoundOff);
  const Vector3 far = scaled(normalised(rotation), 4.0);
  EXPECT_NEAR(length(rotation_vector(Quaternion::about(far))), 2.0 * std::acos(-1.0) - 4.0,
              kRoundOff);
  EXPECT_EQ(rotation_vector({}), Vector3{});
}

/// A drift of 10 Myr in steps of 2: plate 0 lives throughout, 1 breaks off it after 4 Myr, 2 joins
/// it after 6 Myr and 3 subducts after 8.
struct ADrift {
  ADrift() {
    const RandomStream random(3, "turns");
    for (int k = 0; k < 5; ++k) {
      const double from = 2.0 * k;
      for (int plate = 0; plate < 4; ++plate) {
        if (from < spans[plate].born_myr || from >= spans[plate].ended_myr) continue;
        turns.push_back({plate, from, from + 2.0, scaled(random.direction(10 * k + plate), 0.05)});
      }
    }
  }
  /// Where crust that is at a place when the drift begins comes to, as it is part of these plates.
  [[nodiscard]] Vector3 carried(Vector3 at, double from_myr, double to_myr, auto plate_at) const {
    for (const PlateTurn& turn : turns) {
      if (turn.from_myr < from_myr || turn.to_myr > to_myr) continue;
      if (turn.plate == plate_at(turn.from_myr))
        at = rotated(at, scaled(turn.rotation_rad_myr, 2.0));
    }
    return at;
  }
  std::vector<PlateSpan> spans{{0},
                               {.plate = 1, .parent = 0, .born_myr = 4.0},
                               {.plate = 2, .joined = 0, .ended_myr = 6.0},
                               {.plate = 3, .ended_myr = 8.0}};
  std::vector<PlateTurn> turns;
};

TEST(RotationsOfADrift, CarryCrustFromTheBeginningToWhereItIsToday) {
  const ADrift drift;
  const RotationModel model = rotations_of_drift(drift.turns, drift.spans, 0.0, 10.0, 100);
  const Vector3 at = normalised({1.0, 2.0, 0.5});
  const auto check = [&](int plate, double last_myr, auto plate_at) {
    SCOPED_TRACE(plate);
    // A plate that is no more counts as if it had stayed where it was last.
    const Vector3 last = drift.carried(at, 0.0, last_myr, plate_at);
    for (double time = 0.0; time <= last_myr; time += 2.0) {
      const Vector3 then = drift.carried(at, 0.0, time, plate_at);
      EXPECT_LT(far_apart(moved(model.at(100 + plate, 10.0 - time), last), then), kRoundOff);
    }
  };
  check(0, 10.0, [](double) { return 0; });
  check(1, 10.0, [](double time) { return time < 4.0 ? 0 : 1; });
  check(2, 10.0, [](double time) { return time < 6.0 ? 2 : 0; });
  check(3, 8.0, [](double) { return 3; });
}

TEST(RotationsOfADrift, PlateHasItsOwnRotationsOverItsLifeAndIsFixedToOthersBesides) {
  const ADrift drift;
  const RotationModel model = rotations_of_drift(drift.turns, drift.spans, 0.0, 10.0, 100);
  const auto spans_of = [&](int plate) {
    std::vector<std::array<double, 3>> found;
    for (const RotationSequence& sequence : model.sequences()) {
      if (sequence.moving != plate) continue;
      found.push_back({static_cast<double>(sequence.fixed), sequence.rotations.front().time_ma,
                       sequence.rotations.back().time_ma});
    }
    return found;
  };
  using Span = std::array<double, 3>;
  EXPECT_THAT(spans_of(100), ElementsAre(Span{0, 0, 10}));
  EXPECT_THAT(spans_of(101), ElementsAre(Span{0, 0, 6}, Span{100, 6, 10}));
  EXPECT_THAT(spans_of(102), ElementsAre(Span{100, 0, 4}, Span{0, 4, 10}));
  EXPECT_THAT(spans_of(103), ElementsAre(Span{0, 2, 10}));
  EXPECT_FALSE(model.at(103, 1.0));
}

TEST(RotationsOfADrift, APlateOfTheLastMomentIsFixedToItsParent) {
  // Told how it would go on, for no time yet.
  ADrift drift;
  drift.spans.push_back({.plate = 4, .parent = 0, .born_myr = 10.0});
  drift.turns.push_back(
      {.plate = 4, .from_myr = 10.0, .to_myr = 10.0, .rotation_rad_myr = {0.0, 0.0, 0.1}});
  const RotationModel model = rotations_of_drift(drift.turns, drift.spans, 0.0, 10.0, 100);
  const Vector3 at = normalised({1.0, 2.0, 0.5});
  for (const double ago : {0.0, 3.0, 10.0}) {
    EXPECT_LT(far_apart(moved(model.at(104, ago), at), moved(model.at(100, ago), at)), kRoundOff);
  }
}

TEST(RotationsOfADrift, CrossoversGiveTheSameRotationInTheAbsoluteFrame) {
  const ADrift drift;
  const RotationModel model = rotations_of_drift(drift.turns, drift.spans, 0.0, 10.0, 100);
  for (const auto& [plate, crossover] : {std::pair{101, 6.0}, std::pair{102, 4.0}}) {
    std::vector<Quaternion> there;
    for (const RotationSequence& sequence : model.sequences()) {
      if (sequence.moving != plate) continue;
      for (const FiniteRotation& sample : sequence.rotations) {
        if (sample.time_ma == crossover) {
          there.push_back(model.at(sequence.fixed, crossover)->after(sample.rotation));
        }
      }
    }
    ASSERT_EQ(there.size(), 2U) << plate;
    EXPECT_LT(length(rotation_vector(there[0].after({there[1].w, scaled(there[1].v, -1.0)}))),
              kRoundOff);
  }
}

TEST(RotationModel, StagesAreTheTurnsThatItWasMadeOf) {
  const ADrift drift;
  const RotationModel model = rotations_of_drift(drift.turns, drift.spans, 0.0, 10.0, 100);
  for (const PlateTurn& turn : drift.turns) {
    const auto stage =
        model.stage_rad_myr(100 + turn.plate, 10.0 - turn.from_myr, 10.0 - turn.to_myr);
    ASSERT_TRUE(stage);
    EXPECT_LT(far_apart(*stage, turn.rotation_rad_myr), kRoundOff);
    // Also within a turn.
    const auto part =
        model.stage_rad_myr(100 + turn.plate, 9.5 - turn.from_myr, 9.1 - turn.from_myr);
    ASSERT_TRUE(part);
    EXPECT_LT(far_apart(*part, turn.rotation_rad_myr), 1e-11);
  }
}

TEST(RotationModel, FollowsACircuitOfPlates) {
  const Vector3 first{0.0, 0.0, 0.4}, second{0.3, 0.0, 0.0};
  const RotationModel model({{20, 10, {{0.0, {}}, {50.0, Quaternion::about(second)}}},
                             {10, 0, {{0.0, {}}, {50.0, Quaternion::about(first)}}}});
  const Vector3 at = normalised({0.2, 0.7, 0.1});
  EXPECT_LT(far_apart(moved(model.at(20, 50.0), at), rotated(rotated(at, second), first)),
            kRoundOff);
  EXPECT_LT(far_apart(moved(model.at(20, 25.0), at),
                      rotated(rotated(at, scaled(second, 0.5)), scaled(first, 0.5))),
            kRoundOff);
  EXPECT_THAT(model.plates(), ElementsAre(10, 20));
  EXPECT_FALSE(model.at(20, 51.0));
  EXPECT_FALSE(model.at(30, 10.0));
}

TEST(RotationModel, RefusesACircuitThatLeadsBackToItself) {
  try {
    const RotationModel model({{1, 2, {{0.0, {}}, {5.0, {}}}}, {2, 1, {{0.0, {}}, {5.0, {}}}}});
    FAIL() << "took it";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("leads back to itself"));
  }
  EXPECT_THROW(RotationModel({{1, 0, {{5.0, {}}, {5.0, {}}}}}), InputError);
}

}  // namespace
}  // namespace geo
