#pragma once

#include <span>

#include "geo/core/stage.hpp"
#include "geo/stages/erosion/drainage.hpp"

namespace geo {

/// By which temperatures follow heights within a stage (ICAO 1993).
inline constexpr float kLapse_K_m = 6.5e-3F;

/// Whether the climate of a surface can be known in the midst of another stage: of a whole planet
/// whose run has a climate stage.
[[nodiscard]] bool has_climate(const Grid& grid, const Context& context);

/// The climate of a surface as it is now: the stage `climate`, with the settings that it has in
/// this run, on a grid of at most 512 columns, interpolated; temperatures follow heights by
/// `kLapse_K_m` from there. `ice_m` (one value per cell, or none) lies on land: it is bright, and
/// `elevation_m` is its surface. Currents of the sea are left out. Events do not act on it: they
/// are sudden, this is the mean of an age.
[[nodiscard]] LandClimate climate_of_land(const Grid& grid, std::span<const float> elevation_m,
                                          std::span<const float> ice_m, Context& context);
/// What that takes, as in StageCost, with the climate's settings in `configuration`.
[[nodiscard]] double climate_of_land_seconds(std::span<const Parameter> configuration);

}  // namespace geo
