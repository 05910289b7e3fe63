#pragma once

#include <span>
#include <vector>

#include "geo/kernels/water/surface_rivers.hpp"

namespace geo::detail {

/// What rivers bring to places of the sea, m3 of rock, and what has no place there.
struct SeaLoad {
  std::vector<double> at_place_m3;
  double rest_m3 = 0.0;
};

/// Lays it, as `run_rivers` has it. Returns the volume laid.
double settle_in_sea(const SurfaceGraph& graph, const RiverLaw& law, const SeaLoad& load,
                     std::span<float> z, std::span<float> rock_m);

}  // namespace geo::detail
