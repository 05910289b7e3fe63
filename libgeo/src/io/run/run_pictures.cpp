#include "geo/io/run/run_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/parameter.hpp"
#include "geo/core/stage.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/maps/maps.hpp"
#include "geo/io/netcdf/planet_file.hpp"
#include "geo/io/report/report.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/io/score/scorecard.hpp"
#include "io/config/event_words.hpp"
#include "io/drawing/map_canvas.hpp"
#include "io/maps/map_set.hpp"
#include "io/maps/map_year.hpp"
#include "io/report/report_globe.hpp"
#include "io/report/side_by_side.hpp"
#include "run_frames.hpp"

namespace geo::io {
namespace {

/// What a picture of the whole run or its scorecard may be made from.
bool is_pictured(const FieldSpec& spec) {
  return lists(map_fields(), spec) || lists(scorecard_fields(), spec);
}

bool holds(const StageRecord& record, std::string_view field) {
  return std::any_of(record.fields.begin(), record.fields.end(),
                     [&](const FieldRecord& held) { return held.name == field; });
}

/// What is `held` of the planet, and from the files of all complete stages those of the wanted
/// fields that it lacks: where two stages wrote the same, the later one's.
State planet_with(std::span<const FieldSpec* const> wanted, const RunFolder& folder,
                  const Manifest& manifest, std::optional<State> held) {
  std::optional<State> state = std::move(held);
  const auto is_missing = [&](const FieldSpec& spec) {
    return lists(wanted, spec) && !(state && state->has(spec));
  };
  for (auto record = manifest.stages.rbegin(); record != manifest.stages.rend(); ++record) {
    if (record->own_grid) continue;
    const bool has_missing = std::any_of(wanted.begin(), wanted.end(), [&](const FieldSpec* spec) {
      return is_missing(*spec) && holds(*record, spec->name);
    });
    if (state && !has_missing) continue;
    Snapshot snapshot = read_recorded(folder.path(), *record, is_missing);
    if (!state) state.emplace(snapshot.grid);
    for (auto& [spec, values] : snapshot.fields) state->share(*spec, std::move(values));
  }
  if (!state) {
    throw InputError(fmt::format("{}: holds no complete stage to draw", folder.path().string()));
  }
  return std::move(*state);
}

State island_state(const RunFolder& folder, const StageRecord& record,
                   const FieldsAtHand& at_hand) {
  if (const State* const held = at_hand.island(record.name)) return *held;
  const auto wanted = island_map_fields();
  const Snapshot snapshot = read_recorded(
      folder.path(), record, [&](const FieldSpec& spec) { return lists(wanted, spec); });
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
    if (holds(record, wanted.field) && (found == nullptr || found->own_grid || !record.own_grid)) {
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

/// What a map of a field shows besides: the elevation, with the rivers of an island's; of biomes
/// what is frozen all year.
std::vector<const FieldSpec*> companions_of(std::string_view field, bool of_island) {
  std::vector<const FieldSpec*> fields{&field::elevation};
  if (of_island && field == field::elevation.name) {
    fields.insert(fields.end(), {&field::lake_depth, &field::flow_receiver, &field::discharge,
                                 &field::drainage_area});
  }
  if (field == field::biome.name) {
    fields.insert(fields.end(), {&field::temperature, &field::temperature_range});
  }
  return fields;
}

/// The fields of that stage that a map of one of them is drawn from; those that the stage does not
/// have as the planet has them at the end.
State state_for(const RunFolder& folder, const Manifest& manifest, const StageRecord& record,
                std::string_view field) {
  const bool of_island = record.own_grid;
  std::vector<const FieldSpec*> wanted = companions_of(field, of_island);
  const Snapshot snapshot = read_recorded(folder.path(), record, [&](const FieldSpec& spec) {
    return spec.name == field || lists(wanted, spec);
  });
  State state(snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) state.share(*spec, values);
  if (of_island) return state;
  std::erase_if(wanted, [&](const FieldSpec* spec) { return state.has(*spec); });
  std::vector<std::filesystem::path> files;
  for (const StageRecord& each : manifest.stages) {
    const auto has = [&](const FieldSpec* spec) { return holds(each, spec->name); };
    if (!each.own_grid && std::any_of(wanted.begin(), wanted.end(), has)) {
      files.push_back(folder.path() / netcdf_of(each));
    }
  }
  if (files.empty()) return state;
  const State planet = read_planet(files, wanted);
  if (planet.grid().size() != state.grid().size()) return state;
  for (const FieldSpec* spec : wanted) {
    if (planet.has(*spec)) state.share(*spec, planet.values(*spec));
  }
  return state;
}

/// The year of the planet, where the run has written its months.
std::optional<PlanetMonths> months_of(const RunFolder& folder, const Manifest& manifest,
                                      const Grid& grid) {
  if (!configured_flag(read_text(folder.config()), "output.monthly")) return {};
  for (const StageRecord& record : manifest.stages) {
    if (record.own_grid || !holds(record, field::precipitation_seasonality.name)) continue;
    // That the file is the run's own is made sure of first.
    (void)read_recorded(folder.path(), record, [](const FieldSpec&) { return false; });
    return read_planet_months(folder.path() / netcdf_of(record), grid, kMostColumns);
  }
  return {};
}

/// What a report says besides what is measured and drawn.
Report report_of(const RunFolder& folder, const Manifest& manifest, const Grid& grid) {
  Report report;
  report.title = fmt::format("terrane: planet of seed {}", manifest.seed);
  report.introduction = fmt::format("{} x {} cells.", grid.nx(), grid.ny());
  report.events = event_lines(manifest);
  report.fields = field_figures(manifest);
  report.parameters = read_text(folder.config());
  report.provenance = {{"version", manifest.version},
                       {"commit", manifest.commit},
                       {"compiler", manifest.compiler},
                       {"seed", fmt::format("{}", manifest.seed)}};
  return report;
}

std::vector<const StageRecord*> islands_of(const Manifest& manifest) {
  std::vector<const StageRecord*> islands;
  for (const StageRecord& record : manifest.stages) {
    if (record.own_grid) islands.push_back(&record);
  }
  return islands;
}

/// The report with those of its maps that are there. Returns all files.
std::vector<std::filesystem::path> write_pages(const RunFolder& folder, Report& report) {
  std::erase_if(report.maps, [](const MapFile& map) { return !std::filesystem::exists(map.path); });
  std::vector<std::filesystem::path> written;
  for (const MapFile& map : report.maps) written.push_back(map.path);
  written.push_back(write_report(folder.path(), report));
  return written;
}

}  // namespace

void FieldsAtHand::keep_planet(const State& state, std::span<const FieldSpec* const> fields) {
  if (!planet_) planet_.emplace(state.shared_grid());
  for (const FieldSpec* spec : fields) {
    if (is_pictured(*spec)) planet_->share(*spec, state.values(*spec));
  }
}

void FieldsAtHand::keep_island(const std::string& name, const State& state) {
  State kept(state.shared_grid());
  for (const FieldSpec* spec : island_map_fields()) {
    if (state.has(*spec)) kept.share(*spec, state.values(*spec));
  }
  islands_.insert_or_assign(name, std::move(kept));
}

const State* FieldsAtHand::island(const std::string& name) const {
  const auto at = islands_.find(name);
  return at == islands_.end() ? nullptr : &at->second;
}

std::vector<std::filesystem::path> draw_run(const RunFolder& folder, const MapView& asked,
                                            std::string_view only_island, FieldsAtHand at_hand) {
  const Manifest manifest = read_manifest(folder.manifest());
  const bool all = only_island.empty();
  const MapView as_it_lies(asked.width_px);
  const std::string note = note_of(manifest);

  // What a part of the scorecard alone reads leaves memory before what the maps do comes to it.
  using Part = ScoreInParts::Part;
  State state =
      planet_with(ScoreInParts::fields(Part::surface), folder, manifest, at_hand.take_planet());
  const bool is_scored = state.grid().topology() == Topology::sphere;
  ScoreInParts score;
  Report report = report_of(folder, manifest, state.grid());
  std::vector<std::function<void()>> pieces;
  if (is_scored) pieces.emplace_back([&] { score.measure(Part::surface, state); });
  const std::vector<const StageRecord*> islands = islands_of(manifest);
  std::vector<std::vector<MapFile>> island_maps(islands.size());
  for (std::size_t k = 0; k < islands.size(); ++k) {
    pieces.emplace_back([&, k] {
      const StageRecord& record = *islands[k];
      const State island = island_state(folder, record, at_hand);
      MapSet maps = MapSet::of_island(island, folder.maps(), record.name, as_it_lies, note);
      if (all || record.name == only_island) maps.draw_all();
      island_maps[k] = maps.files();
    });
  }
  do_side_by_side(pieces);

  auto wanted = map_fields();
  for (const FieldSpec* spec : ScoreInParts::fields(Part::crust)) wanted.push_back(spec);
  for (const FieldSpec* spec : state.present()) {
    if (!lists(wanted, *spec)) state.erase(*spec);
  }
  state = planet_with(wanted, folder, manifest, std::move(state));
  pieces.clear();
  if (is_scored) pieces.emplace_back([&] { score.measure(Part::crust, state); });
  const MapView& view = state.grid().is_latitude_longitude() ? asked : as_it_lies;
  const auto months = months_of(folder, manifest, state.grid());
  pieces.emplace_back(
      [&] { report.globe = globe_markup(state, globe_frames(folder, manifest), months); });
  MapSet planet = MapSet::of_planet(state, folder.maps(), view, note, event_marks(manifest));
  if (all) {
    planet.prepare();
    for (auto& piece : planet.pieces()) pieces.push_back(std::move(piece));
  }
  std::optional<MapFile> hypsometry, year;
  if (state.has(field::elevation)) {
    pieces.emplace_back([&] { hypsometry = draw_hypsometry_file(state, folder.maps(), note); });
  }
  if (months && state.has(field::elevation)) {
    pieces.emplace_back([&] {
      const auto heights = thinned(state.read(field::elevation), state.grid(), months->cells);
      year = draw_year_file(*months, heights, folder.maps(), note);
    });
  }
  do_side_by_side(pieces);

  if (is_scored) report.scorecard = score.card();
  report.maps = planet.files();
  if (year) report.maps.push_back(*year);
  for (const auto& maps : island_maps) {
    report.maps.insert(report.maps.end(), maps.begin(), maps.end());
  }
  if (hypsometry) report.maps.push_back(*hypsometry);
  return write_pages(folder, report);
}

std::vector<std::filesystem::path> draw_view(const RunFolder& folder, const MapView& view,
                                             const std::filesystem::path& pictures) {
  const Manifest manifest = read_manifest(folder.manifest());
  const State state = planet_with(map_fields(), folder, manifest, {});
  std::vector<std::filesystem::path> written;
  for (const MapFile& map :
       draw_map_files(state, pictures, view, note_of(manifest), event_marks(manifest))) {
    written.push_back(map.path);
  }
  return written;
}

FieldsOfRun read_fields_of_run(const RunFolder& folder, const FieldOfRun& wanted,
                               const std::function<bool(const FieldSpec&)>& also,
                               const std::function<bool(const FieldSpec&)>& besides) {
  const Manifest manifest = read_manifest(folder.manifest());
  const StageRecord& record = stage_of(manifest, wanted, folder.path().string());
  FieldsOfRun found{
      read_recorded(folder.path(), record,
                    [&](const FieldSpec& spec) { return spec.name == wanted.field || also(spec); }),
      folder.path() / netcdf_of(record)};
  auto& fields = found.snapshot.fields;
  const auto is_lacking = [&](const FieldSpec& spec) {
    return besides(spec) && std::none_of(fields.begin(), fields.end(),
                                         [&](const auto& held) { return held.first == &spec; });
  };
  if (record.own_grid) return found;
  for (auto other = manifest.stages.rbegin(); other != manifest.stages.rend(); ++other) {
    const bool has_some =
        std::any_of(other->fields.begin(), other->fields.end(), [&](const FieldRecord& held) {
          const FieldSpec* const spec = field::find(held.name);
          return spec != nullptr && is_lacking(*spec);
        });
    if (other->own_grid || &*other == &record || !has_some) continue;
    Snapshot snapshot = read_recorded(folder.path(), *other, is_lacking);
    if (snapshot.grid->size() != found.snapshot.grid->size()) continue;
    for (auto& held : snapshot.fields) fields.push_back(std::move(held));
  }
  return found;
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
