#pragma once

#include <span>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// Today's climate of a surface with the ice that lives on in it. Ice and climate follow each
/// other, because ice is bright and high: where the same sun allows both ice and none (North 1984),
/// the last cold time decides. Ice grows in the climate of that time, shrinks in the warmest since,
/// and what is left makes the climate of today, which has it in `ice_m`. All on the grid of
/// climate_grid, with air thrice as coarse as the run's.
[[nodiscard]] LandClimate icy_climate(const ErosionParameters& parameters, const Grid& grid,
                                      std::span<const float> elevation_m, Context& context);
/// That ice alone, m, mean of each cell of climate_grid.
[[nodiscard]] std::vector<float> living_ice_m(const ErosionParameters& parameters, const Grid& grid,
                                              std::span<const float> elevation_m, Context& context);
/// What these take, as in StageCost, with the climate's settings in `configuration`; the ice alone
/// without cold times.
[[nodiscard]] double icy_climate_seconds(std::span<const Parameter> configuration);
[[nodiscard]] double warm_ice_seconds(std::span<const Parameter> configuration);

}  // namespace geo
