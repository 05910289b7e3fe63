#include "geo/core/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace geo {
void Context::advance(double fraction) const {
  if (stop != nullptr && stop->load(std::memory_order_relaxed)) throw Interrupted();
  if (on_progress) on_progress(fraction);
}

void StageIo::check_readable(const FieldSpec& spec) const {
  if (lists(info_.reads, spec) || lists(info_.optional, spec) || lists(info_.writes, spec)) return;
  throw Bug(fmt::format("stage {} reads {} without declaring it", info_.name, spec.name));
}

void StageIo::check_writable(const FieldSpec& spec) const {
  if (lists(info_.writes, spec) && !info_.own_grid) return;
  throw Bug(fmt::format("stage {} writes {} without declaring it", info_.name, spec.name));
}

void StageIo::release(const FieldSpec& spec) {
  check_readable(spec);
  if (lists(info_.writes, spec)) {
    throw Bug(fmt::format("stage {} releases {}, which it writes", info_.name, spec.name));
  }
  if (stays_ && !stays_(spec)) state_.erase(spec);
}

void StageIo::hand_over(State result) {
  for (const FieldSpec* spec : result.present()) {
    if (info_.own_grid && lists(info_.writes, *spec)) continue;
    throw Bug(fmt::format("stage {} hands over {} without declaring it", info_.name, spec->name));
  }
  for (const FieldSpec* spec : info_.writes) {
    if (result.has(*spec)) continue;
    throw Bug(fmt::format("stage {} does not hand over {}", info_.name, spec->name));
  }
  handed_over_ = std::move(result);
}

const State& StageIo::result() const {
  if (!info_.own_grid) return state_;
  if (!handed_over_) throw Bug(fmt::format("stage {} handed nothing over", info_.name));
  return *handed_over_;
}

int Pipeline::find(std::string_view name) const {
  for (std::size_t at = 0; at < stages_.size(); ++at) {
    if (stages_[at]->info().name == name) return static_cast<int>(at);
  }
  return -1;
}

std::vector<Parameter> Pipeline::parameters() const {
  std::vector<Parameter> all;
  for (const auto& stage : stages_) {
    auto own = stage->parameters();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void Pipeline::check(const Grid& grid, std::span<const FieldSpec* const> initial, int first,
                     int last) const {
  std::set<std::string_view> there;
  for (const FieldSpec* spec : initial) there.insert(spec->name);
  for (int at = first; at <= last; ++at) {
    const StageInfo& info = stages_[at]->info();
    for (const FieldSpec* wanted : info.reads) {
      if (there.contains(wanted->name)) continue;
      std::string writers;
      for (const auto& stage : stages_) {
        if (!lists(stage->info().writes, *wanted) || stage->info().name == info.name ||
            stage->info().own_grid) {
          continue;
        }
        writers += fmt::format("{}{}", writers.empty() ? "" : " or ", stage->info().name);
      }
      throw ConfigurationError(
          fmt::format("stage {} needs the field {}, which {}", info.name, wanted->name,
                      writers.empty() ? "no stage writes, so that it must be given"
                                      : "stage " + writers + " writes"));
    }
    stages_[at]->check(grid, [&](const FieldSpec& spec) { return there.contains(spec.name); });
    if (info.own_grid) continue;
    for (const FieldSpec* written : info.writes) there.insert(written->name);
  }
}

int Pipeline::next_reader(const FieldSpec& spec, int at, int last) const {
  for (int later = at + 1; later <= last; ++later) {
    const StageInfo& info = stages_[later]->info();
    if (lists(info.reads, spec) || lists(info.optional, spec)) return later;
    if (!info.own_grid && lists(info.writes, spec)) return kNever;  // made anew
  }
  return kNever;
}

void Pipeline::run(State& state, Context& context, int first, int last,
                   const Observer& observer) const {
  check(state.grid(), state.present(), first, last);
  context.configuration = parameters();
  std::set<const FieldSpec*> parked;
  for (int at = first; at <= last; ++at) {
    const StageInfo& info = stages_[at]->info();
    // Whether a field stays in memory once the stage has done with it; else it is parked, or gone.
    const auto stays = [&](const FieldSpec& spec) {
      const int reader = next_reader(spec, at, last);
      if (reader == kNever) return false;
      if (reader == at + 1 || !observer.can_park || !observer.can_park(spec)) return true;
      parked.insert(&spec);
      return false;
    };
    if (observer.before) observer.before(at);
    std::erase_if(parked, [&](const FieldSpec* spec) {
      if (!lists(info.reads, *spec) && !lists(info.optional, *spec)) return false;
      observer.fetch(*spec, state);
      return true;
    });
    context.budget.clear();
    context.steps = {};
    context.tables.clear();
    context.event_records.clear();
    context.advance(0.0);
    StageIo io(state, info, stays);
    stages_[at]->run(io, context);
    for (const FieldSpec* spec : info.writes) {
      if (!io.result().has(*spec)) {
        throw Bug(fmt::format("stage {} did not write {}", info.name, spec->name));
      }
    }
    context.advance(1.0);
    if (observer.after) observer.after(at, io.result(), context);
    for (const FieldSpec* spec : state.present()) {
      if (!stays(*spec)) state.erase(*spec);
    }
  }
}

}  // namespace geo
