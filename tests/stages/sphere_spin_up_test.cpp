// Where the history of drifting plates begins, and that it does not depend on the samples.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "drifted.hpp"
#include "geo/core/error.hpp"

namespace geo {
namespace {

PlatesParameters with_spin_up() {
  PlatesParameters p = with_frames();
  p.time_myr = 40.0;
  p.spin_up_myr = 60.0;
  return p;
}

TEST(SpinUp, ComesBeforeTheHistoryThatIsTold) {
  State state(std::make_shared<Grid>(Grid::sphere(64, 32)));
  Context told;
  const auto frames = frames_of(with_spin_up(), state, nullptr, {}, &told);
  ASSERT_EQ(frames.size(), 3U);  // 0, 20 and 40 Myr
  EXPECT_EQ(frames.front().checkpoint.time_myr, 0.0);
  EXPECT_EQ(frames.back().checkpoint.time_myr, 40.0);
  EXPECT_EQ(told.steps.rows.size(), 20U);
  EXPECT_EQ(told.steps.rows.front().front(), 2.0);
  for (const EventRecord& record : told.event_records) {
    for (const auto& [name, value] : record.figures) {
      if (name == "time_myr") EXPECT_GT(value, 0.0);
    }
  }
  // The first plates are those of time 0, numbered without gaps.
  const auto plates = frames.front().fields.read(field::plate_id);
  std::int16_t most = 0;
  for (const std::int16_t plate : plates) most = std::max(most, plate);
  for (const TextTable& table : told.tables) {
    if (table.name != "lives") continue;
    ASSERT_GT(static_cast<int>(table.rows.size()), most);
    for (std::int16_t k = 0; k <= most; ++k) {
      EXPECT_EQ(table.rows[k][1], "first") << k;
      EXPECT_EQ(table.rows[k][3], "0") << k;
    }
  }
}

TEST(SpinUp, LeavesFloorAsOldAsItsPlatesHaveMovedApart) {
  State spun(std::make_shared<Grid>(Grid::sphere(64, 32))), drawn = spun;
  PlatesParameters without = with_spin_up();
  without.spin_up_myr = 0.0;
  const auto first = frames_of(with_spin_up(), spun, nullptr).front();
  const auto begun = frames_of(without, drawn, nullptr).front();
  // Drawn plates have young floor along all their borders; moved ones along ridges alone.
  const auto beside = [](const Frame& frame, BoundaryType wanted) {
    const auto type = frame.fields.read(field::boundary_type);
    const auto age = frame.fields.read(field::crust_age);
    const auto land = frame.fields.read(field::continental_fraction);
    double sum = 0.0;
    int count = 0;
    for (std::size_t c = 0; c < type.size(); ++c) {
      if (type[c] != static_cast<std::int8_t>(wanted) || land[c] > 0.0F) continue;
      sum += age[c];
      ++count;
    }
    return sum / count;
  };
  EXPECT_GT(beside(first, BoundaryType::convergent), 2.0 * beside(first, BoundaryType::divergent));
  EXPECT_LT(beside(begun, BoundaryType::convergent), 1.5 * beside(begun, BoundaryType::divergent));
}

TEST(SpinUp, GoesOnFromAnyFrameToTheSameBits) {
  PlatesParameters p = with_spin_up();
  p.motion_samples = 3000;
  State whole(std::make_shared<Grid>(Grid::sphere(64, 32))), rest = whole;
  const auto frames = frames_of(p, whole, nullptr);
  const auto later = frames_of(p, rest, std::make_shared<const Checkpoint>(frames[1].checkpoint));
  EXPECT_EQ(frames.back().checkpoint.arrays, later.back().checkpoint.arrays);
  for (const FieldSpec* spec : make_plates_stage(p)->info().writes) {
    EXPECT_EQ(*whole.values(*spec), *rest.values(*spec)) << spec->name;
  }
}

TEST(SpinUp, ForgetsThePlatesThatHaveEndedInIt) {
  PlatesParameters p = with_spin_up();
  p.sphere.rift_per_myr = 0.1;
  p.spin_up_myr = 120.0;
  p.motion_samples = 3000;
  State state(std::make_shared<Grid>(Grid::sphere(64, 32)));
  for (const Frame& frame : frames_of(p, state, nullptr)) {
    for (const char* leading : {"", "leading_"}) {
      const auto array = [&](const char* name) { return std::string(leading) + name; };
      const auto& ids = frame.checkpoint.get<std::int16_t>(array("plate_id"));
      const auto lives = frame.checkpoint.get<double>(array("life_born_myr")).size();
      ASSERT_FALSE(ids.empty());
      for (const std::int16_t id : ids) EXPECT_LT(id, static_cast<std::int64_t>(lives));
    }
  }
}

TEST(MotionSamples, OfAFrameMustBeThoseOfTheRunThatGoesOn) {
  PlatesParameters p = with_spin_up();
  p.motion_samples = 3000;
  State state(std::make_shared<Grid>(Grid::sphere(64, 32)));
  const auto led = std::make_shared<const Checkpoint>(frames_of(p, state, nullptr)[1].checkpoint);
  PlatesParameters other = p;
  other.motion_samples = 0;
  EXPECT_THROW(frames_of(other, state, led), InputError);
  other.motion_samples = 4000;
  EXPECT_THROW(frames_of(other, state, led), InputError);
  const auto alone =
      std::make_shared<const Checkpoint>(frames_of(with_spin_up(), state, nullptr)[1].checkpoint);
  EXPECT_THROW(frames_of(p, state, alone), InputError);
}

TEST(Supercontinent, HoldsNearlyAllLandOnOnePlate) {
  PlatesParameters p = with_spin_up();
  p.spin_up_myr = 0.0;
  p.time_myr = 2.0;
  p.initial_continents = "supercontinent";
  State state(std::make_shared<Grid>(Grid::sphere(96, 48)));
  const Frame first = frames_of(p, state, nullptr).front();
  const Grid& grid = first.fields.grid();
  const auto land = first.fields.read(field::continental_fraction);
  const auto plate = first.fields.read(field::plate_id);
  double all = 0.0;
  std::map<std::int16_t, double> on;
  Vector3 middle{};
  for (Index c = 0; c < grid.size(); ++c) {
    if (land[c] < 0.5F) continue;
    const double area = grid.area_m2(grid.row(c));
    all += area;
    on[plate[c]] += area;
    middle = add(middle, grid.unit_vector(grid.column(c), grid.row(c)), area);
  }
  double most = 0.0;
  for (const auto& [number, area] : on) most = std::max(most, area);
  EXPECT_GT(most, 0.7 * all);
  // All of it within a hemisphere: a third of the sphere as a cap has its mean at 0.66.
  EXPECT_GT(length(middle) / all, 0.55);
}

}  // namespace
}  // namespace geo
