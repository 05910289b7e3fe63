// The half of a run session that computes and writes.
#include "geo/io/run/run_session.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/background_writer.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/run/island_session.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "io/netcdf/frame_files.hpp"
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

/// A table as comma-separated values with a line of names.
std::string text_of(const StepTable& steps) {
  std::string text = fmt::format("{}\n", fmt::join(steps.columns, ","));
  for (const auto& row : steps.rows) {
    for (std::size_t k = 0; k < steps.columns.size(); ++k) {
      if (k > 0) text += ',';
      if (k < row.size() && std::isfinite(row[k])) text += fmt::format("{}", row[k]);
    }
    text += '\n';
  }
  return text;
}

std::string text_of(const TextTable& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (const auto& row : table.rows) text += fmt::format("{}\n", fmt::join(row, ","));
  return text;
}

/// One background job: the files of a stage, then its entry in the manifest.
struct StageJob {
  Snapshot snapshot;
  Provenance provenance;
  std::filesystem::path netcdf, vti, csv;
  StepTable steps;
  std::vector<TextTable> tables;
  StageRecord record;

  void write(const RunSettings& settings) {
    write_netcdf(netcdf, snapshot, provenance, static_cast<int>(settings.compression));
    const auto folder = netcdf.parent_path();
    record.list(folder, netcdf.filename().string());
    if (settings.vtk) {
      write_vti(vti, snapshot, provenance, static_cast<int>(settings.vtk_compression));
      record.list(folder, vti.filename().string());
    }
    if (!steps.rows.empty()) write_table(csv, text_of(steps));
    for (const TextTable& table : tables) {
      write_table(csv.parent_path() / fmt::format("{}-{}.csv", csv.stem().string(), table.name),
                  text_of(table));
    }
    for (const auto& [spec, values] : snapshot.fields) {
      record.fields.push_back(summarise(*spec, *values, *snapshot.grid));
    }
  }
  void write_table(const std::filesystem::path& path, const std::string& text) {
    write_text_file(path, text);
    record.list(path.parent_path(), path.filename().string());
  }
};

}  // namespace

/// An island that was made by command and has the name of the run's own becomes a further one. Its
/// files have both names until the manifest knows the new one.
void RunSession::name_islands_anew() {
  const std::string_view own = run_.name_of(plan_.first);
  for (StageRecord& record : manifest_.stages) {
    if (!record.on_command || record.name != own) continue;
    record.name = manifest_.free_name(own, 2);
    const auto digests = std::exchange(record.file_digests, {});
    for (std::string& file : record.files) {
      const std::string before = file;
      const auto extension = std::filesystem::path(before).extension().string();
      const auto path = folder_.stage_file(numbers_[plan_.first], record.name, extension);
      file = path.filename().string();
      if (std::filesystem::exists(folder_.path() / before)) {
        copy_whole_file(folder_.path() / before, path);
      }
      if (const auto known = digests.find(before); known != digests.end()) {
        record.file_digests[file] = known->second;
      }
    }
  }
}

void RunSession::clear_for_this_run() {
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
  manifest_.complete = false;
  manifest_.files.clear();
  // From here on no stage that is about to be replaced counts as complete.
  const bool planet_stays = run_.pipeline.stages()[plan_.first]->info().own_grid;
  if (planet_stays) name_islands_anew();
  std::erase_if(manifest_.stages, [&](const StageRecord& record) {
    if (record.on_command) return !planet_stays;
    const int at = run_.pipeline.find(record.name);
    return at < plan_.begin || at >= plan_.first;
  });
  write_manifest(folder_.manifest(), manifest_);
  for (int at = 0; at < static_cast<int>(run_.pipeline.stages().size()); ++at) {
    if (at < plan_.begin || at >= plan_.first) folder_.remove_stage(numbers_[at], run_.name_of(at));
  }
  if (!planet_stays) folder_.remove_further_islands();
  folder_.remove_summaries();
  write_text_file(folder_.config(), config_);
}

Provenance RunSession::provenance_of(int position) const {
  const auto& build = build_info();
  return {.title = fmt::format("terrane: {}", run_.name_of(position)),
          .config_toml = config_,
          .seed = static_cast<std::uint64_t>(run_.settings.seed),
          .version = build.version,
          .history = fmt::format("{:%Y-%m-%dT%H:%M:%SZ} terrane {} ({}): stage {}",
                                 fmt::gmtime(now_or_given()), build.version, build.commit,
                                 run_.name_of(position)),
          .references = references_of(position)};
}

std::string RunSession::references_of(int position) const {
  std::vector<std::string_view> sources;
  for (const Parameter& parameter : run_.parameters) {
    const std::string prefix = fmt::format("{}.", run_.name_of(position));
    if (!parameter.name.starts_with(prefix) || parameter.source == "design") continue;
    if (std::find(sources.begin(), sources.end(), parameter.source) == sources.end()) {
      sources.push_back(parameter.source);
    }
  }
  std::sort(sources.begin(), sources.end());
  return fmt::format("docs/references.bib: {}", fmt::join(sources, ", "));
}

void RunSession::write_stage(BackgroundWriter& writer, FrameFiles& frames, int position,
                             const State& state, const Context& context, double seconds) {
  auto job = std::make_shared<StageJob>();
  job->snapshot.stage = run_.name_of(position);
  job->snapshot.grid = state.shared_grid();
  const auto& written = run_.stage(position).info().writes;
  for (const FieldSpec* spec : written) {
    job->snapshot.fields.emplace_back(spec, state.values(*spec));
  }
  const bool makes_months =
      std::find(written.begin(), written.end(), &field::temperature) != written.end() &&
      !run_.stage(position).info().own_grid;
  if (run_.settings.monthly && makes_months) job->snapshot.months = context.monthly_fields;
  job->provenance = provenance_of(position);
  job->netcdf = file_of(position, ".nc");
  job->vti = file_of(position, ".vti");
  job->csv = file_of(position, ".csv");
  job->steps = context.steps;
  job->tables = context.tables;
  job->record.name = run_.name_of(position);
  job->record.own_grid = run_.stage(position).info().own_grid;
  job->record.builder = this_builder();
  job->record.seconds = time_is_given() ? 0.0 : seconds;
  job->record.budget = context.budget;
  job->record.events = context.event_records;
  job->record.warnings = context.warnings;
  writer.submit([this, job, &frames] {
    job->write(run_.settings);
    for (const std::string& name : frames.take_written()) job->record.list(folder_.path(), name);
    manifest_.stages.push_back(job->record);
    write_manifest(folder_.manifest(), manifest_);
    job->snapshot.fields.clear();
    job->snapshot.months = {};
  });
}

/// Of the planet, fields that no later stage writes again and that cost no memory while stages
/// still shape the relief, which is when runs are largest: later stages read them too.
void RunSession::keep_for_pictures(int position, const State& state) {
  const StageInfo& info = run_.stage(position).info();
  if (info.own_grid) return at_hand_.keep_island(std::string(info.name), state);
  const auto lists = [](const std::vector<const FieldSpec*>& specs, const FieldSpec* spec) {
    return std::find(specs.begin(), specs.end(), spec) != specs.end();
  };
  std::vector<const FieldSpec*> fields;
  for (const FieldSpec* spec : info.writes) {
    bool is_last = true, relief_changes = false, stays = false;
    for (int at = position + 1; at <= plan_.last; ++at) {
      const StageInfo& later = run_.stage(at).info();
      stays = stays || lists(later.reads, spec) || lists(later.optional, spec);
      if (later.own_grid) continue;
      is_last = is_last && !lists(later.writes, spec);
      if (lists(later.writes, &field::elevation)) relief_changes = true, stays = false;
    }
    if (is_last && (stays || !relief_changes)) fields.push_back(spec);
  }
  at_hand_.keep_planet(state, fields);
}

void RunSession::execute(const RunEvents& events) {
  if (plan_.first <= plan_.last) {
    clear_for_this_run();
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
  BackgroundWriter writer;
  int running = plan_.first;
  context.on_frame = [&](Frame frame) {
    frames.write(writer, run_.name_of(running), std::move(frame), provenance_of(running));
  };
  Clock::time_point start;
  Pipeline::Observer observer;
  observer.before = [&](int position) {
    tell(events.stage_begins, run_.name_of(position), static_cast<double>(grid().size()));
    context.warnings.clear();
    running = position;
    start = Clock::now();
  };
  observer.after = [&](int position, const State& state, const Context& told) {
    const double seconds = seconds_since(start);
    for (const std::string& warning : told.warnings) tell(events.warning, warning);
    write_stage(writer, frames, position, state, told, seconds);
    if (run_.settings.maps) keep_for_pictures(position, state);
    tell(events.stage_ends, run_.name_of(position), seconds);
  };
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
    draw_run(folder_, run_.settings.map_view(), {}, at_hand_);
    tell(events.stage_ends, "maps", seconds_since(start));
  }
  check_stop();
  manifest_.files = digests_of_summaries(folder_);
  manifest_.complete = true;
  write_manifest(folder_.manifest(), manifest_);
}

}  // namespace geo::io
