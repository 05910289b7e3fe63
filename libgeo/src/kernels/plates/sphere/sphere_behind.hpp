#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "geo/core/random.hpp"
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

/// Some of the trenches of each plate, by their numbers.
using TrenchesOfPlates = std::vector<std::vector<std::int32_t>>;

/// The trenches of each plate of which something is true, asked of the samples at their edges.
template <class IsWanted>
TrenchesOfPlates trenches_where(const SphereTectonics& model, IsWanted&& is_wanted) {
  TrenchesOfPlates of_plate(model.state.plates.size());
  for (std::size_t k = 0; k < model.margins.trenches.size(); ++k) {
    const std::int32_t edge = model.margins.trenches[k].sample;
    if (model.state.crust.plate[edge] < 0 || !is_wanted(edge)) continue;
    of_plate[model.state.crust.plate[edge]].push_back(static_cast<std::int32_t>(k));
  }
  return of_plate;
}

/// Each length of trench acts at a rate, per Myr and 1000 km: a Poisson process without a memory,
/// at most once a step for each free plate that may. The stream of random numbers is named.
template <class May, class Act>
void act_by_chance(SphereTectonics& model, const TrenchesOfPlates& trenches, double rate,
                   std::string_view stream, May&& may, Act&& act) {
  const RandomStream random(model.seed, stream);
  const double sample_length = model.settings.radius_km * model.mesh->samples().spacing() / 1000.0;
  for (int p = 0; p < std::ssize(trenches); ++p) {
    const SpherePlate& plate = model.state.plates[p];
    if (trenches[p].empty() || !is_free(plate) || !may(p)) continue;
    const auto count = static_cast<double>(trenches[p].size());
    const double expected = rate * count * sample_length * model.settings.law.step_myr;
    const std::uint64_t descent = plate.chances.descent;
    const auto step = static_cast<std::int32_t>(model.state.steps);
    if (random.uniform(descent, draw_of(step, 0)) >= -std::expm1(-expected)) continue;
    const auto drawn = static_cast<std::size_t>(count * random.uniform(descent, draw_of(step, 1)));
    act(p, trenches[p][std::min(drawn, trenches[p].size() - 1)]);
  }
}

}  // namespace geo
