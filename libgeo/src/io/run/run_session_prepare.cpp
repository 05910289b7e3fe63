// The half of a run session that only looks: plan, folder, what earlier stages left, inputs.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/io/run/run_session.hpp"

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

}  // namespace

RunSession::RunSession(RunConfiguration run, std::vector<int> numbers, RunRequest request)
    : run_(run),
      numbers_(std::move(numbers)),
      request_(std::move(request)),
      folder_(request_.folder) {}

std::filesystem::path RunSession::file_of(int position, std::string_view extension) const {
  return folder_.stage_file(numbers_[position], run_.name_of(position), extension);
}

std::string RunSession::resolved_config() const {
  return write_config(run_.parameters,
                      fmt::format("terrane {}: every parameter as it was used. Runs again with: "
                                  "terrane run config.toml",
                                  build_info().version),
                      run_.settings.events);
}

void RunSession::prepare() {
  now_or_given();  // refuses a bad SOURCE_DATE_EPOCH
  if (!run_.settings.grid_is_automatic()) parse_grid_size(run_.settings.grid);
  (void)run_.settings.map_view();  // refuses a centre that the projection cannot have
  plan_ = plan_run(run_, request_.from, request_.to);
  look_at_folder();
  inputs_ = read_inputs(run_, plan_, load_complete_stages(), [this](const Grid& grid) {
    folder_.check_writable(prediction_on(static_cast<double>(grid.size()), {}).disk_bytes);
  });
  run_.pipeline.check(inputs_.state->present(), plan_.first, plan_.last);
  config_ = resolved_config();
}

void RunSession::look_at_folder() {
  if (folder_.path().empty()) throw ConfigurationError("-o \"\": must name a folder");
  const std::string shown = folder_.path().string();
  if (request_.resume && request_.overwrite) {
    throw ConfigurationError("--resume and --overwrite exclude each other: choose one");
  }
  const bool held = folder_.holds_run();
  if (held && !request_.resume && !request_.overwrite) {
    throw ConfigurationError(fmt::format(
        "{} already holds a run: --resume goes on with it, --overwrite replaces it", shown));
  }
  const bool known = held && std::filesystem::exists(folder_.config());
  if (request_.resume && !known) {
    throw ConfigurationError(fmt::format("--resume: {} holds no run to go on with", shown));
  }
  if (known && (request_.resume || !request_.from.empty())) {
    const std::string before = read_text(folder_.config());
    if (std::filesystem::exists(folder_.manifest())) {
      manifest_ = read_manifest(folder_.manifest());
    }
    if (request_.resume) return go_on_from(before);
    const std::string old_from = configured_text(before, "run.from");
    const int old_begin =
        old_from.empty() ? first_stage_of_input(run_) : run_.pipeline.find(old_from);
    if (old_begin >= 0 && old_begin < plan_.first) return keep_earlier_stages(before, old_begin);
    manifest_ = {};
  }
  if (!request_.from.empty()) run_.settings.from = request_.from;
}

void RunSession::take_open_settings(const std::string& before) {
  if (run_.settings.grid_is_automatic()) run_.settings.grid = configured_text(before, "run.grid");
  if (run_.settings.dem_variable.empty()) {
    run_.settings.dem_variable = configured_text(before, "dem.variable");
  }
}

void RunSession::go_on_from(const std::string& before) {
  manifest_.check_builders("--resume", folder_.path(), request_.allow_other_build,
                           "--overwrite computes all again");
  take_open_settings(before);
  const std::string old_to = configured_text(before, "run.to");
  const bool as_far_as_before = request_.to.empty() && run_.settings.to == old_to;
  if (request_.folders_configuration && manifest_.complete && as_far_as_before) {
    run_.settings.to.clear();
    plan_.last = static_cast<int>(run_.pipeline.stages().size()) - 1;
  }
  if (!request_.from.empty()) run_.settings.from = request_.from;
  const auto difference = first_difference(before, resolved_config(), {}, kFreeOnResume);
  if (!difference.empty()) {
    throw ConfigurationError(
        fmt::format("--resume: the configuration changed: {}; --overwrite computes {} again",
                    difference, folder_.path().string()));
  }
  plan_.first = plan_.begin + count_complete_stages();
  if (plan_.first > plan_.last + 1) run_.settings.to = old_to;  // the stages behind it stay
}

void RunSession::keep_earlier_stages(const std::string& before, int old_begin) {
  manifest_.check_builders("--from " + std::string(run_.name_of(plan_.first)), folder_.path(),
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
      first_difference(before, resolved_config(), sections, kFreeOnPartialOverwrite);
  if (!difference.empty()) {
    throw ConfigurationError(
        fmt::format("--from {}: the stages before it would not be the same: {}; --overwrite "
                    "without --from computes all again",
                    run_.name_of(plan_.first), difference));
  }
  const int complete = count_complete_stages();
  if (plan_.begin + complete < plan_.first) {
    throw ConfigurationError(fmt::format("--from {}: {} holds no complete {} to start from",
                                         run_.name_of(plan_.first), folder_.path().string(),
                                         run_.name_of(plan_.begin + complete)));
  }
}

int RunSession::count_complete_stages() const {
  const int most = static_cast<int>(run_.pipeline.stages().size());
  int at = plan_.begin;
  while (at < most && is_complete(at)) ++at;
  return at - plan_.begin;
}

/// A file that is not there or cannot be read is computed again; one whose values somebody changed
/// is refused.
bool RunSession::is_complete(int position) const {
  const auto record = std::find_if(
      manifest_.stages.begin(), manifest_.stages.end(), [&](const StageRecord& candidate) {
        return candidate.name == run_.name_of(position) && !candidate.on_command;
      });
  if (record == manifest_.stages.end()) return false;
  const Standing standing = standing_of(folder_.path(), *record);
  if (!standing.difference.empty()) {
    throw InputError(
        fmt::format("{}: is not what manifest.json says: {}; without the file it is computed anew",
                    file_of(position, ".nc").string(), standing.difference));
  }
  return standing.fault.empty();
}

/// What they left that stages ahead still read.
std::optional<State> RunSession::load_complete_stages() const {
  std::optional<State> state;
  for (int at = plan_.begin; at < plan_.first; ++at) {
    if (run_.stage(at).info().own_grid) continue;
    const Snapshot snapshot = read_netcdf(file_of(at, ".nc"));
    if (!state) state.emplace(snapshot.grid);
    for (const auto& [spec, values] : snapshot.fields) {
      if (is_still_read(run_.pipeline, plan_, *spec)) state->set(*spec, *values);
    }
  }
  return state;
}

Prediction RunSession::prediction_on(double cells, const MachineSpeed& speed) const {
  const RunSettings& settings = run_.settings;
  const double map_width_px = settings.maps ? static_cast<double>(settings.map_width_px) : 0.0;
  const double vtk_share = share_of_vtk(static_cast<int>(settings.vtk_compression));
  const auto predicted = [&](bool vtk) {
    return predict(run_.pipeline, plan_.first, plan_.last, cells, speed, vtk ? vtk_share : 0.0,
                   map_width_px);
  };
  Prediction sum = predicted(settings.vtk);
  if (settings.globe) {
    constexpr double kSurface_bytes = 36.0;  // of a cell: corners and faces
    sum.disk_bytes += predicted(true).disk_bytes - predicted(false).disk_bytes +
                      vtk_share * kSurface_bytes * cells * (plan_.last - plan_.first + 1);
  }
  return sum;
}

std::vector<std::string_view> RunSession::stages_to_run() const {
  std::vector<std::string_view> names;
  for (int at = plan_.first; at <= plan_.last; ++at) names.push_back(run_.name_of(at));
  return names;
}

}  // namespace geo::io
