#include "geo/io/run/run_session.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/drawing/map_view.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/background_writer.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/run/island_session.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "io/netcdf/frame_files.hpp"
#include "io/run/parked_fields.hpp"
#include "io/run/run_clearing.hpp"
#include "io/run/stage_job.hpp"
#include "io/vtk/globe_files.hpp"

namespace geo::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class Function, class... Arguments>
void tell(const Function& function, Arguments&&... arguments) {
  if (function) function(std::forward<Arguments>(arguments)...);
}

}  // namespace

RunSession::RunSession(RunConfiguration run, std::vector<int> numbers, RunRequest request)
    : run_(run),
      numbers_(std::move(numbers)),
      request_(std::move(request)),
      folder_(request_.folder) {}

void RunSession::prepare() {
  now_or_given();  // refuses a bad SOURCE_DATE_EPOCH
  if (!run_.settings.grid_is_automatic()) parse_grid_size(run_.settings.grid);
  (void)run_.settings.map_view();  // refuses a centre that the projection cannot have
  plan_ = plan_run(run_, request_.from, request_.to);
  manifest_ = settle_in_folder(stage_folder(), request_, plan_);
  inputs_ = read_inputs(
      run_, plan_, read_complete_stages(stage_folder(), plan_), [this](const Grid& grid) {
        folder_.check_writable(prediction_on(static_cast<double>(grid.size()), {}).disk_bytes);
      });
  run_.pipeline.check(inputs_.state->grid(), inputs_.state->present(), plan_.first, plan_.last);
  config_ = resolved_config(run_);
}

std::vector<std::string_view> RunSession::stages_to_run() const {
  std::vector<std::string_view> names;
  for (int at = plan_.first; at <= plan_.last; ++at) names.push_back(run_.name_of(at));
  return names;
}

/// From here on the manifest is this run's.
void RunSession::open_folder() {
  folder_.open();
  const auto& build = build_info();
  manifest_.version = build.version;
  manifest_.commit = build.commit;
  manifest_.compiler = build.compiler;
  manifest_.build = build.id;
  manifest_.libraries = library_versions();
  manifest_.seed = static_cast<std::uint64_t>(run_.settings.seed);
  manifest_.threads = request_.threads;
  manifest_.config_digest = digest_of(config_);
  clear_for_run(stage_folder(), plan_, manifest_);
  write_text_file(folder_.config(), config_);
}

void RunSession::write_stage(BackgroundWriter& writer, FrameFiles& frames, ParkedFields& parked,
                             int position, const State& state, const Context& context,
                             double seconds) {
  auto job = std::make_shared<StageJob>(
      job_of(stage_folder(), position, config_, state, context, seconds));
  const StageInfo& info = run_.stage(position).info();
  if (!info.own_grid) parked.add({job, &job->record}, info.writes);
  writer.submit([this, job, &frames] {
    job->write(run_.settings);
    for (const std::string& name : frames.take_written()) job->record.list(folder_.path(), name);
    manifest_.stages.push_back(job->record);
    write_manifest(folder_.manifest(), manifest_);
    job->snapshot.fields.clear();
    job->snapshot.months = {};
  });
}

/// Of the planet what stages make once elevation changes no more, after which runs take less
/// memory; and what is there at the end.
void RunSession::keep_for_pictures(int position, const State& state) {
  const StageInfo& info = run_.stage(position).info();
  if (info.own_grid) {
    at_hand_.keep_island(std::string(info.name), state);
  } else {
    const auto writes_later = [&](const FieldSpec& spec) {
      for (int at = position + 1; at <= plan_.last; ++at) {
        const StageInfo& later = run_.stage(at).info();
        if (!later.own_grid && lists(later.writes, spec)) return true;
      }
      return false;
    };
    if (!writes_later(field::elevation)) {
      std::vector<const FieldSpec*> fields = info.writes;
      std::erase_if(fields, [&](const FieldSpec* spec) { return writes_later(*spec); });
      at_hand_.keep_planet(state, fields);
    }
  }
  if (position == plan_.last) {
    at_hand_.keep_planet(*inputs_.state, inputs_.state->present());
  }
}

void RunSession::execute(const RunEvents& events) {
  if (plan_.first <= plan_.last) {
    open_folder();
    compute(events);
  } else {
    folder_.open();
    manifest_.config_digest = digest_of(config_);
    write_text_file(folder_.config(), config_);
    tell(events.info, "all stages are complete: only the pictures are drawn again");
  }
  inputs_.state.reset();
  if (!plan_.note.empty()) tell(events.info, plan_.note);
  if (!events_are_felt(run_, plan_)) {
    tell(events.warning, "events change elevation in stage erosion, which this run leaves out");
  }
  write_summaries(events);
}

void RunSession::compute(const RunEvents& events) {
  find_exemplars(inputs_, run_, plan_);
  for (const std::string& warning : inputs_.warnings) tell(events.warning, warning);
  Context context = context_of(inputs_, run_, plan_);
  context.on_progress = events.progress;
  context.stop = events.stop;

  FrameFiles frames(folder_.path(), run_.settings);
  ParkedFields parked(folder_.path(), manifest_.stages, *inputs_.state);
  BackgroundWriter writer;
  int running = plan_.first;
  context.on_frame = [&](Frame frame) {
    frames.write(writer, run_.name_of(running), std::move(frame),
                 provenance_of(run_, running, config_));
  };
  Clock::time_point start;
  Pipeline::Observer observer;
  observer.before = [&](int position) {
    // Of the stages before, the last alone may still hold its fields for its files.
    writer.wait_until_left(1);
    tell(events.stage_begins, run_.name_of(position), static_cast<double>(grid().size()));
    context.warnings.clear();
    running = position;
    start = Clock::now();
  };
  observer.after = [&](int position, const State& state, const Context& told) {
    const double seconds = seconds_since(start);
    for (const std::string& warning : told.warnings) tell(events.warning, warning);
    write_stage(writer, frames, parked, position, state, told, seconds);
    if (run_.settings.maps) keep_for_pictures(position, state);
    tell(events.stage_ends, run_.name_of(position), seconds);
  };
  observer.can_park = [&](const FieldSpec& spec) { return parked.has(spec); };
  observer.fetch = [&](const FieldSpec& spec, State& state) { parked.fetch(spec, state); };
  try {
    run_.pipeline.run(*inputs_.state, context, plan_.first, plan_.last, observer);
  } catch (const Interrupted&) {
    writer.wait();  // what was computed is kept
    throw;
  }
  writer.wait();
}

/// planet.pvd, island.pvd and what they list; stages that were run without VTK files get theirs
/// now.
void RunSession::write_collections() {
  for (StageRecord& record : manifest_.stages) {
    const auto netcdf = folder_.path() / netcdf_of(record);
    const auto vti = std::filesystem::path(netcdf).replace_extension(".vti");
    if (!std::filesystem::exists(vti)) {
      const auto all = [](const FieldSpec&) { return true; };
      write_vti(vti, read_recorded(folder_.path(), record, all), read_provenance(netcdf),
                static_cast<int>(run_.settings.vtk_compression));
    }
    record.list(folder_.path(), vti.filename().string());
  }
  write_collection_files(folder_, manifest_);
}

void RunSession::write_summaries(const RunEvents& events) {
  const auto check_stop = [&] {
    if (events.stop != nullptr && events.stop->load()) throw Interrupted();
  };
  check_stop();
  if (run_.settings.vtk) write_collections();
  if (run_.settings.globe &&
      !write_globe_files(folder_, manifest_, run_.settings.globe_exaggeration,
                         static_cast<int>(run_.settings.vtk_compression))) {
    tell(events.warning, "output.globe: the run covers a part of a planet, there is no globe");
  }
  if (run_.settings.maps) {
    tell(events.stage_begins, "maps", static_cast<double>(run_.settings.map_width_px));
    const auto start = Clock::now();
    draw_run(folder_, run_.settings.map_view(), {}, std::move(at_hand_));
    tell(events.stage_ends, "maps", seconds_since(start));
  }
  check_stop();
  manifest_.files = digests_of_summaries(folder_);
  manifest_.complete = true;
  write_manifest(folder_.manifest(), manifest_);
}

}  // namespace geo::io
