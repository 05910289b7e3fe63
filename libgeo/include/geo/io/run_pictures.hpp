#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "geo/io/run_folder.hpp"

namespace geo::io {

/// Draws the maps and the report of a run from its files, by its manifest. With the name of an
/// island ("island-2") only its maps are drawn, and the report lists those that are there. Returns
/// the paths of the report and its pictures. Throws InputError or IoError when the folder holds no
/// such run.
std::vector<std::filesystem::path> draw_run(const RunFolder& folder, int map_width_px,
                                            std::string_view only_island = {});

}  // namespace geo::io
