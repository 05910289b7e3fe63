// Every parameter of the planet, its climate, water, life and islands at both ends of its range,
// one at a time, through all stages from climate to island.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geo/kernels/noise/noise.hpp"
#include "geo/stages/stages.hpp"
#include "support.hpp"

namespace geo {
namespace {

/// What one run goes through: stages from climate on, with all their parameters and the planet's.
struct Course {
  Course() {
    for (const StageEntry& entry : stage_table()) {
      const auto stage = entry.make();
      const auto& reads = stage->info().reads;
      if (std::find(reads.begin(), reads.end(), &field::elevation) == reads.end()) continue;
      if (entry.name == "isostasy" || entry.name == "erosion") continue;
      stages.push_back(entry.make());
    }
    for (const auto& stage : stages) {
      for (const Parameter& p : stage->parameters()) parameters.push_back(p);
    }
    for (const Parameter& p : planet.parameters()) parameters.push_back(p);
    set("climate.resolution_deg", "10");
    set("island.nx", "48");
    set("island.ny", "32");
    set("island.cell_m", "20000");
    set("island.center", "10,20");
    set("island.erosion_steps", "2");
  }
  void set(std::string_view name, std::string_view text) {
    find_parameter(parameters, name)->set_text(text);
  }
  std::vector<std::unique_ptr<Stage>> stages;
  Planet planet;
  std::vector<Parameter> parameters;
};

void expect_sound(const StageInfo& info, const State& state, const Budget& budget) {
  for (const FieldSpec* spec : info.writes) {
    ASSERT_TRUE(state.has(*spec)) << spec->name;
    std::visit(
        [&](const auto& values) {
          for (const auto value : values) {
            ASSERT_TRUE(std::isfinite(static_cast<double>(value))) << spec->name;
            ASSERT_GE(static_cast<double>(value), spec->least) << spec->name;
            ASSERT_LE(static_cast<double>(value), spec->most) << spec->name;
          }
        },
        *state.values(*spec));
  }
  for (const auto& [name, value] : budget) {
    ASSERT_TRUE(std::isfinite(value)) << name;
    if (!name.ends_with("closing_error")) continue;
    ASSERT_LT(std::abs(value), 1e-6) << name;
  }
}

void run(Course& course) {
  const auto grid = std::make_shared<const Grid>(Grid::sphere(64, 32, course.planet.figure()));
  const Noise noise(11, "relief");
  std::vector<float> z(grid->size());
  for (Index c = 0; c < grid->size(); ++c) {
    z[c] = 300.0F + 5000.0F * static_cast<float>(noise.fbm(
                                  grid->unit_vector(grid->column(c), grid->row(c)), 2.0, 5));
  }
  State state(grid);
  state.set(field::elevation, std::move(z));
  for (const auto& stage : course.stages) {
    SCOPED_TRACE(stage->info().name);
    Context context;
    context.planet = course.planet;
    context.configuration = course.parameters;
    StageIo io(state, stage->info());
    ASSERT_NO_THROW(stage->run(io, context));
    expect_sound(stage->info(), io.result(), context.budget);
    if (testing::Test::HasFatalFailure()) return;
  }
}

std::vector<std::string> ends_of(const Parameter& p) {
  if (std::holds_alternative<bool*>(p.storage)) return {"false", "true"};
  if (std::holds_alternative<std::string*>(p.storage)) return {p.choices.begin(), p.choices.end()};
  if (std::holds_alternative<std::int64_t*>(p.storage)) {
    return {std::to_string(static_cast<std::int64_t>(p.min)),
            std::to_string(static_cast<std::int64_t>(p.max))};
  }
  return {to_toml(ParameterValue(p.min)), to_toml(ParameterValue(p.max))};
}

TEST(Extremes, LeaveASoundPlanet) {
  std::vector<std::string> names;
  for (const Parameter& p : Course().parameters) names.emplace_back(p.name);
  EXPECT_GT(names.size(), 100u);
  for (const std::string& name : names) {
    for (const std::string& end : ends_of(*find_parameter(Course().parameters, name))) {
      // Half a degree of air is 25 times the cells of the whole rest; its other end is here.
      if (name == "climate.resolution_deg" && end == "0.5") continue;
      SCOPED_TRACE(name + " = " + end);
      Course course;
      // Islands that reach round the planet are refused, which has a test of its own.
      if (name == "island.nx" || name == "island.ny") course.set("island.cell_m", "1000");
      if (name == "planet.radius_km") course.set("island.cell_m", "10");
      course.set(name, end);
      run(course);
      if (HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace geo
