#pragma once

#include <span>

#include "geo/core/stage.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/climate/energy_balance.hpp"

namespace geo {

/// What particles above the weather do to the climate of the whole planet.
struct DimmedSun {
  double cooling_k = 0.0;
  double rain_left = 1.0;  ///< share of precipitation
  double aerosol = 0.0;    ///< optical depth that is left of all veils at present
};

/// The veil of all impacts together, in the coldest year that each still has before it. Leaves a
/// record of each with the context: the share of rain that is left or, with the blueprint's
/// `closed` formulas, the rain that is lost.
DimmedSun dim_the_sun(const EnergyBalance& model, const BlueprintClimate* closed, Context& context);

/// That optical depth alone.
double aerosol_of(std::span<const Event> events, const Planet& planet);

}  // namespace geo
