#pragma once

#include <span>
#include <vector>

#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/stages/climate/climate.hpp"
#include "geo/stages/island/island.hpp"

namespace geo {

/// Fields of climate, on the planet as they are read, on the island as they are made.
template <class T>
struct ClimateFields {
  std::span<T> temperature, temperature_range, precipitation, precipitation_seasonality, wind_east,
      wind_north, distance_to_coast, potential_evapotranspiration;
};

/// The island's surface: the planet's interpolated, and its own.
struct IslandHeights {
  std::span<const float> planet_elevation_m;  ///< on the planet
  std::span<const float> interpolated_m;      ///< on the island
  std::span<const float> elevation_m;         ///< on the island
};

/// The air over the whole planet.
struct IslandAir {
  double pressure_bar = 1.0;
  double aerosol = 0.0;  ///< as in blueprint_precipitation_mm_yr
};

/// The planet's climate at the island's true places, adapted to its surface.
///
/// Temperature: what the run's model makes of a place itself (height by the lapse rate; the
/// blueprint: latitude, sea and distance to it as well, eqs 5.1-5.3a) is taken off, the rest
/// interpolated, and the island's own put on.
/// Precipitation: interpolated, times exp(lift difference / lift height), where lift is that of the
/// fine surface less that of the interpolated one (`upwind_lift`), so that both join at the edge.
/// With the blueprint's climate, what wind and topography add (5.5-5.8) is interpolated, with 5.7
/// of the lift difference, and eq. 5.10 holds at the island's own heights and distances to the
/// coast. Potential evapotranspiration: interpolated, in proportion to what the formula of Oudin et
/// al. (2005) makes of the change in temperature. Distance to the coast: on the fine grid as far as
/// it reaches, the planet's beyond. Seasons and winds: interpolated.
void island_climate(const PlanetCells& cells, const ClimateParameters& climate,
                    const IslandAir& air, const IslandParameters& p, const IslandHeights& heights,
                    const ClimateFields<const float>& from, const ClimateFields<float>& to);

}  // namespace geo
