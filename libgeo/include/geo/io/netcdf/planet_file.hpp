#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "geo/core/state.hpp"

namespace geo::io {

/// The wanted fields of a finished planet from the stage files of a run, in the order of the
/// stages: where several wrote the same, the last one's; files on another grid than the first's
/// (islands) are passed over. Absent fields stay absent. Throws InputError without any file.
State read_planet(std::span<const std::filesystem::path> stage_files,
                  std::span<const FieldSpec* const> wanted);

/// The same from all stage files of a run's folder. Throws InputError when it holds none.
State read_planet(const std::filesystem::path& folder, std::span<const FieldSpec* const> wanted);

/// The same from what a user names: a run's folder, one stage file, or any lat-lon elevation NetCDF
/// as `FILE[:VARIABLE]`. Throws InputError for what does not cover the whole planet, IoError when
/// there is no such file.
State read_planet_or_dem(const std::string& place, std::span<const FieldSpec* const> wanted);

}  // namespace geo::io
