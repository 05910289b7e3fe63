#include "geo/io/run/run_resume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/recorded_file.hpp"

namespace geo::io {
namespace {

// What may differ between a run and its continuation: how far it goes and what else is written.
constexpr std::string_view kFreeOnResume[] = {"run.to",
                                              "output.vtk",
                                              "output.globe",
                                              "output.globe_exaggeration",
                                              "output.maps",
                                              "output.map_width_px",
                                              "output.map_projection",
                                              "output.map_center",
                                              "output.compression",
                                              "output.vtk_compression"};
// The same where stages are computed again behind others that stay.
constexpr std::string_view kFreeOnPartialOverwrite[] = {"run.from", "run.to"};

/// One run that looks at its folder.
class Settling {
 public:
  Settling(const StageFolder& at, const RunRequest& request, RunPlan& plan)
      : at_(at), run_(at.run), request_(request), plan_(plan) {}

  Manifest settle() {
    if (at_.folder.path().empty()) throw ConfigurationError("-o \"\": must name a folder");
    const std::string shown = at_.folder.path().string();
    if (request_.resume && request_.overwrite) {
      throw ConfigurationError("--resume and --overwrite exclude each other: choose one");
    }
    const bool held = at_.folder.holds_run();
    if (held && !request_.resume && !request_.overwrite) {
      throw ConfigurationError(fmt::format(
          "{} already holds a run: --resume goes on with it, --overwrite replaces it", shown));
    }
    const bool known = held && std::filesystem::exists(at_.folder.config());
    if (request_.resume && !known) {
      throw ConfigurationError(fmt::format("--resume: {} holds no run to go on with", shown));
    }
    if (known && (request_.resume || !request_.from.empty())) {
      const std::string before = read_text(at_.folder.config());
      if (std::filesystem::exists(at_.folder.manifest())) {
        manifest_ = read_manifest(at_.folder.manifest());
      }
      if (request_.resume) {
        go_on_from(before);
        return std::move(manifest_);
      }
      const std::string old_from = configured_text(before, "run.from");
      const int old_begin =
          old_from.empty() ? first_stage_of_input(run_) : run_.pipeline.find(old_from);
      if (old_begin >= 0 && old_begin < plan_.first) {
        keep_earlier_stages(before, old_begin);
        return std::move(manifest_);
      }
    }
    if (!request_.from.empty()) run_.settings.from = request_.from;
    return {};
  }

 private:
  /// A file that is not there or cannot be read is computed again; one whose values somebody
  /// changed is refused.
  bool is_complete(int position) const {
    const auto record = std::find_if(
        manifest_.stages.begin(), manifest_.stages.end(), [&](const StageRecord& candidate) {
          return candidate.name == run_.name_of(position) && !candidate.on_command;
        });
    if (record == manifest_.stages.end()) return false;
    const Standing standing = standing_of(at_.folder.path(), *record);
    if (!standing.difference.empty()) {
      throw InputError(fmt::format(
          "{}: is not what manifest.json says: {}; without the file it is computed anew",
          at_.file_of(position, ".nc").string(), standing.difference));
    }
    return standing.fault.empty();
  }

  int count_complete_stages() const {
    const int most = static_cast<int>(run_.pipeline.stages().size());
    int at = plan_.begin;
    while (at < most && is_complete(at)) ++at;
    return at - plan_.begin;
  }

  void take_open_settings(const std::string& before) {
    if (run_.settings.grid_is_automatic()) run_.settings.grid = configured_text(before, "run.grid");
    if (run_.settings.dem_variable.empty()) {
      run_.settings.dem_variable = configured_text(before, "dem.variable");
    }
  }

  void go_on_from(const std::string& before) {
    manifest_.check_builders("--resume", at_.folder.path(), request_.allow_other_build,
                             "--overwrite computes all again");
    take_open_settings(before);
    const std::string old_to = configured_text(before, "run.to");
    const bool as_far_as_before = request_.to.empty() && run_.settings.to == old_to;
    if (request_.folders_configuration && manifest_.complete && as_far_as_before) {
      run_.settings.to.clear();
      plan_.last = static_cast<int>(run_.pipeline.stages().size()) - 1;
    }
    if (!request_.from.empty()) run_.settings.from = request_.from;
    const auto difference = first_difference(before, resolved_config(run_), {}, kFreeOnResume);
    if (!difference.empty()) {
      throw ConfigurationError(
          fmt::format("--resume: the configuration changed: {}; --overwrite computes {} again",
                      difference, at_.folder.path().string()));
    }
    plan_.first = plan_.begin + count_complete_stages();
    if (plan_.first > plan_.last + 1) run_.settings.to = old_to;  // the stages behind it stay
  }

  void keep_earlier_stages(const std::string& before, int old_begin) {
    manifest_.check_builders("--from " + std::string(run_.name_of(plan_.first)), at_.folder.path(),
                             request_.allow_other_build, "--overwrite computes all again");
    plan_.begin = old_begin;
    run_.settings.from = configured_text(before, "run.from");
    take_open_settings(before);
    std::vector<std::string> sections{"run", "dem", "planet"};
    for (int at = plan_.begin; at < plan_.first; ++at) {
      sections.emplace_back(run_.name_of(at));
      for (std::string& key : given_fields_of(run_, at)) {
        sections.push_back(std::move(key));
      }
      if (run_.stage(at).info().feels_events) sections.emplace_back("event");
    }
    // The sea of all stages may be the hypsography's, whichever of them follows it.
    if (follows_hypsography(run_, plan_)) {
      sections.insert(sections.end(), {"fields.hypsography", "fields.hypsography_ocean"});
    }
    const auto difference =
        first_difference(before, resolved_config(run_), sections, kFreeOnPartialOverwrite);
    if (!difference.empty()) {
      throw ConfigurationError(
          fmt::format("--from {}: the stages before it would not be the same: {}; --overwrite "
                      "without --from computes all again",
                      run_.name_of(plan_.first), difference));
    }
    const int complete = count_complete_stages();
    if (plan_.begin + complete < plan_.first) {
      throw ConfigurationError(fmt::format("--from {}: {} holds no complete {} to start from",
                                           run_.name_of(plan_.first), at_.folder.path().string(),
                                           run_.name_of(plan_.begin + complete)));
    }
  }

  const StageFolder& at_;
  const RunConfiguration& run_;
  const RunRequest& request_;
  RunPlan& plan_;
  Manifest manifest_;  // of the earlier run
};

}  // namespace

std::string resolved_config(const RunConfiguration& run) {
  return write_config(run.parameters,
                      fmt::format("terrane {}: every parameter as it was used. Runs again with: "
                                  "terrane run config.toml",
                                  build_info().version),
                      run.settings.events);
}

Manifest settle_in_folder(const StageFolder& at, const RunRequest& request, RunPlan& plan) {
  return Settling(at, request, plan).settle();
}

std::optional<State> read_complete_stages(const StageFolder& at, const RunPlan& plan) {
  std::optional<State> state;
  for (int k = plan.begin; k < plan.first; ++k) {
    if (at.run.stage(k).info().own_grid) continue;
    const Snapshot snapshot = read_netcdf(at.file_of(k, ".nc"));
    if (!state) state.emplace(snapshot.grid);
    for (const auto& [spec, values] : snapshot.fields) {
      if (is_still_read(at.run.pipeline, plan, *spec)) state->set(*spec, *values);
    }
  }
  return state;
}

}  // namespace geo::io
