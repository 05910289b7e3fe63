#pragma once

#include <memory>
#include <span>

#include "geo/core/stage.hpp"
#include "geo/stages/erosion/drainage.hpp"

namespace geo {

/// By which temperatures follow heights within a stage (ICAO 1993).
inline constexpr float kLapse_K_m = 6.5e-3F;

/// Whether the climate of a surface can be known in the midst of another stage: of a whole planet
/// whose run has a climate stage.
[[nodiscard]] bool has_climate(const Grid& grid, const Context& context);

/// The grid, of at most 512 columns, on which it is computed.
[[nodiscard]] Grid climate_grid(const Grid& grid);

/// How the air differs from that of the run's climate.
struct AirOfTime {
  double coarser = 1.0;   ///< how many times as coarse its grid is
  double colder_k = 0.0;  ///< by how much the planet is colder, but for what snow and ice add
};

/// The climate of a surface as it is now: the stage `climate`, with the settings that it has in
/// this run. Currents of the sea are left out. Events do not act on it: they are sudden, this is
/// the mean of an age. `ice_m` (one value per cell; empty: bare ground) lies on the surface.
[[nodiscard]] LandClimate climate_of_surface(const std::shared_ptr<const Grid>& grid,
                                             std::span<const float> surface_m,
                                             std::span<const float> ice_m, const AirOfTime& air,
                                             Context& context);
/// The same of bare ground on the climate's grid, interpolated; temperatures follow heights by
/// `kLapse_K_m` from there.
[[nodiscard]] LandClimate climate_of_land(const Grid& grid, std::span<const float> elevation_m,
                                          Context& context);
/// What that takes, as in StageCost, with the climate's settings in `configuration`.
[[nodiscard]] double climate_of_land_seconds(std::span<const Parameter> configuration,
                                             const AirOfTime& air = {});

}  // namespace geo
