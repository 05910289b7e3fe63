#pragma once

#include <filesystem>
#include <vector>

#include "geo/io/run_folder.hpp"

namespace geo::io {

/// Draws the maps and the report of a run from its files, by its manifest. Returns the paths
/// written. Throws InputError or IoError when the folder holds no such run.
std::vector<std::filesystem::path> draw_run(const RunFolder& folder, int map_width_px);

}  // namespace geo::io
