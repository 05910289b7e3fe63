#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geo/kernels/plates/rotation_model.hpp"

namespace geo::io {

/// Finite rotations of a rotation file of GPlates (PLATES4, `.rot`), one a line:
///
///     MOVING TIME LATITUDE LONGITUDE ANGLE FIXED !COMMENT
///
/// Numbers of plates, 000 being the absolute frame; time in Ma; pole and anticlockwise angle in
/// degrees. Blank lines, lines that are comments alone and those whose moving plate is 999 do not
/// count. Lines may stand in any order. Where the fixed plate of a plate changes, it has two lines
/// of one time, a crossover.
///
/// Whatever is wrong throws InputError "SOURCE:LINE: ...": too few or too many columns, what is no
/// number, numbers out of range, a plate fixed to itself, by whatever circuit, and different
/// rotations of a plate at one time relative to the same plate.
[[nodiscard]] RotationModel rotations_of(std::string_view text, const std::string& source);
/// Reads a file. Throws IoError when it cannot be read.
[[nodiscard]] RotationModel read_rotations(const std::filesystem::path& file);

}  // namespace geo::io
