#include "geo/io/run_pictures.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "event_words.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config.hpp"
#include "geo/io/manifest.hpp"
#include "geo/io/maps.hpp"
#include "geo/io/planet_file.hpp"
#include "geo/io/report.hpp"
#include "geo/io/scorecard.hpp"

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
  const Snapshot snapshot = read_netcdf(folder.path() / netcdf_of(record));
  State state(snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) state.set(*spec, *values);
  return state;
}

void append(std::vector<MapFile>& maps, std::vector<MapFile> more) {
  maps.insert(maps.end(), more.begin(), more.end());
}

}  // namespace

std::vector<std::filesystem::path> draw_run(const RunFolder& folder, int map_width_px,
                                            std::string_view only_island) {
  const Manifest manifest = read_manifest(folder.manifest());
  const State state = final_state(folder, manifest);
  const bool all = only_island.empty();
  const std::string note = fmt::format("seed {}, terrane {}", manifest.seed, manifest.version);
  Report report{
      .title = fmt::format("terrane: planet of seed {}", manifest.seed),
      .introduction = fmt::format("{} x {} cells.", state.grid().nx(), state.grid().ny()),
      .maps = all ? draw_map_files(state, folder.maps(), map_width_px, note, event_marks(manifest))
                  : list_map_files(state, folder.maps(), map_width_px),
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
               ? draw_island_files(island, folder.maps(), record.name, map_width_px, note)
               : list_island_files(island, folder.maps(), record.name, map_width_px));
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

}  // namespace geo::io
