#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "geo/core/state.hpp"

namespace geo::io {

/// The wanted fields of a finished planet from the stage files of a run's folder: where several
/// stages wrote the same, the last one's; files on another grid (islands) are passed over. Absent
/// fields stay absent. Throws InputError when the folder holds no stage file.
State read_planet(const std::filesystem::path& folder, std::span<const FieldSpec* const> wanted);

/// The same from what a user names: a run's folder, one stage file, or any lat-lon elevation NetCDF
/// as `FILE[:VARIABLE]`. Throws InputError for what does not cover the whole planet, IoError when
/// there is no such file.
State read_planet_or_relief(const std::string& place, std::span<const FieldSpec* const> wanted);

}  // namespace geo::io
