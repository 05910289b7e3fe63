#pragma once

#include <cstdint>
#include <vector>

#include "sphere_flood.hpp"
#include "sphere_steps.hpp"

namespace geo {

/// What of an overriding plate lies behind a stretch of one of its trenches (its number), as long
/// and as wide as is asked: connected samples that may be entered, nearest first. Needs margins.
template <class MayEnter>
std::vector<std::int32_t> behind_trench(const SphereTectonics& model, std::int32_t trench,
                                        double long_km, double wide_km, MayEnter&& may_enter) {
  const SphereMargins& margins = model.margins;
  const std::int32_t start = margins.trenches[trench].sample;
  const std::int16_t plate = model.state.crust.plate[start];
  std::vector<std::uint8_t> seen(model.mesh->size(), 0);
  return flooded_from(*model.mesh, start, seen, [&](std::int32_t i) {
    if (model.state.crust.plate[i] != plate || margins.nearest_trench[i] < 0) return false;
    const std::int32_t edge = margins.trenches[margins.nearest_trench[i]].sample;
    return model.distance_km(edge, start) < 0.5 * long_km && model.distance_km(edge, i) < wide_km &&
           may_enter(i);
  });
}

}  // namespace geo
