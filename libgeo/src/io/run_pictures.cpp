#include "geo/io/run_pictures.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "geo/core/error.hpp"
#include "geo/io/config.hpp"
#include "geo/io/manifest.hpp"
#include "geo/io/maps.hpp"
#include "geo/io/planet_file.hpp"
#include "geo/io/report.hpp"
#include "geo/io/scorecard.hpp"
#include "manifest_events.hpp"

namespace geo::io {
namespace {

/// The fields of all complete stages together that pictures and scorecard are made from: where two
/// stages wrote the same, the later one's.
State final_state(const RunFolder& folder, const Manifest& manifest) {
  std::vector<std::filesystem::path> files;
  for (const StageRecord& stage : manifest.stages) {
    for (const std::string& file : stage.files) {
      if (std::filesystem::path(file).extension() == ".nc") files.push_back(folder.path() / file);
    }
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

}  // namespace

std::vector<std::filesystem::path> draw_run(const RunFolder& folder, int map_width_px) {
  const Manifest manifest = read_manifest(folder.manifest());
  const State state = final_state(folder, manifest);
  const std::string note = fmt::format("seed {}, terrane {}", manifest.seed, manifest.version);
  Report report{.title = fmt::format("terrane: planet of seed {}", manifest.seed),
                .introduction = fmt::format("{} x {} cells.", state.grid().nx(), state.grid().ny()),
                .maps = draw_map_files(state, folder.maps(), map_width_px, note),
                .scorecard = scorecard_of(state),
                .events = read_events(folder.manifest()),
                .fields = field_figures(manifest),
                .parameters = read_text(folder.config()),
                .provenance = {{"version", manifest.version},
                               {"commit", manifest.commit},
                               {"compiler", manifest.compiler},
                               {"seed", fmt::format("{}", manifest.seed)}}};
  if (state.has(field::elevation)) {
    report.maps.push_back(draw_hypsometry_file(state, folder.maps(), note));
  }
  std::vector<std::filesystem::path> written;
  for (const MapFile& map : report.maps) written.push_back(map.path);
  written.push_back(write_report(folder.path(), report));
  return written;
}

}  // namespace geo::io
