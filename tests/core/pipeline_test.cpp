#include "geo/core/pipeline.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "geo/core/error.hpp"

namespace geo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A stage that does what a test says.
class TestStage final : public Stage {
 public:
  using Work = std::function<void(StageIo&, Context&)>;
  TestStage(StageInfo info, Work work) : info_(std::move(info)), work_(std::move(work)) {}

  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return {}; }
  void run(StageIo& io, Context& context) const override { work_(io, context); }

 private:
  StageInfo info_;
  Work work_;
};

std::unique_ptr<Stage> stage(StageInfo info, TestStage::Work work) {
  return std::make_unique<TestStage>(std::move(info), std::move(work));
}

Pipeline pipeline_of(std::unique_ptr<Stage> first, std::unique_ptr<Stage> second,
                     std::unique_ptr<Stage> third = nullptr,
                     std::unique_ptr<Stage> fourth = nullptr) {
  std::vector<std::unique_ptr<Stage>> stages;
  stages.push_back(std::move(first));
  stages.push_back(std::move(second));
  if (third) stages.push_back(std::move(third));
  if (fourth) stages.push_back(std::move(fourth));
  return Pipeline(std::move(stages));
}

State empty_state() { return State(std::make_shared<const Grid>(Grid::sphere(8, 4))); }

TestStage::Work fills(const Field<float>& spec, float value) {
  return [&spec, value](StageIo& io, Context&) {
    for (float& v : io.write(spec)) v += value;
  };
}

TEST(Pipeline, AReleasedFieldLeavesAtOnceUnlessALaterStageReadsIt) {
  for (const bool is_read_later : {false, true}) {
    bool is_there = false;
    const Pipeline pipeline = pipeline_of(
        stage({.name = "first", .writes = {&field::crust_age}}, fills(field::crust_age, 7.0F)),
        stage({.name = "second", .reads = {&field::crust_age}, .writes = {&field::elevation}},
              [&](StageIo& io, Context&) {
                io.write(field::elevation)[0] = io.read(field::crust_age)[0];
                io.release(field::crust_age);
                is_there = !io.read_optional(field::crust_age).empty();
              }),
        stage({.name = "third",
               .reads = is_read_later ? std::vector<const FieldSpec*>{&field::crust_age}
                                      : std::vector<const FieldSpec*>{&field::elevation},
               .writes = {&field::slope}},
              fills(field::slope, 1.0F)));
    State state = empty_state();
    Context context;
    pipeline.run(state, context, 0, 2, {});
    EXPECT_EQ(is_there, is_read_later);
  }
}

TEST(Pipeline, AStageReleasesNothingThatItWritesOrDoesNotDeclare) {
  const StageInfo info{.name = "made", .reads = {&field::crust_age}, .writes = {&field::elevation}};
  State state = empty_state();
  (void)state.update(field::crust_age);
  StageIo io(state, info);
  EXPECT_THROW(io.release(field::elevation), Bug);
  EXPECT_THROW(io.release(field::slope), Bug);
  io.release(field::crust_age);  // nobody says that it is not wanted
  EXPECT_TRUE(state.has(field::crust_age));
}

/// A stage that needs an age, whatever it reads.
class ParticularStage final : public Stage {
 public:
  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return {}; }
  void check(const Grid& /*grid*/,
             const std::function<bool(const FieldSpec&)>& has) const override {
    if (!has(field::crust_age)) throw ConfigurationError("no age");
  }
  void run(StageIo& /*io*/, Context& /*context*/) const override { FAIL() << "has run"; }

 private:
  StageInfo info_{.name = "particular"};
};

TEST(Pipeline, AsksStagesBeforeACellIsComputed) {
  bool has_run = false;
  const auto first_writes = [&](const FieldSpec& spec) {
    return pipeline_of(
        stage({.name = "first", .writes = {&spec}}, [&](StageIo&, Context&) { has_run = true; }),
        std::make_unique<ParticularStage>());
  };
  first_writes(field::crust_age).check(Grid::sphere(8, 4), {}, 0, 1);
  State state = empty_state();
  Context context;
  EXPECT_THROW(first_writes(field::elevation).run(state, context, 0, 1, {}), ConfigurationError);
  EXPECT_FALSE(has_run);
}

TEST(Pipeline, ParksAFieldThatTheNextStageDoesNotRead) {
  // The fourth stage reads an age that the second releases, and warmth that no other reads.
  std::vector<std::string> there_before_third, fetched;
  float sum = 0.0F;
  const Pipeline pipeline = pipeline_of(
      stage({.name = "first", .writes = {&field::crust_age, &field::temperature}},
            [](StageIo& io, Context&) {
              io.write(field::crust_age)[0] = 7.0F;
              io.write(field::temperature)[0] = 9.0F;
            }),
      stage({.name = "second", .reads = {&field::crust_age}, .writes = {&field::elevation}},
            [](StageIo& io, Context&) {
              io.write(field::elevation)[0] = io.read(field::crust_age)[0];
              io.release(field::crust_age);
            }),
      stage({.name = "third", .reads = {&field::elevation}, .writes = {&field::lake_depth}},
            fills(field::lake_depth, 1.0F)),
      stage({.name = "fourth",
             .reads = {&field::crust_age, &field::elevation},
             .optional = {&field::temperature},
             .writes = {&field::slope}},
            [&](StageIo& io, Context&) {
              sum = io.read(field::crust_age)[0] + io.read_optional(field::temperature)[0] +
                    io.read(field::elevation)[0];
              io.write(field::slope)[0] = sum;
            }));
  State state = empty_state();
  Context context;
  Pipeline::Observer observer;
  observer.before = [&](int at) {
    if (at != 2) return;
    for (const FieldSpec* spec : state.present()) there_before_third.emplace_back(spec->name);
  };
  observer.can_park = [](const FieldSpec&) { return true; };
  observer.fetch = [&](const FieldSpec& spec, State& to) {
    fetched.emplace_back(spec.name);
    std::vector<float> values(static_cast<std::size_t>(to.grid().size()));
    values[0] = &spec == &field::crust_age ? 7.0F : 9.0F;
    to.set(spec, values);
  };
  pipeline.run(state, context, 0, 3, observer);
  EXPECT_THAT(there_before_third, ElementsAre("elevation"));
  EXPECT_THAT(fetched, testing::UnorderedElementsAre("crust_age", "temperature"));
  EXPECT_EQ(sum, 23.0F);
}

TEST(Pipeline, DropsAFieldThatALaterStageMakesAnewUnread) {
  // The second stage makes elevation anew and reads the age alone.
  std::vector<std::string> there;
  const Pipeline pipeline = pipeline_of(
      stage({.name = "first", .writes = {&field::elevation, &field::crust_age}},
            [](StageIo& io, Context&) {
              io.write(field::elevation)[0] = 5.0F;
              io.write(field::crust_age)[0] = 7.0F;
            }),
      stage({.name = "second", .reads = {&field::crust_age}, .writes = {&field::elevation}},
            [](StageIo& io, Context&) {
              EXPECT_EQ(io.write(field::elevation)[0], 0.0F);
              EXPECT_EQ(io.read(field::crust_age)[0], 7.0F);
            }),
      stage({.name = "third", .reads = {&field::elevation}, .writes = {&field::temperature}},
            fills(field::temperature, 1.0F)));
  State state = empty_state();
  Context context;
  pipeline.run(state, context, 0, 2,
               {.before =
                    [&](int at) {
                      if (at == 1) {
                        for (const FieldSpec* spec : state.present())
                          there.emplace_back(spec->name);
                      }
                    },
                .after = {}});
  EXPECT_THAT(there, ElementsAre("crust_age"));
}

TEST(Pipeline, KeepsAFieldThatALaterStageChanges) {
  const Pipeline pipeline = pipeline_of(
      stage({.name = "first", .writes = {&field::elevation}}, fills(field::elevation, 2.0F)),
      stage({.name = "second", .reads = {&field::elevation}, .writes = {&field::elevation}},
            fills(field::elevation, 3.0F)));
  State state = empty_state();
  Context context;
  float result = 0.0F;
  pipeline.run(state, context, 0, 1,
               {.before = {}, .after = [&](int, const State& made, const Context&) {
                  result = made.read(field::elevation)[0];
                }});
  EXPECT_EQ(result, 5.0F);
  EXPECT_TRUE(state.present().empty());
}

TEST(Pipeline, NamesTheFieldThatIsMissingAndWhoWritesIt) {
  const Pipeline pipeline = pipeline_of(
      stage({.name = "first", .writes = {&field::elevation}}, fills(field::elevation, 1.0F)),
      stage({.name = "second", .reads = {&field::elevation}, .writes = {&field::temperature}},
            fills(field::temperature, 1.0F)));
  const Grid grid = Grid::sphere(8, 4);
  try {
    pipeline.check(grid, {}, 1, 1);
    FAIL();
  } catch (const ConfigurationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("second needs the field elevation"));
    EXPECT_THAT(error.what(), HasSubstr("stage first writes"));
  }
  EXPECT_NO_THROW(pipeline.check(grid, {}, 0, 1));
  const FieldSpec* const given = &field::elevation;
  EXPECT_NO_THROW(pipeline.check(grid, {&given, 1}, 1, 1));
}

TEST(Pipeline, FindsWhatAStageDidNotDeclareOrDidNotWrite) {
  State state = empty_state();
  Context context;
  const auto runs = [&](StageInfo info, TestStage::Work work) {
    std::vector<std::unique_ptr<Stage>> stages;
    stages.push_back(stage(std::move(info), std::move(work)));
    Pipeline(std::move(stages)).run(state, context, 0, 0, {});
  };
  EXPECT_THROW(runs({.name = "lazy", .writes = {&field::elevation}}, [](StageIo&, Context&) {}),
               Bug);
  EXPECT_THROW(runs({.name = "curious"},
                    [](StageIo& io, Context&) { (void)io.read_optional(field::elevation); }),
               Bug);
  EXPECT_THROW(runs({.name = "meddling", .reads = {}, .writes = {}}, fills(field::elevation, 1.0F)),
               Bug);
}

TEST(Pipeline, StopsBetweenStepsWhenASignalCame) {
  std::atomic<bool> stop = true;
  State state = empty_state();
  Context context;
  context.stop = &stop;
  std::vector<std::unique_ptr<Stage>> stages;
  stages.push_back(
      stage({.name = "first", .writes = {&field::elevation}}, fills(field::elevation, 1.0F)));
  EXPECT_THROW(Pipeline(std::move(stages)).run(state, context, 0, 0, {}), Interrupted);
}

}  // namespace
}  // namespace geo
