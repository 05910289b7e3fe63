#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "sample_sums.hpp"
#include "sphere_flood.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// Smaller pieces of continental crust are islands, and go with the floor about them.
constexpr double kContinent_km2 = 1e6;
/// Smaller pieces of floor stay, however large a plate must be to last.
constexpr double kSinking_km2 = 1e6;
/// How far along a margin the floor breaks that is old enough to go with it, in ages at which
/// subduction begins.
constexpr double kAlong = 0.75;

/// Floor beside the continent of its own plate, old enough to subduct: samples in order.
std::vector<std::int32_t> old_margins(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  constexpr std::int32_t kChunk = 8192;
  std::vector<std::vector<std::int32_t>> found((crust.size() + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t i = from; i < std::min(crust.size(), from + kChunk); ++i) {
      if (crust.plate[i] < 0 || crust.continental[i] != 0 || model.margins.hidden[i] != 0) continue;
      if (crust.age_myr[i] < model.settings.initiation_age_myr) continue;
      const auto ring = model.mesh->neighbours(i);
      const bool is_margin = std::any_of(ring.begin(), ring.end(), [&](std::int32_t j) {
        return crust.plate[j] == crust.plate[i] && crust.continental[j] != 0;
      });
      if (is_margin) found[chunk].push_back(i);
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(static)
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
  errors.rethrow();
  return joined(found);
}

/// The fragment of the nearest sample, but for the strip between the coasts of two lattices: its
/// floor breaks with the floor beside it, its land stays.
FragmentAt floor_that_breaks(const SphereTectonics& model, std::span<const std::int8_t> fragment) {
  const SphereCrust& crust = model.state.crust;
  constexpr std::int8_t kStays = 0, kBreaks = 1, kIsland = 2;
  std::vector<std::int8_t> place_of(crust.plate.size(), kStays);
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    const auto ring = model.mesh->neighbours(i);
    const bool is_beside =
        std::ranges::any_of(ring, [&](std::int32_t j) { return fragment[j] == 1; });
    if (fragment[i] == 1) {
      place_of[i] = crust.continental[i] != 0 ? kIsland : kBreaks;
    } else if (fragment[i] == 0 && crust.continental[i] != 0 && is_beside) {
      place_of[i] = kBreaks;
    }
  }
  return [&samples = model.mesh->samples(), place_of = std::move(place_of)](const Vector3& place,
                                                                            bool continental) {
    const std::int8_t there = place_of[samples.nearest(place)];
    return there == kIsland || (there == kBreaks && !continental) ? 1 : 0;
  };
}

/// Breaks the floor of a plate along the margin about a sample and sends it below the continent:
/// all that lies nearer to the old part of that margin than to any other. Nothing happens where
/// that is too small for a plate, or the margin that of an island.
void initiate_subduction(SphereTectonics& model, std::int32_t start) {
  const SphereCrust& crust = model.state.crust;
  const std::int16_t plate = crust.plate[start];
  const std::int32_t n = model.mesh->size();
  const auto is_own = [&](std::int32_t i) {
    return crust.plate[i] == plate && model.margins.hidden[i] == 0;
  };
  std::vector<std::uint8_t> seen(n, 0), is_continent(n, 0), is_margin(n, 0), is_old(n, 0);
  for (std::int32_t i = 0; i < n; ++i) {
    if (seen[i] != 0 || !is_own(i) || crust.continental[i] == 0) continue;
    const auto land = flooded_from(*model.mesh, i, seen, [&](std::int32_t j) {
      return is_own(j) && crust.continental[j] != 0;
    });
    if (model.sample_km2() * static_cast<double>(land.size()) < kContinent_km2) continue;
    for (const std::int32_t j : land) is_continent[j] = 1;
  }
  std::vector<std::int32_t> margin;
  for (std::int32_t i = 0; i < n; ++i) {
    if (!is_own(i) || is_continent[i] != 0) continue;
    for (const std::int32_t j : model.mesh->neighbours(i)) is_margin[i] |= is_continent[j];
    if (is_margin[i] != 0) margin.push_back(i);
  }
  if (is_margin[start] == 0) return;
  // Floor along the margin is narrow: samples beside it keep the line together.
  const double old_myr = kAlong * model.settings.initiation_age_myr;
  Vector3 shore{}, middle{};
  for (const std::int32_t i : flooded_from(*model.mesh, start, is_old, [&](std::int32_t j) {
         return is_margin[j] != 0 && crust.age_myr[j] >= old_myr;
       })) {
    shore = add(shore, model.mesh->samples().position(i));
  }
  const auto nearest = nearest_samples(*model.mesh, margin, std::numbers::pi);
  std::vector<std::uint8_t> breaks(n, 0);
  const auto sinking = flooded_from(*model.mesh, start, breaks, [&](std::int32_t j) {
    return is_own(j) && is_continent[j] == 0 && nearest[j] >= 0 && is_old[margin[nearest[j]]] != 0;
  });
  const double least_km2 = std::min(kSinking_km2, model.settings.smallest_piece_km2);
  if (model.sample_km2() * static_cast<double>(sinking.size()) < least_km2) return;
  for (const std::int32_t i : sinking) middle = add(middle, model.mesh->samples().position(i));
  std::vector<std::int8_t> fragment(n, -1);
  for (std::int32_t i = 0; i < n; ++i) {
    if (crust.plate[i] == plate) fragment[i] = static_cast<std::int8_t>(breaks[i]);
  }
  const Vector3 down = times(model.frame[plate], normalised(cross(middle, shore)));
  const std::vector<Vector3> turns{Vector3{}, down};
  const double speed_mm_yr = model.settings.initiation_speed_mm_yr;
  if (!part_plate(model, plate, fragment, turns, speed_mm_yr,
                  SphereEvent::Kind::subduction_initiation, floor_that_breaks(model, fragment)))
    return;
  model.events.back().area_km2 = model.sample_km2() * static_cast<double>(sinking.size());
  model.events.back().place = times(model.frame[plate], normalised(shore));
  ++model.budget.subduction_initiations;
}

/// A sample of a margin: the nearest to the first drawn place that has one near. Each place of the
/// margin has the same chance, however its samples lie.
std::int32_t drawn_from(const SphereTectonics& model, int plate,
                        std::span<const std::int32_t> margin, const DrawnPlaces& drawn) {
  constexpr double kNear_km = 500.0;
  constexpr std::uint64_t kMost = 20000;
  const double is_near = std::cos(std::min(3.1, kNear_km / model.settings.radius_km));
  for (std::uint64_t k = 0; k < kMost; ++k) {
    const Vector3 at = back(model.frame[plate], drawn[k]);
    const auto nearness = [&](std::int32_t i) {
      return dot(model.mesh->samples().position(i), at);
    };
    const std::int32_t nearest = *std::ranges::max_element(margin, {}, nearness);
    if (nearness(nearest) > is_near) return nearest;
  }
  return margin.front();
}

}  // namespace

/// Old floor at a passive margin breaks away from the continent and becomes a plate that subducts
/// below it: a Poisson process, at a rate for each length of margin whose floor is old enough.
void initiate_subduction_by_chance(SphereTectonics& model) {
  if (model.settings.initiation_per_myr <= 0.0) return;
  const RandomStream random(model.seed, "plates.foundering");
  const auto plates = static_cast<int>(model.state.plates.size());
  std::vector<std::vector<std::int32_t>> of_plate(plates);
  for (const std::int32_t i : old_margins(model)) of_plate[model.state.crust.plate[i]].push_back(i);
  const double sample_length = model.settings.radius_km * model.mesh->samples().spacing() / 1000.0;
  for (int p = 0; p < plates; ++p) {
    SpherePlate& plate = model.state.plates[p];
    if (of_plate[p].empty() || !plate.alive || plate.carrier >= 0 || plate.is_held) continue;
    const auto count = static_cast<double>(of_plate[p].size());
    const double expected =
        model.settings.initiation_per_myr * count * sample_length * model.settings.law.step_myr;
    const PlateChances now = plate.chances;
    if (!is_struck(plate.chances.initiation_hazard, expected, random, now, now.initiations)) {
      continue;
    }
    ++plate.chances.initiations;
    plate.chances.initiation_hazard = 0.0;
    initiate_subduction(
        model, drawn_from(model, p, of_plate[p], DrawnPlaces(random, now, now.initiations)));
  }
}

}  // namespace geo
