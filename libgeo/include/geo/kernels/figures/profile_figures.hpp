#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Rivers laid over elevations alone: steepest descent, across depressions over their lowest pass,
/// to the sea. The same for any topography, so that the Earth's and a planet's figures can be
/// compared: neither what a climate evaporates nor what a planet's own rivers have cut has a say in
/// it.
struct LaidRivers {
  std::vector<Index> receiver;          ///< itself at sea
  std::vector<double> area_m2;          ///< upstream, the cell included
  std::vector<std::int32_t> basin;      ///< number of its basin, 0 at sea
  std::vector<float> fall_m, length_m;  ///< to the receiver, the sea's surface counting as 0
};

/// One value of elevation per cell (InputError otherwise); land is 0 and above. Cost: linear.
LaidRivers lay_rivers(const Grid& grid, std::span<const float> elevation_m);

/// Land between two parallels of the same distance from the equator: figures of rivers leave out
/// the ice sheets, whose surface no river has made.
struct LatitudeBand {
  double poleward_deg = 90.0;
};

/// Mean slope of the rivers that drain at least `least_area_m2`: their whole fall over their whole
/// length. Falls add up along a river, so that cells that stand above the one before (a valley
/// narrower than a cell) do not count. NaN without such rivers.
double river_slope(const Grid& grid, const LaidRivers& rivers, double least_area_m2,
                   LatitudeBand band);

/// Concavity: the exponent theta of S ~ A^-theta (Flint 1974), by least squares in logarithms over
/// mean slopes (fall over length) in steps of a fifth of a decade of area, between two areas. Steps
/// of fewer than ten cells, or that do not fall, do not count; NaN with fewer than three left.
double concavity(const Grid& grid, const LaidRivers& rivers, double from_m2, double to_m2,
                 LatitudeBand band);

/// Channel steepness S A^theta, m^(2 theta), in cells that drain at least `least_area_m2` on land
/// of the band; NaN elsewhere (Wobus et al. 2006).
std::vector<float> channel_steepness(const Grid& grid, const LaidRivers& rivers, double theta,
                                     double least_area_m2, LatitudeBand band);

/// Hypsometric integral (mean - lowest) / (highest - lowest) (Pike & Wilson 1971) of
/// the heights of each basin of at least `least_area_m2` that is not level and whose last cell on
/// land lies in the band.
std::vector<double> hypsometric_integrals(const Grid& grid, std::span<const float> elevation_m,
                                          const LaidRivers& rivers, double least_area_m2,
                                          LatitudeBand band);

}  // namespace geo
