// Drifting plates whose rivers know a climate: plates.landscape = "full".
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "drifted.hpp"
#include "geo/core/error.hpp"
#include "geo/stages/stages.hpp"

namespace geo {
namespace {

struct History {
  State state{std::make_shared<Grid>(Grid::sphere(64, 32))};
  std::vector<Frame> frames;
  Context told;
};

PlatesParameters with_landscape() {
  PlatesParameters p = with_frames();
  p.landscape = "full";
  p.time_myr = 40.0;
  p.climate_myr = 10.0;
  return p;
}

History history(const PlatesParameters& parameters,
                std::shared_ptr<const Checkpoint> from = nullptr) {
  History history;
  const Pipeline pipeline = make_pipeline();
  const auto stage = make_plates_stage(parameters);
  StageIo io(history.state, stage->info());
  Context& context = history.told;
  context.seed = 6;
  context.configuration = pipeline.parameters();
  context.checkpoint = std::move(from);
  context.on_frame = [&](Frame frame) { history.frames.push_back(std::move(frame)); };
  stage->run(io, context);
  context.on_frame = {};
  return history;
}

const History& one_history() {
  static const History kHistory = history(with_landscape());
  return kHistory;
}

TEST(DriftLandscape, IsInTheFrames) {
  ASSERT_EQ(one_history().frames.size(), 3U);
  for (const Frame& frame : one_history().frames) {
    const State& state = frame.fields;
    const auto z = state.read(field::elevation), rain = state.read(field::precipitation);
    const auto ice = state.read(field::ice_thickness), warmth = state.read(field::temperature);
    const auto sediment = state.read(field::sediment_thickness);
    const auto water = state.read(field::discharge);
    double wet = 0.0, laid = 0.0, rivers = 0.0;
    for (std::size_t c = 0; c < z.size(); ++c) {
      ASSERT_TRUE(std::isfinite(z[c]) && std::isfinite(warmth[c]));
      ASSERT_GE(rain[c], 0.0F);
      ASSERT_GE(sediment[c], 0.0F);
      ASSERT_GE(ice[c], 0.0F);
      if (z[c] < 0.0F) {
        EXPECT_EQ(ice[c], 0.0F);
        EXPECT_EQ(water[c], 0.0F);
      }
      wet = std::max(wet, static_cast<double>(rain[c]));
      laid = std::max(laid, static_cast<double>(sediment[c]));
      rivers = std::max(rivers, static_cast<double>(water[c]));
    }
    EXPECT_GT(wet, 1000.0);
    EXPECT_GT(rivers, 1000.0);
    EXPECT_GT(laid, frame.checkpoint.time_myr > 0.0 ? 100.0 : -1.0);
  }
  // The tropics are wetter than the poles and warmer.
  const State& last = one_history().frames.back().fields;
  const auto rain = last.read(field::precipitation), warmth = last.read(field::temperature);
  const Grid& grid = last.grid();
  const auto mean = [&](std::span<const float> values, double from_deg, double to_deg) {
    double sum = 0.0, area = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      const double latitude = std::abs(grid.latitude_deg(grid.row(c)));
      if (latitude < from_deg || latitude > to_deg) continue;
      sum += values[c];
      area += 1.0;
    }
    return sum / area;
  };
  EXPECT_GT(mean(rain, 0.0, 10.0), 2.0 * mean(rain, 70.0, 90.0));
  EXPECT_GT(mean(warmth, 0.0, 10.0), mean(warmth, 70.0, 90.0) + 20.0);
}

TEST(DriftLandscape, ClosesItsBudgets) {
  const Budget& budget = one_history().told.budget;
  EXPECT_NEAR(budget.at("sediment_drift_closing_error"), 0.0, 1e-9);
  EXPECT_NEAR(budget.at("continental_closing_error"), 0.0, 1e-9);
  EXPECT_GT(budget.at("sediment_laid_km3"), 1e6);
  EXPECT_GT(budget.at("sediment_subducted_km3"), 0.0);
}

TEST(DriftLandscape, KeepsTheWaterOfItsSea) {
  const auto water_km3 = [](const Frame& frame) {
    return frame.checkpoint.get<double>("water").front();
  };
  for (const Frame& frame : one_history().frames) {
    EXPECT_EQ(water_km3(frame), water_km3(one_history().frames.front()));
  }
  // Its level is not what stays.
  const StepTable& steps = one_history().told.steps;
  const auto column = std::find(steps.columns.begin(), steps.columns.end(), "sea_level_m");
  ASSERT_NE(column, steps.columns.end());
  const auto k = static_cast<std::size_t>(column - steps.columns.begin());
  EXPECT_GT(std::abs(steps.rows.back()[k] - steps.rows.front()[k]), 10.0);
}

TEST(DriftLandscape, GoesOnFromAnyFrameToTheSameBits) {
  PlatesParameters p = with_landscape();
  p.motion_samples = 3000;
  p.frames_myr = 16.0;  // between two climates
  const History whole = history(p);
  const History rest =
      history(p, std::make_shared<const Checkpoint>(whole.frames.at(1).checkpoint));
  EXPECT_EQ(whole.frames.back().checkpoint.arrays, rest.frames.back().checkpoint.arrays);
  EXPECT_TRUE(same_values(whole.frames.back().fields, rest.frames.back().fields));
  EXPECT_TRUE(same_values(whole.state, rest.state));
}

TEST(DriftLandscape, IsOfPlatesThatDriftAndRunsWithAClimate) {
  PlatesParameters p = with_landscape();
  State state(std::make_shared<Grid>(Grid::sphere(64, 32)));
  EXPECT_THROW((void)frames_of(p, state, nullptr), ConfigurationError);
  p.model = "growth";
  EXPECT_THROW(
      make_plates_stage(p)->check(Grid::sphere(64, 32), [](const FieldSpec&) { return false; }),
      ConfigurationError);
}

}  // namespace
}  // namespace geo
