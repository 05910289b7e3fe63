// What every stage promises, on small planets, windows, planes and tori.
#include "geo/stages/stages.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "geo/kernels/noise/noise.hpp"
#include "support.hpp"

namespace geo {
namespace {

struct World {
  std::string name;
  std::shared_ptr<const Grid> grid;
};

std::vector<World> worlds() {
  const auto shared = [](Grid grid) { return std::make_shared<const Grid>(std::move(grid)); };
  return {{"sphere", shared(Grid::sphere(72, 36))},
          {"window", shared(Grid::window(48, 32, {40.0, 56.0, -10.0, 14.0}))},
          {"plane", shared(Grid::plane(48, 40, 8000.0, 6000.0, Edges::open, Centre{-35.0, 20.0}))},
          {"plane with walls", shared(Grid::plane(40, 36, 8000.0, 6000.0, Edges::closed))},
          {"torus", shared(Grid::torus(40, 50, 10000.0, 12000.0))}};
}

/// Continents, seas and mountains of coherent noise.
std::vector<float> relief(const Grid& grid) {
  const Noise noise(11, "relief");
  const double frequency = grid.topology() == Topology::sphere ? 2.0 : 30.0;
  std::vector<float> z(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const auto position = grid.unit_vector(grid.column(cell), grid.row(cell));
    z[cell] = 300.0F + 5000.0F * noise.fbm(position, frequency, 5);
  }
  return z;
}

template <class Action>
auto with_type(const FieldSpec& spec, Action&& action) {
  switch (spec.type) {
    case Type::float32:
      return action(static_cast<const Field<float>&>(spec));
    case Type::float64:
      return action(static_cast<const Field<double>&>(spec));
    case Type::int8:
      return action(static_cast<const Field<std::int8_t>&>(spec));
    case Type::int16:
      return action(static_cast<const Field<std::int16_t>&>(spec));
    case Type::int32:
      break;
  }
  return action(static_cast<const Field<std::int32_t>&>(spec));
}

bool lists(const std::vector<const FieldSpec*>& specs, const FieldSpec& spec) {
  return std::find(specs.begin(), specs.end(), &spec) != specs.end();
}

/// A stage with settings that keep the tests short without leaving anything out.
std::unique_ptr<Stage> quick(const StageEntry& entry, const std::string& model) {
  auto stage = test::stage_of(entry, model);
  const auto parameters = stage->parameters();
  const auto set = [&](std::string_view name, std::string_view text) {
    if (const Parameter* p = find_parameter(parameters, name)) p->set_text(text);
  };
  set("plates.sphere.samples", "1500");
  set("plates.sphere.time_myr", "44");
  set("plates.raster.map_columns", "96");
  set("plates.raster.cycle_steps", "100");
  set("erosion.steps", "3");
  set("erosion.uplift_mm_yr", "0.2");
  set("erosion.rebound_fraction", "0.8");
  set("climate.resolution_deg", "10");
  set("climate.temperature_noise_k", "1");
  set("climate.precipitation_noise_mm_yr", "50");
  set("island.nx", "96");
  set("island.ny", "64");
  return stage;
}

/// Runs a stage on a state. What it made: that state, or the one on a grid of its own.
State run(const Stage& stage, State& state, std::uint64_t seed = 5) {
  Context context;
  context.seed = seed;
  context.hypsography = {{0.0, 0.7, 1.0}, {-6000.0, 0.0, 5000.0}};
  StageIo io(state, stage.info());
  stage.run(io, context);
  return io.result();
}

/// The same fields with values of their own, so that runs do not share them.
State copy_of(const State& state) {
  State copy(state.shared_grid());
  for (const FieldSpec* spec : state.present()) copy.set(*spec, Values(*state.values(*spec)));
  return copy;
}

/// Calls with each stage and the state that it finds after those before it.
template <class Action>
void on_every_stage(Action&& action) {
  for (const World& world : worlds()) {
    State state(world.grid);
    state.set(field::elevation, relief(*world.grid));
    for (const StageEntry& entry : stage_table()) {
      const auto stage = quick(entry, "");
      const bool makes_a_planet = !lists(stage->info().reads, field::elevation);
      const bool needs_a_planet = makes_a_planet || stage->info().own_grid;
      if (needs_a_planet && world.grid->topology() != Topology::sphere) continue;
      for (const std::string& model : test::models_of(entry)) {
        SCOPED_TRACE(std::string(entry.name) + ' ' + model + " on a " + world.name);
        action(*quick(entry, model), std::as_const(state));
        if (testing::Test::HasFatalFailure()) return;
      }
      run(*stage, state);
    }
  }
}

testing::AssertionResult same_bits(const Values& a, const Values& b) {
  return std::visit(
      [&](const auto& left) -> testing::AssertionResult {
        const auto& right = std::get<std::decay_t<decltype(left)>>(b);
        for (std::size_t cell = 0; cell < left.size(); ++cell) {
          if (left[cell] == right[cell] || (left[cell] != left[cell] && right[cell] != right[cell]))
            continue;
          return testing::AssertionFailure()
                 << "cell " << cell << ": " << +left[cell] << " and " << +right[cell];
        }
        return testing::AssertionSuccess();
      },
      a);
}

void expect_same_outputs(const Stage& stage, const State& a, const State& b) {
  for (const FieldSpec* spec : stage.info().writes) {
    EXPECT_TRUE(same_bits(*a.values(*spec), *b.values(*spec))) << spec->name;
  }
}

TEST(EveryStage, CannotTouchWhatItDidNotDeclare) {
  const auto grid = std::make_shared<const Grid>(Grid::sphere(8, 4));
  for (const StageEntry& entry : stage_table()) {
    const auto stage = entry.make();
    const StageInfo& info = stage->info();
    State state(grid);
    StageIo io(state, info);
    for (const FieldSpec* spec : field::all()) {
      SCOPED_TRACE(std::string(entry.name) + ' ' + std::string(spec->name));
      with_type(*spec, [&](const auto& typed) {
        const bool written = lists(info.writes, typed);
        const bool known = written || lists(info.reads, typed) || lists(info.optional, typed);
        if (known) {
          EXPECT_NO_THROW((void)io.read_optional(typed));
        } else {
          EXPECT_THROW((void)io.read(typed), Bug);
          EXPECT_THROW((void)io.read_optional(typed), Bug);
        }
        if (written && !info.own_grid) {
          EXPECT_NO_THROW((void)io.write(typed));
        } else {
          EXPECT_THROW((void)io.write(typed), Bug);
        }
      });
    }
  }
}

TEST(EveryStage, DeclaresEachFieldOnceAndInOneRole) {
  for (const StageEntry& entry : stage_table()) {
    const auto stage = entry.make();
    const StageInfo& info = stage->info();
    EXPECT_FALSE(info.doc.empty()) << entry.name;
    EXPECT_FALSE(info.writes.empty()) << entry.name;
    for (const auto* list : {&info.reads, &info.optional, &info.writes}) {
      EXPECT_EQ(std::set<const FieldSpec*>(list->begin(), list->end()).size(), list->size());
    }
    for (const FieldSpec* spec : info.optional)
      EXPECT_FALSE(lists(info.reads, *spec)) << spec->name;
  }
}

TEST(EveryStage, WritesWhatItDeclaresFiniteAndWithinTheBoundsOfEachField) {
  on_every_stage([](const Stage& stage, const State& before) {
    State state = copy_of(before);
    const State made = run(stage, state);
    for (const FieldSpec* spec : stage.info().writes) {
      ASSERT_TRUE(made.has(*spec)) << spec->name;
      std::visit(
          [&](const auto& values) {
            for (std::size_t cell = 0; cell < values.size(); ++cell) {
              ASSERT_TRUE(std::isfinite(static_cast<double>(values[cell])))
                  << spec->name << " in cell " << cell;
              ASSERT_GE(static_cast<double>(values[cell]), spec->least) << spec->name;
              ASSERT_LE(static_cast<double>(values[cell]), spec->most) << spec->name;
              if (spec->flags.empty()) continue;
              ASSERT_TRUE(std::any_of(spec->flags.begin(), spec->flags.end(),
                                      [&](const Flag& flag) { return flag.value == values[cell]; }))
                  << spec->name << " is " << +values[cell] << " in cell " << cell;
            }
          },
          *made.values(*spec));
    }
  });
}

TEST(EveryStage, LeavesItsInputsAlone) {
  on_every_stage([](const Stage& stage, const State& before) {
    State state = copy_of(before);
    run(stage, state);
    for (const FieldSpec* spec : before.present()) {
      if (lists(stage.info().writes, *spec) && !stage.info().own_grid) continue;
      EXPECT_TRUE(same_bits(*before.values(*spec), *state.values(*spec))) << spec->name;
    }
  });
}

TEST(EveryStage, NeedsTheInputsItDeclaresAndOnlyThose) {
  on_every_stage([](const Stage& stage, const State& before) {
    const StageInfo& info = stage.info();
    for (const FieldSpec* spec : info.reads) {
      if (lists(info.writes, *spec) && !info.own_grid) continue;  // there all the same, as zeros
      State state = copy_of(before);
      state.erase(*spec);
      EXPECT_THROW(run(stage, state), Bug) << spec->name;
    }
    State state = copy_of(before);
    for (const FieldSpec* spec : before.present()) {
      if (!lists(info.reads, *spec)) state.erase(*spec);
    }
    EXPECT_NO_THROW(run(stage, state)) << "without its optional inputs";
  });
}

TEST(EveryStage, OwesNothingToOldValuesOfItsOutputs) {
  on_every_stage([](const Stage& stage, const State& before) {
    State clean = copy_of(before), stale = copy_of(before);
    for (const FieldSpec* spec : stage.info().writes) {
      if (lists(stage.info().reads, *spec) || lists(stage.info().optional, *spec)) continue;
      clean.erase(*spec);
      with_type(*spec, [&]<class T>(const Field<T>& typed) {
        const std::span<T> values = stale.update(typed);
        std::fill(values.begin(), values.end(), static_cast<T>(3));
      });
    }
    expect_same_outputs(stage, run(stage, clean), run(stage, stale));
  });
}

TEST(EveryStage, GivesTheSameBitsForTheSameSeedOnAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  on_every_stage([](const Stage& stage, const State& before) {
    State first = copy_of(before);
    omp_set_num_threads(1);
    const State made = run(stage, first);
    for (const int number : {1, 4}) {
      State again = copy_of(before);
      omp_set_num_threads(number);
      SCOPED_TRACE(std::to_string(number) + " threads");
      expect_same_outputs(stage, made, run(stage, again));
    }
  });
  omp_set_num_threads(threads);
}

TEST(EveryStage, StopsWhenAskedTo) {
  on_every_stage([](const Stage& stage, const State& before) {
    State state = copy_of(before);
    const std::atomic<bool> stop = true;
    Context context;
    context.stop = &stop;
    StageIo io(state, stage.info());
    EXPECT_THROW(stage.run(io, context), Interrupted);
  });
}

TEST(TheTableOfStages, IsInOrderAndWiredUp) {
  int number = 0;
  for (const StageEntry& entry : stage_table()) {
    EXPECT_GT(entry.number, number) << entry.name;
    number = entry.number;
    // Runs of parts of a planet leave out the last one.
    const bool is_last = &entry == &stage_table().back();
    EXPECT_EQ(entry.make()->info().own_grid, is_last) << entry.name;
  }
  const Pipeline pipeline = make_pipeline();
  const Grid planet = Grid::sphere(2048, 1024);
  const std::array<const FieldSpec*, 1> given{&field::elevation};
  EXPECT_NO_THROW(pipeline.check(planet, given, 0, static_cast<int>(pipeline.stages().size()) - 1));
  EXPECT_NO_THROW(pipeline.check(planet, {}, 0, static_cast<int>(pipeline.stages().size()) - 1));
  EXPECT_THROW(pipeline.check(planet, {}, pipeline.find("erosion"), pipeline.find("erosion")),
               ConfigurationError);
}

}  // namespace
}  // namespace geo
