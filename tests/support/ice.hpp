#pragma once

#include <span>

#include "geo/kernels/landscape/plastic_ice.hpp"

namespace geo::test {

/// Of values of all cells those that a surface of ice has.
inline SparseValues<float> of_surface(const IceSurface& surface, std::span<const float> values) {
  SparseValues<float> held(surface.height_m.set());
  held.set()->visit([&](Index cell) { held.of(cell) = values[cell]; });
  return held;
}

}  // namespace geo::test
