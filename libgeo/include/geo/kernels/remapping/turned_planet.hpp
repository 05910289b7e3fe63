#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// A field of a whole planet without a turn, laid out on a sphere with one: mean over four places
/// of each cell, of cubics in latitude and longitude (CatmullRom) within the values of the four
/// cells round the place. NaN where one of these is. Throws InputError unless both are spheres.
/// @param values  on `source`
[[nodiscard]] std::vector<float> laid_out_turned(const Grid& source, std::span<const float> values,
                                                 const Grid& target);

}  // namespace geo
