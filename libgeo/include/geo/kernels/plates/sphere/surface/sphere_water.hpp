#pragma once

#include <vector>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// The elevation above which a share of the planet lies, to a metre. Gaps that have opened are sea.
[[nodiscard]] double level_above(const SphereTectonics& model, double share);
/// What lies between sea floor and a level, as plates lie; where gaps have opened, from the depth
/// of floor of that age.
[[nodiscard]] double sea_volume_km3(const SphereTectonics& model, double level_m);
/// Area that drains through each sample, km2, times runoff over that of reference; 0 off the land.
[[nodiscard]] std::vector<double> drained_km2(const SphereTectonics& model);

}  // namespace geo
