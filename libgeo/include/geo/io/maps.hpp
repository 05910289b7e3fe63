#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geo/core/state.hpp"

namespace geo::io {

/// Draws the PNG maps that the fields of a state allow (elevation, temperature, precipitation,
/// rivers, biomes …) into a folder, with title, legend and graticule. `width_px` is the width of
/// the map itself. Returns the paths written. Throws IoError.
std::vector<std::filesystem::path> draw_maps(const State& state,
                                             const std::filesystem::path& folder,
                                             int width_px = 1800);

/// Hypsometric curve of a relief beside Earth's (hypsometry.png).
std::filesystem::path draw_hypsometry(const State& state, const std::filesystem::path& folder);

}  // namespace geo::io
