#include "geo/io/run/memory_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/drawing/map_view.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/run/run_inputs.hpp"

namespace geo::io {
namespace {

using Clock = std::chrono::steady_clock;

template <class Function, class... Arguments>
void tell(const Function& function, Arguments&&... arguments) {
  if (function) function(std::forward<Arguments>(arguments)...);
}

/// Runs the plan's stages on the inputs and gathers what they write.
std::vector<StageInMemory> compute(const RunConfiguration& run, const RunPlan& plan,
                                   RunInputs inputs, const RunEvents& events) {
  find_exemplars(inputs, run, plan);
  for (const std::string& warning : inputs.warnings) tell(events.warning, warning);
  Context context = context_of(inputs, run, plan);
  context.on_progress = events.progress;
  context.stop = events.stop;
  State& state = *inputs.state;
  const auto cells = static_cast<double>(state.grid().size());
  std::vector<StageInMemory> made;
  Clock::time_point start;
  Pipeline::Observer observer;
  observer.before = [&](int position) {
    tell(events.stage_begins, run.name_of(position), cells);
    context.warnings.clear();
    start = Clock::now();
  };
  observer.after = [&](int position, const State& result, const Context& told) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    StageInMemory stage{.snapshot = {.stage = std::string(run.name_of(position)),
                                     .grid = result.shared_grid(),
                                     .fields = {}},
                        .seconds = seconds,
                        .budget = told.budget,
                        .steps = told.steps,
                        .tables = told.tables,
                        .events = told.event_records,
                        .warnings = told.warnings};
    for (const FieldSpec* spec : run.stage(position).info().writes) {
      stage.snapshot.fields.emplace_back(spec, result.values(*spec));
    }
    made.push_back(std::move(stage));
    for (const std::string& warning : told.warnings) tell(events.warning, warning);
    tell(events.stage_ends, run.name_of(position), seconds);
  };
  run.pipeline.run(state, context, plan.first, plan.last, observer);
  return made;
}

/// The fields of a planet's stages that one stage reads; of several the last.
State state_for(const StageInfo& stage, const std::vector<Snapshot>& planet) {
  const auto is_read = [&](const FieldSpec* spec) {
    return lists(stage.reads, *spec) || lists(stage.optional, *spec);
  };
  std::optional<State> state;
  for (const Snapshot& snapshot : planet) {
    if (!state) state.emplace(snapshot.grid);
    if (snapshot.grid->topology() != state->grid().topology()) continue;  // an island
    for (const auto& [spec, values] : snapshot.fields) {
      if (is_read(spec)) state->share(*spec, values);
    }
  }
  if (!state)
    throw ConfigurationError(fmt::format("{}: no stage of a planet is there", stage.name));
  return std::move(*state);
}

/// What is given of a planet, laid out with the turn of the run.
State laid_out(const State& given, const RunConfiguration& run) {
  const Grid& grid = given.grid();
  const std::string& turn = run.settings.turn;
  if (grid.topology() != Topology::sphere) {
    throw ConfigurationError(
        fmt::format("run.turn = {}: a part of a planet cannot be turned: must be empty", turn));
  }
  State out(std::make_shared<const Grid>(
      Grid::sphere(grid.nx(), grid.ny(), grid.figure(), parse_turn("run.turn", turn))));
  for (const FieldSpec* spec : given.present()) {
    const auto* values = std::get_if<std::vector<float>>(given.values(*spec).get());
    if (values == nullptr) {
      throw ConfigurationError(
          fmt::format("run.turn = {}: {} has no means: must be empty", turn, spec->name));
    }
    const Dem as_given{.elevation_m = *values,
                       .grid = grid,
                       .source = std::string(spec->name),
                       .variable = {},
                       .raster = {},
                       .raster_m = {}};
    out.share(*spec, std::make_shared<const Values>(resample(as_given, out.grid())));
  }
  return out;
}

}  // namespace

std::vector<StageInMemory> run_in_memory(const RunConfiguration& run, const std::string& from,
                                         const std::string& to, const RunEvents& events,
                                         std::optional<State> initial) {
  RunPlan plan = plan_run(run, from, to);
  if (initial && !run.settings.turn.empty()) initial = laid_out(*initial, run);
  RunInputs inputs = read_inputs(run, plan, std::move(initial), {});
  run.pipeline.check(inputs.state->grid(), inputs.state->present(), plan.first, plan.last);
  if (!plan.note.empty()) tell(events.info, plan.note);
  return compute(run, plan, std::move(inputs), events);
}

StageInMemory island_in_memory(const RunConfiguration& run, const std::vector<Snapshot>& planet,
                               const RunEvents& events) {
  const auto stages = run.pipeline.stages();
  const auto own = std::find_if(stages.begin(), stages.end(),
                                [](const auto& stage) { return stage->info().own_grid; });
  const int position = static_cast<int>(own - stages.begin());
  RunInputs inputs;
  inputs.state = state_for((*own)->info(), planet);
  if (inputs.state->grid().topology() != Topology::sphere) {
    throw ConfigurationError(fmt::format("stage {} needs a whole planet", (*own)->info().name));
  }
  run.pipeline.check(inputs.state->grid(), inputs.state->present(), position, position);
  auto made = compute(run, {.begin = position, .first = position, .last = position, .note = {}},
                      std::move(inputs), events);
  return std::move(made.front());
}

}  // namespace geo::io
