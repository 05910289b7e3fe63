#pragma once

#include <vector>

#include "coarse_grid.hpp"
#include "crust.hpp"
#include "geo/kernels/convergent_margins.hpp"

namespace geo {

/// What plate boundaries do to the crust, and its broad variation, on the coarse grid.
struct Tectonics {
  std::vector<float> convergent, divergent, transform, weakness;  // 0 to 1
  std::vector<float> thickening, arc, trench_m;                   // cross sections of margins
  std::vector<float> rift_km;                 // distance to divergent boundaries
  std::vector<float> offshore_km, inland_km;  // distance to continental crust, to the ocean's
  std::vector<float> thickness_noise_km, swell_m, ocean_swell, relict;
  std::vector<float> flexure_m;
  ConvergentMargins margins;  // of a margins crust alone
};

/// Deformation that dies away from boundaries, and distances (blueprint 3.2).
Tectonics deform(const Crust& crust, const CoarseGrid& coarse);

/// Cross sections of convergent margins, old belts, broad variation of continents and sea floor.
void cut_sections(const Crust& crust, const CoarseGrid& coarse, Tectonics& tectonics);

}  // namespace geo
