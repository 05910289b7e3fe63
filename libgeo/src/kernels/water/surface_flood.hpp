#pragma once

#include <span>

#include "geo/kernels/water/surface_rivers.hpp"

namespace geo::detail {

/// Drainage of land: order, receivers and distances, as `route_rivers` has them.
SurfaceRivers flood_land(const SurfaceGraph& graph, std::span<const float> z);

}  // namespace geo::detail
