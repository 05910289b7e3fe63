#include "geo/io/run/run_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"

namespace geo::io {
namespace {

bool has_choice(Stage& stage, std::string_view key, std::string_view value) {
  for (const Parameter& row : stage.parameters()) {
    if (row.name == key) return row.value() == ParameterValue(std::string(value));
  }
  return false;
}

bool takes_hypsography(Stage& stage) {
  return lists(stage.info().optional, field::ranking) ||
         has_choice(stage, fmt::format("{}.hypsometry", stage.info().name), "rank");
}

}  // namespace

int position_of(const Pipeline& pipeline, const std::string& stage, std::string_view asked_by) {
  const int position = pipeline.find(stage);
  if (position >= 0) return position;
  std::vector<std::string_view> names;
  for (const auto& known : pipeline.stages()) names.push_back(known->info().name);
  throw ConfigurationError(fmt::format("{}: unknown stage {}: must be one of {}{}", asked_by, stage,
                                       fmt::join(names, ", "), suggestion(stage, names)));
}

int first_stage_of_input(const RunConfiguration& run) {
  if (run.settings.dem_file.empty()) return 0;
  const auto& stages = run.pipeline.stages();
  const auto reader = std::find_if(stages.begin(), stages.end(), [](const auto& stage) {
    return lists(stage->info().reads, field::elevation);
  });
  return static_cast<int>(reader - stages.begin());
}

RunPlan plan_run(const RunConfiguration& run, const std::string& from, const std::string& to) {
  RunSettings& settings = run.settings;
  if (!to.empty()) settings.to = to;
  RunPlan plan;
  plan.last = settings.to.empty() ? static_cast<int>(run.pipeline.stages().size()) - 1
                                  : position_of(run.pipeline, settings.to, "run.to");
  const std::string& wanted = from.empty() ? settings.from : from;
  plan.begin =
      wanted.empty() ? first_stage_of_input(run) : position_of(run.pipeline, wanted, "run.from");
  plan.first = plan.begin;
  if (plan.first > plan.last) {
    throw ConfigurationError(fmt::format("run.from = {} comes after run.to = {}: must not",
                                         run.name_of(plan.first), run.name_of(plan.last)));
  }
  return plan;
}

void leave_out_island(RunPlan& plan, const RunConfiguration& run, const Grid& grid) {
  if (plan.last < plan.begin || !run.stage(plan.last).info().own_grid) return;
  if (grid.topology() == Topology::sphere) return;
  const std::string name(run.name_of(plan.last));
  const std::string_view what =
      grid.topology() == Topology::torus ? "a torus is none" : "the DEM covers a part of one";
  if (run.settings.to == name || plan.last == plan.begin) {
    throw ConfigurationError(fmt::format("stage {} needs a whole planet: {}", name, what));
  }
  --plan.last;
  plan.note = fmt::format("no {}: it needs a whole planet, {}", name, what);
}

bool is_still_read(const Pipeline& pipeline, const RunPlan& plan, const FieldSpec& spec) {
  for (int at = plan.first; at <= plan.last; ++at) {
    const StageInfo& info = pipeline.stages()[at]->info();
    if (lists(info.reads, spec) || lists(info.optional, spec)) return true;
  }
  return false;
}

bool needs_elevation(const Pipeline& pipeline, const RunPlan& plan) {
  for (int at = plan.first; at <= plan.last; ++at) {
    const StageInfo& info = pipeline.stages()[at]->info();
    if (lists(info.reads, field::elevation)) return true;
    if (lists(info.writes, field::elevation)) return false;
  }
  return false;
}

bool events_are_felt(const RunConfiguration& run, const RunPlan& plan) {
  const auto& events = run.settings.events;
  if (std::all_of(events.begin(), events.end(), [](const Event& e) { return e.is_of_plates(); })) {
    return true;
  }
  for (int at = plan.begin; at <= plan.last; ++at) {
    const StageInfo& info = run.stage(at).info();
    if (info.feels_events && lists(info.writes, field::elevation)) return true;
  }
  return false;
}

bool follows_hypsography(const RunConfiguration& run, const RunPlan& plan) {
  for (int at = plan.begin; at <= plan.last; ++at) {
    if (takes_hypsography(run.stage(at))) return true;
  }
  return false;
}

std::vector<std::string> given_fields_of(const RunConfiguration& run, int position) {
  Stage& stage = run.stage(position);
  const StageInfo& info = stage.info();
  std::vector<std::string> keys;
  const auto takes = [&](const FieldSpec& spec) {
    return lists(info.reads, spec) || lists(info.optional, spec);
  };
  if (takes(field::erodibility)) keys.emplace_back("fields.erodibility");
  if (takes(field::uplift_rate)) keys.emplace_back("fields.uplift_rate");
  if (takes(field::ranking)) keys.emplace_back("fields.ranking");
  if (takes_hypsography(stage)) {
    keys.insert(keys.end(), {"fields.hypsography", "fields.hypsography_ocean"});
  }
  if (position == 0) {
    keys.insert(keys.end(),
                {"fields.plates", "fields.plate_rotations", "fields.rotations_age_myr",
                 "fields.initial_elevation", "fields.initial_age", "fields.start_frame"});
  }
  if (has_choice(stage, fmt::format("{}.detail", info.name), "exemplars")) {
    keys.emplace_back("fields.exemplars");
  }
  return keys;
}

}  // namespace geo::io
