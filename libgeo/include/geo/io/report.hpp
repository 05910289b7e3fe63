#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geo/io/manifest.hpp"
#include "geo/io/maps.hpp"
#include "geo/io/run_folder.hpp"

namespace geo::io {

/// What a report shows.
struct Report {
  Manifest manifest;
  std::string config_toml;
  std::vector<MapFile> maps;
};

/// One page of HTML: pictures, figures of each field, budgets, parameters. Needs no network, only
/// the pictures beside it. Throws IoError.
void write_report(const std::filesystem::path& path, const Report& report);

/// Draws the maps and writes the report from the files of a run, by its manifest. Returns the paths
/// written. Throws InputError or IoError when the folder holds no such run.
std::vector<std::filesystem::path> draw_run(const RunFolder& folder, int map_width_px);

}  // namespace geo::io
