#pragma once

#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/energy_balance.hpp"

namespace geo {

/// Heat that wind-driven currents bring to the sea, W m-2, the sum of two.
///
/// Gyres: trades push warm water west and let cold water well up in the east, westerlies the other
/// way round (zero at 45 deg),
///   q = gyre_heat cos(2 lat) (land to the west - land to the east) * water,
/// the land shares weighted by exp(-distance / gyre_reach) along the parallel (Stommel 1948).
///
/// Equatorial upwelling: trades part the surface water along the equator, and the thermocline lies
/// highest where they come from, at the eastern coast,
///   q = -upwelling exp(-(lat / 5 deg)^2) exp(-distance to the coast in the east / reach) * water
/// (Wyrtki 1981). Nothing wells up that cools where no coast stands in the way.
///
/// On a planet that turns the other way, west is east.
/// Throws Bug where sizes differ.
void ocean_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
                std::span<const double> latitude_deg, std::span<const float> land_fraction,
                std::span<double> heat_w_m2);

}  // namespace geo
