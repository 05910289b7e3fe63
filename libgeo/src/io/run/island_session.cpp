#include "geo/io/run/island_session.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/input/exemplar_files.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/io/run/run_pictures.hpp"

namespace geo::io {
void write_collection_files(const RunFolder& folder, const Manifest& manifest) {
  std::vector<std::filesystem::path> planet, islands;
  for (const StageRecord& record : manifest.stages) {
    const auto netcdf = folder.path() / netcdf_of(record);
    const auto vti = std::filesystem::path(netcdf).replace_extension(".vti");
    if (std::filesystem::exists(vti)) (record.own_grid ? islands : planet).push_back(vti);
  }
  write_pvd(folder.collection(), planet);
  if (!islands.empty()) write_pvd(folder.islands(), islands);
}

IslandSession::IslandSession(const Pipeline& pipeline, int stage_number,
                             const RunSettings& settings, const Planet& planet,
                             std::span<const Parameter> parameters, std::filesystem::path folder)
    : pipeline_(pipeline),
      stage_number_(stage_number),
      settings_(settings),
      planet_(planet),
      parameters_(parameters),
      folder_(std::move(folder)) {}

void IslandSession::prepare(bool allow_other_build) {
  now_or_given();
  const auto& stages = pipeline_.stages();
  const auto island = std::find_if(stages.begin(), stages.end(),
                                   [](const auto& stage) { return stage->info().own_grid; });
  if (island == stages.end()) throw Bug("island: no stage has a grid of its own");
  stage_ = static_cast<int>(island - stages.begin());
  folder_.open();  // nobody else adds to its manifest now
  manifest_ = read_manifest(folder_.manifest());
  manifest_.check_builders(stage_name(), folder_.path(), allow_other_build,
                           "terrane run --overwrite computes the planet again");
  for (const FieldSpec* spec : pipeline_.stages()[stage_]->info().reads) {
    const bool there = std::any_of(
        manifest_.stages.begin(), manifest_.stages.end(), [&](const StageRecord& record) {
          return !record.own_grid &&
                 std::any_of(record.fields.begin(), record.fields.end(),
                             [&](const FieldRecord& field) { return field.name == spec->name; });
        });
    if (there) continue;
    throw ConfigurationError(fmt::format(
        "{} holds no complete planet: {} is missing; terrane run --resume -o {} completes it",
        folder_.path().string(), spec->name, folder_.path().string()));
  }
  folder_.check_writable(0.0);
  if (asks_for_exemplars(parameters_, fmt::format("{}.detail", stage_name())))
    exemplars_ = exemplars_of(settings_.exemplars, planet_);
}

std::string_view IslandSession::stage_name() const {
  return pipeline_.stages()[stage_]->info().name;
}

State IslandSession::read_planet() const {
  const StageInfo& info = pipeline_.stages()[stage_]->info();
  std::optional<State> state;
  for (const StageRecord& record : manifest_.stages) {
    if (record.own_grid) continue;
    const Snapshot snapshot = read_recorded(folder_.path(), record, [&](const FieldSpec& spec) {
      return lists(info.reads, spec) || lists(info.optional, spec);
    });
    if (!state) state.emplace(snapshot.grid);
    for (const auto& [spec, values] : snapshot.fields) {
      state->set(*spec, *values);
    }
  }
  return std::move(*state);
}

Provenance IslandSession::provenance_of(const std::string& name) const {
  const auto& build = build_info();
  return {.title = fmt::format("terrane: {}", name),
          .config_toml = write_config(
              parameters_, fmt::format("terrane {}: {}", build.version, name), settings_.events),
          .seed = static_cast<std::uint64_t>(settings_.seed),
          .version = build.version,
          .history = fmt::format("{:%Y-%m-%dT%H:%M:%SZ} terrane {} ({}): {}",
                                 fmt::gmtime(now_or_given()), build.version, build.commit, name),
          .references = "docs/references.bib: tectonica2026"};
}

Context IslandSession::context_of(const RunEvents& events) const {
  Context context;
  context.planet = planet_;
  context.seed = static_cast<std::uint64_t>(settings_.seed);
  context.exemplars = exemplars_;
  context.events = settings_.events;
  context.on_progress = events.progress;
  context.stop = events.stop;
  return context;
}

/// The island's files, and what the manifest is to say of them.
StageRecord IslandSession::write_island(const std::string& name, const State& island,
                                        const Context& told) const {
  StageRecord record;
  record.name = name;
  record.own_grid = true;
  record.on_command = true;
  record.builder = this_builder();
  record.budget = told.budget;
  record.warnings = told.warnings;
  Snapshot snapshot;
  snapshot.stage = stage_name();
  snapshot.grid = island.shared_grid();
  for (const FieldSpec* spec : pipeline_.stages()[stage_]->info().writes) {
    snapshot.fields.emplace_back(spec, island.values(*spec));
    record.fields.push_back(summarise(*spec, *island.values(*spec), island.grid()));
  }
  const Provenance provenance = provenance_of(name);
  const auto netcdf = folder_.stage_file(stage_number_, name, ".nc");
  write_netcdf(netcdf, snapshot, provenance, static_cast<int>(settings_.compression));
  record.list(folder_.path(), netcdf.filename().string());
  if (settings_.vtk) {
    const auto vti = folder_.stage_file(stage_number_, name, ".vti");
    write_vti(vti, snapshot, provenance, static_cast<int>(settings_.vtk_compression));
    record.list(folder_.path(), vti.filename().string());
  }
  return record;
}

std::string IslandSession::execute(const RunEvents& events) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  State state = read_planet();
  if (state.grid().topology() != Topology::sphere) {
    throw ConfigurationError(fmt::format(
        "{} holds a part of a planet: an island needs the whole of one", folder_.path().string()));
  }
  const std::string name = manifest_.free_name(stage_name(), manifest_.complete ? 1 : 2);
  Context context = context_of(events);
  StageRecord record;
  FieldsAtHand at_hand;
  Pipeline::Observer observer;
  observer.before = [&](int) {
    if (events.stage_begins) events.stage_begins(name, static_cast<double>(state.grid().size()));
  };
  observer.after = [&](int, const State& island, const Context& told) {
    record = write_island(name, island, told);
    at_hand.keep_planet(state, state.present());
    at_hand.keep_island(name, island);
  };
  pipeline_.run(state, context, stage_, stage_, observer);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  record.seconds = time_is_given() ? 0.0 : seconds;
  manifest_.stages.push_back(std::move(record));
  write_manifest(folder_.manifest(), manifest_);
  if (settings_.vtk) write_collection_files(folder_, manifest_);
  if (events.stage_ends) events.stage_ends(name, seconds);
  if (settings_.maps) draw_run(folder_, settings_.map_view(), name, at_hand);
  manifest_.files = digests_of_summaries(folder_);
  write_manifest(folder_.manifest(), manifest_);
  return name;
}

}  // namespace geo::io
