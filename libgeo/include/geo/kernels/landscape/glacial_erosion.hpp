#pragma once

#include <span>

#include "geo/core/cell_set.hpp"
#include "geo/core/grid.hpp"
#include "geo/kernels/landscape/plastic_ice.hpp"

namespace geo {

struct GlacialErosion {
  double abrasion = 7e-7;          ///< lowering of the bed over the way that ice has moved
  double overdeepening = 1.5;      ///< steepest climb of a bed over the slope of the ice above it
  double till_share = 0.3;         ///< of the debris that melts out and stays where it does
  double most_till_m = 60.0;       ///< laid on a cell at once
  double trough_m = 1.63;          ///< width of a trough for a flux of 1 m3 yr-1,
  double trough_exponent = 0.375;  ///< and the power of flux that it grows with
  double density_ratio = 910.0 / 1030.0;  ///< of ice and sea water
};

/// Lets ice work on its bed for `time_yr`. Ice of thickness H that carries a flux Q moves at u = Q
/// / (w H) in a trough of width w = c Q^p, at most the cell's (valleys': valley_width_m), and
/// lowers its bed by
///
///   dz/dt = -K u
///
/// (Humphrey & Raymond 1994; Hergarten 2021 for fluxes that go down a graph). p = 0.375 is that of
/// Bahr et al. (1997): width as length^0.6, flux as area; c from the Great Aletsch Glacier (1.5 km
/// wide, 80 km2 that feed it, 1 m a year). As the bed sinks H grows under a surface that stays: the
/// step is solved exactly, H² = H0² + 2 K Q t / w. A trough stays shallow enough that
///
/// - its bed climbs downstream no steeper than `overdeepening` times the slope of the ice, where
///   water under the ice freezes and lays down what it carries (Alley et al. 2003);
/// - below sea level ice does not float off it, and the sea reaches it: a cell sinks below 0 only
///   where one that its ice flows to has, others end 1 m above.
///
/// Debris goes with the ice and is let out where that melts: `till_share` stays there as moraine
/// and till, on land, the rest goes on with the water; what calves sinks at sea. Volumes taken
/// equal those laid and let out, counted from the heights as they are rounded.
///
/// `elevation_m`: rock, one value per cell, in and out. `sunk_m`: by how much the load holds the
/// bed below it, or empty. `flux`, `surface`: of that bed. Returns the volume that each cell lets
/// out to its water, m3. Cost: linear. One thread; the same bits always.
[[nodiscard]] SparseValues<double> erode_under_ice(const Grid& grid, const GlacialErosion& law,
                                                   double time_yr, const IceSurface& surface,
                                                   const IceFlux& flux,
                                                   std::span<const IceGround> ground,
                                                   std::span<const float> sunk_m,
                                                   std::span<float> elevation_m);

}  // namespace geo
