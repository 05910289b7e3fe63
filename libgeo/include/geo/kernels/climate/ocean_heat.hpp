#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/energy_balance.hpp"

namespace geo {

/// Heat that wind-driven currents bring to the sea, W m-2, the sum of three terms, less their mean
/// over all water: currents move heat and make none.
///
/// Gyres, which turn with the curl of the wind stress of trades, westerlies and polar easterlies:
/// below 45 deg warm water flows polewards along the western coast of an ocean and cold water back
/// along the eastern one, beyond it the other way round,
///   q = heat sin(4 |lat|) (land to the west - land to the east) * water,
/// the land shares weighted by exp(-distance / reach) along the parallel (Stommel 1948). Heat and
/// reach are those of the subtropical gyres below 45 deg, of the subpolar ones above: what a narrow
/// western boundary current brings leaves it over the whole width of the drift that follows.
///
/// Equatorial upwelling: trades part the surface water along the equator and tilt the thermocline,
/// which lies highest at the eastern coast, and the higher the wider the ocean,
///   q = -upwelling exp(-(lat / 5 deg)^2) exp(-distance to the coast in the east / reach)
///       (1 - exp(-distance to the coast in the west / reach)) * water
/// (Wyrtki 1981). Without a coast in the way upwelling does not cool.
///
/// On a planet that turns the other way, west is east.
/// Throws Bug where sizes differ.
void ocean_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
                std::span<const double> latitude_deg, std::span<const float> land_fraction,
                std::span<double> heat_w_m2);

/// How far each parallel is a channel that runs round the whole planet, 0 to 1: where no coast
/// stands in the way of a zonal current no gyre crosses the parallel, and the sea carries little
/// heat polewards (Toggweiler & Bjornsson 2000; Enderton & Marshall 2009). The share of the
/// parallels within 8 deg, half a circumpolar current's width, on which no cell is more land than
/// water; within 50 deg of the equator less and less, for there the trades drive water polewards
/// without gyres, 0 within 30 deg.
/// Per row; `land_fraction`: one value per cell, Bug otherwise.
[[nodiscard]] std::vector<double> open_channels(const Grid& grid,
                                                std::span<const double> latitude_deg,
                                                std::span<const float> land_fraction);

}  // namespace geo
