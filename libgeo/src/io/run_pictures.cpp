#include "geo/io/run_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "event_words.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parameter.hpp"
#include "geo/io/config.hpp"
#include "geo/io/manifest.hpp"
#include "geo/io/maps.hpp"
#include "geo/io/planet_file.hpp"
#include "geo/io/report.hpp"
#include "geo/io/scorecard.hpp"
#include "map_canvas.hpp"

namespace geo::io {
namespace {

/// The fields of all complete stages of the planet that pictures and scorecard are made from: where
/// two stages wrote the same, the later one's.
State final_state(const RunFolder& folder, const Manifest& manifest) {
  std::vector<std::filesystem::path> files;
  for (const StageRecord& record : manifest.stages) {
    if (!is_island(record)) files.push_back(folder.path() / netcdf_of(record));
  }
  if (files.empty()) {
    throw InputError(fmt::format("{}: holds no complete stage to draw", folder.path().string()));
  }
  auto wanted = map_fields();
  for (const FieldSpec* spec : scorecard_fields()) wanted.push_back(spec);
  return read_planet(files, wanted);
}

std::optional<Scorecard> scorecard_of(const State& state) {
  if (state.grid().topology() != Topology::sphere) return {};
  return score_planet(state);
}

State island_state(const RunFolder& folder, const StageRecord& record) {
  const auto wanted = island_map_fields();
  const Snapshot snapshot =
      read_netcdf(folder.path() / netcdf_of(record), [&](const FieldSpec& spec) {
        return std::find(wanted.begin(), wanted.end(), &spec) != wanted.end();
      });
  State state(snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) state.share(*spec, values);
  return state;
}

std::string note_of(const Manifest& manifest) {
  return fmt::format("seed {}, terrane {}", manifest.seed, manifest.version);
}

const StageRecord* stage_named(const Manifest& manifest, std::string_view name) {
  const auto at = std::find_if(manifest.stages.begin(), manifest.stages.end(),
                               [&](const StageRecord& record) { return record.name == name; });
  return at == manifest.stages.end() ? nullptr : &*at;
}

bool holds(const StageRecord& record, std::string_view field) {
  return std::any_of(record.fields.begin(), record.fields.end(),
                     [&](const FieldRecord& held) { return held.name == field; });
}

/// ", perhaps slope, elevation": the nearest of some words first, three at most.
std::string perhaps(std::string_view word, std::vector<std::string_view> candidates) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const std::string near = nearest_word(word, candidates);
    if (near.empty()) break;
    text += fmt::format("{}{}", text.empty() ? ", perhaps " : ", ", near);
    std::erase(candidates, near);
  }
  return text;
}

/// The stage that a field is drawn of.
const StageRecord& stage_of(const Manifest& manifest, const FieldOfRun& wanted,
                            const std::string& folder) {
  std::vector<std::string_view> stages, fields;
  for (const StageRecord& record : manifest.stages) stages.push_back(record.name);
  if (!wanted.stage.empty() && stage_named(manifest, wanted.stage) == nullptr) {
    throw ConfigurationError(fmt::format("{} has no stage \"{}\"{}: it has {}", folder,
                                         wanted.stage, perhaps(wanted.stage, stages),
                                         fmt::join(stages, ", ")));
  }
  const StageRecord* found = nullptr;
  for (const StageRecord& record : manifest.stages) {
    if (!wanted.stage.empty() && record.name != wanted.stage) continue;
    for (const FieldRecord& field : record.fields) fields.push_back(field.name);
    // Of the planet rather than of an island, the last.
    if (holds(record, wanted.field) &&
        (found == nullptr || is_island(*found) || !is_island(record))) {
      found = &record;
    }
  }
  if (found != nullptr) return *found;
  std::sort(fields.begin(), fields.end());
  fields.erase(std::unique(fields.begin(), fields.end()), fields.end());
  const std::string near = perhaps(wanted.field, fields);
  throw ConfigurationError(
      fmt::format("{} of {} has no field \"{}\"{}",
                  wanted.stage.empty() ? "the run" : "stage " + wanted.stage, folder, wanted.field,
                  near.empty() ? ": it has " + fmt::format("{}", fmt::join(fields, ", ")) : near));
}

/// The fields of that stage that a map of one of them is drawn from, with the rivers of an island's
/// relief; where the stage has no elevation, the planet's last.
State state_for(const RunFolder& folder, const Manifest& manifest, const StageRecord& record,
                std::string_view field) {
  const std::array<const FieldSpec*, 4> water{&field::lake_depth, &field::flow_receiver,
                                              &field::discharge, &field::drainage_area};
  const bool with_water = is_island(record) && field == field::elevation.name;
  const Snapshot snapshot =
      read_netcdf(folder.path() / netcdf_of(record), [&](const FieldSpec& spec) {
        return spec.name == field || spec.name == field::elevation.name ||
               (with_water && std::find(water.begin(), water.end(), &spec) != water.end());
      });
  State state(snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) state.share(*spec, values);
  if (!state.has(field::elevation) && !is_island(record)) {
    std::vector<std::filesystem::path> files;
    for (const StageRecord& each : manifest.stages) {
      if (!is_island(each) && holds(each, field::elevation.name)) {
        files.push_back(folder.path() / netcdf_of(each));
      }
    }
    if (files.empty()) return state;
    const std::array<const FieldSpec*, 1> wanted{&field::elevation};
    const State planet = read_planet(std::array{files.back()}, wanted);
    if (planet.grid().size() == state.grid().size()) {
      state.share(field::elevation, planet.values(field::elevation));
    }
  }
  return state;
}

void append(std::vector<MapFile>& maps, std::vector<MapFile> more) {
  maps.insert(maps.end(), more.begin(), more.end());
}

}  // namespace

std::vector<std::filesystem::path> draw_run(const RunFolder& folder, const MapView& asked,
                                            std::string_view only_island) {
  const Manifest manifest = read_manifest(folder.manifest());
  const State state = final_state(folder, manifest);
  const bool all = only_island.empty();
  const MapView as_it_lies(asked.width_px);
  const MapView& view = state.grid().is_latitude_longitude() ? asked : as_it_lies;
  const std::string note = note_of(manifest);
  Report report{
      .title = fmt::format("terrane: planet of seed {}", manifest.seed),
      .introduction = fmt::format("{} x {} cells.", state.grid().nx(), state.grid().ny()),
      .maps = all ? draw_map_files(state, folder.maps(), view, note, event_marks(manifest))
                  : list_map_files(state, folder.maps(), view),
      .scorecard = scorecard_of(state),
      .events = event_lines(manifest),
      .fields = field_figures(manifest),
      .parameters = read_text(folder.config()),
      .provenance = {{"version", manifest.version},
                     {"commit", manifest.commit},
                     {"compiler", manifest.compiler},
                     {"seed", fmt::format("{}", manifest.seed)}}};
  for (const StageRecord& record : manifest.stages) {
    if (!is_island(record)) continue;
    const State island = island_state(folder, record);
    append(report.maps,
           all || record.name == only_island
               ? draw_island_files(island, folder.maps(), record.name, as_it_lies, note)
               : list_island_files(island, folder.maps(), record.name, as_it_lies));
  }
  if (state.has(field::elevation)) {
    report.maps.push_back(draw_hypsometry_file(state, folder.maps(), note));
  }
  std::vector<std::filesystem::path> written;
  for (const MapFile& map : report.maps) {
    if (std::filesystem::exists(map.path)) written.push_back(map.path);
  }
  std::erase_if(report.maps, [](const MapFile& map) { return !std::filesystem::exists(map.path); });
  written.push_back(write_report(folder.path(), report));
  return written;
}

std::vector<std::filesystem::path> draw_view(const RunFolder& folder, const MapView& view,
                                             const std::filesystem::path& pictures) {
  const Manifest manifest = read_manifest(folder.manifest());
  const State state = final_state(folder, manifest);
  std::vector<std::filesystem::path> written;
  for (const MapFile& map :
       draw_map_files(state, pictures, view, note_of(manifest), event_marks(manifest))) {
    written.push_back(map.path);
  }
  return written;
}

std::filesystem::path draw_field(const RunFolder& folder, const MapView& view,
                                 const FieldOfRun& wanted, const std::filesystem::path& pictures) {
  const Manifest manifest = read_manifest(folder.manifest());
  const StageRecord& record = stage_of(manifest, wanted, folder.path().string());
  const FieldSpec* const spec = field::find(wanted.field);
  if (spec == nullptr) {
    throw InputError(fmt::format("{}: {} is no field that terrane knows",
                                 folder.manifest().string(), wanted.field));
  }
  const State state = state_for(folder, manifest, record, spec->name);
  static_cast<void>(map_layout(state.grid(), view));  // refuses a view before there is a folder
  make_folder(pictures);
  const std::string name =
      wanted.stage.empty() ? wanted.field : fmt::format("{}-{}", wanted.stage, wanted.field);
  return draw_field_file(state, *spec, pictures / (name + ".png"), view,
                         fmt::format("{}, {}", record.name, note_of(manifest)))
      .path;
}

}  // namespace geo::io
