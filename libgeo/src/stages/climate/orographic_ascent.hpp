#pragma once

#include <span>
#include <vector>

#include "climate_frame.hpp"

namespace geo {

/// How many times more than over level ground air rains out at the scale of single ranges, on the
/// topography grid: e where it has just been lifted by `lift_height_m`, 1/e where it has sunk by
/// that.
std::vector<float> orographic_ascent(const ClimateFrame& frame, std::span<const float> wind_east,
                                     std::span<const float> wind_north,
                                     std::span<const float> height_m, const ClimateParameters& p);

/// Its mean over each cell of the planet, 1 beyond the stage's grid.
std::vector<float> mean_ascent(const ClimateFrame& frame, std::span<const float> ascent);

}  // namespace geo
