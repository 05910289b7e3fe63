#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/energy_balance.hpp"

namespace geo {

/// Heat that wind-driven currents bring to the sea, W m-2: the sum of four terms, and what closes
/// the budget, for currents move heat and make none: a multiple of cos(lat)^2 * water.
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
///   q = -upwelling exp(-(lat / width)^2) exp(-distance to the coast in the east / reach)
///       (1 - exp(-distance to the coast in the west / reach)) trades * water
/// (Wyrtki 1981), trades = (1 m/s - u) / upwelling_trades_m_s within 0 and 1, u the annual mean of
/// the wind along the equator, east: where that comes from the west, as over the Indian Ocean,
/// nothing wells up. Without a coast in the way upwelling does not cool.
///
/// Coastal upwelling: winds about the subtropical highs drive water away from eastern coasts, cold
/// water wells up there (Bakun 1990), and low clouds over it keep the sun away (Klein & Hartmann
/// 1993),
///   q = -coastal upwelling sin(pi / 2 |lat| / 22 deg)^2 exp(-distance to the coast in the east /
///       reach) (1 - exp(-distance to the coast in the west / reach)) * water
/// within 44 deg of the equator. It has a reach of its own.
///
/// On a planet that turns the other way, west is east.
/// `equatorial_wind_m_s`: u, one value per column; empty: trades = 1. Throws Bug where sizes
/// differ.
void ocean_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
                std::span<const double> latitude_deg, std::span<const float> land_fraction,
                std::span<double> heat_w_m2, std::span<const double> equatorial_wind_m_s = {});

/// How much warmer than the air above it the sea is where currents bring it heat, K: the water
/// passes on q per unit of its area through the exchange g,
///   T_s - T = (1 - ice) q / (water g(T)),
/// beyond the difference that sunlight makes everywhere (Haney 1971), as far as no sea ice keeps
/// them apart. Colder where currents take heat, 0 on land. Winds level the temperature of the air
/// over thousands of kilometres, this they do not. `annual_mean_c`: of the air at sea level. All
/// but the latitudes have one value per cell; Bug otherwise.
[[nodiscard]] std::vector<float> sea_warmth_k(const Grid& grid, const EnergyBalance& model,
                                              bool retrograde, std::span<const double> latitude_deg,
                                              std::span<const float> land_fraction,
                                              std::span<const double> annual_mean_c,
                                              std::span<const double> equatorial_wind_m_s = {});

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
