#pragma once

#include "geo/core/stage.hpp"
#include "geo/kernels/energy_balance.hpp"

namespace geo {

/// What particles above the weather do to the climate of the whole planet.
struct DimmedSun {
  double cooling_k = 0.0;
  double rain_left = 1.0;  ///< share of precipitation
};

/// The veil of all impacts together, in the coldest year that each still has before it. Leaves a
/// record of each with the context.
DimmedSun dim_the_sun(const EnergyBalance& model, Context& context);

}  // namespace geo
