#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Bends the heights of land so that their median over the area becomes `median_m` (Tectonica
/// blueprint 4.7 to 4.9): h' = max (h / max)^alpha with alpha = ln(median / max) / ln(median of h /
/// max), at most 5. The blueprint's lower bound of 1 would leave land that is too low as it is;
/// here it is 0.2. The change, not the elevation, is smoothed over `smoothing_m`, within the land;
/// alpha is then set again until the median is met within 1 %. Land is where `elevation_m` > 0; it
/// stays above 0, and the sea is left alone. Returns the last alpha; 1 leaves all as it is.
/// `elevation_m`: one value per cell, in and out; Bug otherwise.
double bend_hypsometry(const Grid& grid, std::span<float> elevation_m, double median_m,
                       double smoothing_m);

/// The same as the blueprint has it: alpha within 1 and 5, set once, so that smoothing may shift
/// the median off its target. `elevation_m`: one value per cell, in and out; Bug otherwise.
double bend_hypsometry_once(const Grid& grid, std::span<float> elevation_m, double median_m,
                            double smoothing_m);

}  // namespace geo
