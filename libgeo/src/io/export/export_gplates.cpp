#include <fmt/format.h>

#include <system_error>

#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "gplates_run.hpp"

namespace geo::io {

namespace fs = std::filesystem;

std::vector<fs::path> export_gplates(const fs::path& place, const fs::path& folder) {
  if (!fs::is_directory(place)) {
    throw ConfigurationError(fmt::format(
        "export: --format gplates takes the folder of a run; {} is none", place.string()));
  }
  const GplatesRun run(place);
  GplatesLayers layers;
  for (std::size_t k = 0; k < run.frames(); ++k) add_layers(run, run.frame(k), layers);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(fmt::format("{}: {}", folder.string(), error.message()));
  std::vector<fs::path> written{folder / "rotations.rot"};
  write_rotations(written.front(), run.rotations(), run.comments());
  const auto write = [&](const char* name, const GplatesFeatures& features) {
    if (features.empty()) return;
    written.push_back(folder / fmt::format("{}.geojson", name));
    write_gplates_geojson(written.back(), features);
    written.push_back(folder / fmt::format("{}.gpml", name));
    write_gpml(written.back(), features);
  };
  write("plates", layers.plates);
  write("boundaries", layers.boundaries);
  write("coastlines", layers.coastlines);
  write("continents", layers.continents);
  write("isochrons", layers.isochrons);
  return written;
}

}  // namespace geo::io
