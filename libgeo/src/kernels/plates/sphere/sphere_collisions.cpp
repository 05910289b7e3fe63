#include <algorithm>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "sample_sums.hpp"
#include "sphere_flood.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// A plate that would keep less than this share of the mean area goes along with its terrane.
constexpr double kRemnant = 0.05;

/// Continents that have all but stopped grow together once one is thrust this far below the other.
constexpr double kSuture_km = 300.0;

std::vector<std::int32_t> terrane_of(const SphereTectonics& model, std::int32_t sample) {
  const SphereCrust& crust = model.state.crust;
  const std::int16_t plate = crust.plate[sample];
  std::vector<std::uint8_t> seen(crust.plate.size(), 0);
  return flooded_from(*model.mesh, sample, seen, [&](std::int32_t j) {
    return crust.plate[j] == plate && crust.continental[j] != 0;
  });
}

/// The pair that moves as a sample and what it touches do.
const PlatePair& pair_of(const SphereTectonics& model, std::int32_t sample) {
  const auto& plate = model.state.crust.plate;
  return model.state.pair(model.state.root(plate[sample]),
                          model.state.root(plate[model.margins.partner[sample]]));
}

/// Whether a sample and what it touches hardly move beside each other any more.
bool is_still(const SphereTectonics& model, std::int32_t sample) {
  const auto& plate = model.state.crust.plate;
  const int lower = plate[sample], upper = plate[model.margins.partner[sample]];
  const Vector3 at = times(model.frame[lower], model.mesh->samples().position(sample));
  const Vector3 relative = add(model.rotation[lower], model.rotation[upper], -1.0);
  return model.settings.radius_km * length(cross(relative, at)) < model.settings.suturing_mm_yr;
}

/// How far a sample has been thrust below another plate: back along the way by which it has come
/// since all crust was resampled, when no plates overlapped, to that plate's edge, which it finds
/// to a quarter of the spacing. Never more than that way itself.
double penetration_km(const SphereTectonics& model, std::int32_t sample) {
  const FibonacciSphere& samples = model.mesh->samples();
  const int lower = model.state.crust.plate[sample],
            upper = model.state.crust.plate[model.margins.partner[sample]];
  const Vector3& from = samples.position(sample);  // in the frame of the plate above
  const Vector3 here = times(back_times(model.frame[upper], model.frame[lower]), from);
  const double way = angle_between(here, from);
  const Vector3 home = normalised(cross(here, from));
  const double half = 0.5 * samples.spacing();
  double gone = 0.0;
  while (gone < way &&
         model.state.crust.plate[samples.nearest(rotated(here, scaled(home, gone)))] ==
             static_cast<std::int16_t>(upper)) {
    gone += half;
  }
  return model.settings.radius_km * std::clamp(gone - 0.5 * half, 0.0, way);
}

/// Middle of samples of a plate, in the frame of the planet.
Vector3 centroid_of(const SphereTectonics& model, int plate,
                    std::span<const std::int32_t> terrane) {
  Vector3 sum{};
  for (const std::int32_t i : terrane) sum = add(sum, model.mesh->samples().position(i));
  return times(model.frame[plate], normalised(sum));
}

/// Whether crust of a plate is in a terrane of it, by the nearest sample.
FragmentAt is_in(const SphereTectonics& model, std::span<const std::int32_t> terrane) {
  std::vector<std::uint8_t> holds(model.mesh->size(), 0);
  for (const std::int32_t i : terrane) {
    holds[i] = 1;
    for (const std::int32_t j : model.mesh->neighbours(i)) {
      // Coasts of other samples lie up to one spacing farther out.
      if (model.state.crust.continental[j] == 0) holds[j] = 1;
    }
  }
  return [&samples = model.mesh->samples(), holds = std::move(holds)](const Vector3& place,
                                                                      bool continental) {
    return continental && holds[samples.nearest(place)] != 0 ? 1 : 0;
  };
}

/// Slab break, suture and surge: the terrane that holds `sample` comes to its partner's plate.
void collide(SphereTectonics& model, std::int32_t sample) {
  SphereCrust& crust = model.state.crust;
  const int lower = crust.plate[sample], upper = crust.plate[model.margins.partner[sample]];
  const std::vector<std::int32_t> terrane = terrane_of(model, sample);
  const double area_km2 = model.sample_km2() * static_cast<double>(terrane.size());
  const Vector3 centroid = centroid_of(model, lower, terrane);
  // Of what drives them: their continents have slowed each other by now.
  const Vector3 relative =
      add(driven_rotation(model.state, lower), driven_rotation(model.state, upper), -1.0);
  const double speed_mm_yr = model.settings.radius_km * length(cross(relative, centroid));
  PlateChange change{.kind = PlateChange::Kind::collision,
                     .plate = lower,
                     .part_at = is_in(model, terrane),
                     .becomes = {lower, -1},
                     .upper = upper,
                     .speed_mm_yr = speed_mm_yr};
  collide_terrane(model, lower, upper, terrane, speed_mm_yr);
  model.state.pair(lower, model.state.root(upper)).under_km = 0.0F;

  SpherePlate body = model.state.plates[lower];
  body.id = -1;
  body.carrier = static_cast<std::int16_t>(upper);
  body.born_myr = model.state.time_myr;
  body.chances = {.descent = descent_from(model, body.chances, Descent::terrane, 0)};
  // What has come off a plate in this step is a terrane as a whole.
  const bool is_whole = lower >= model.partition.plates();
  const double rest_km2 = is_whole ? 0.0
                                   : model.sample_km2() * (model.partition.cap(lower).samples -
                                                           static_cast<double>(terrane.size()));
  if (model.settings.merge_plates || rest_km2 < kRemnant * model.settings.mean_area_km2) {
    const int root = model.state.root(upper);
    model.state.plates[lower].carrier = static_cast<std::int16_t>(root);
    model.state.end_life(model.state.plates[lower].id, model.state.plates[root].id);
  } else {
    const int carried = model.state.add_plate(body);
    change.becomes[1] = carried;
    for (const std::int32_t i : terrane) {
      if (crust.plate[i] >= 0) crust.plate[i] = static_cast<std::int16_t>(carried);
    }
  }
  model.step.changes.push_back(std::move(change));
  derive_motion(model);
  ++model.budget.collisions;
  model.events.push_back(
      {SphereEvent::Kind::collision, model.state.time_myr, lower, upper, centroid, area_km2});
}

}  // namespace

void collide_terrane(SphereTectonics& model, int lower, int upper,
                     std::span<const std::int32_t> terrane, double speed_mm_yr) {
  surge(model, {.upper = upper,
                .terrane = terrane,
                .centroid = centroid_of(model, lower, terrane),
                .area_km2 = model.sample_km2() * static_cast<double>(terrane.size()),
                .speed_mm_yr = speed_mm_yr});
}

/// Continents that have gone far enough below another one collide with it.
void collide_continents(SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  const auto count = static_cast<std::int32_t>(model.margins.contacts.size());
  const double needed_km = model.settings.merge_plates ? 0.0 : model.settings.penetration_km;
  constexpr std::int32_t kChunk = 1024;
  std::vector<std::vector<std::int32_t>> found((count + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t k = from; k < std::min(count, from + kChunk); ++k) {
      const std::int32_t i = model.margins.contacts[k], above = model.margins.partner[i];
      if (model.margins.hidden[i] == 0 || crust.continental[i] == 0 ||
          crust.continental[above] == 0)
        continue;
      const std::int32_t trench = model.margins.nearest_trench[above];
      if (trench < 0 || model.margins.trenches[trench].lower != crust.plate[i]) continue;
      const double still_km = (is_still(model, i) ? std::min(needed_km, kSuture_km) : needed_km) -
                              pair_of(model, i).under_km;
      if (model.distance_km(above, model.margins.trenches[trench].sample) < still_km) continue;
      if (penetration_km(model, i) < still_km) continue;
      found[chunk].push_back(i);
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
  errors.rethrow();
  bool changed = false;
  for (const std::int32_t i : joined(found)) {
    // Consumed or detached by a collision before it in this step.
    if (crust.plate[i] < 0 || crust.plate[model.margins.partner[i]] < 0) continue;
    if (model.state.root(crust.plate[i]) == model.state.root(crust.plate[model.margins.partner[i]]))
      continue;
    collide(model, i);
    changed = true;
  }
  if (changed) derive_plates(model);
}

/// Before all crust is resampled, and what lies below a continent becomes its root: pairs remember
/// how far they have come by then, as far as it would have counted.
void remember_penetration(SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  std::vector<float> farthest_km(model.state.pairs.size(), 0.0F);
  for (const std::int32_t i : model.margins.contacts) {
    const std::int32_t above = model.margins.partner[i];
    if (model.margins.hidden[i] == 0 || crust.plate[i] < 0 || crust.plate[above] < 0) continue;
    if (crust.continental[i] == 0 || crust.continental[above] == 0) continue;
    const std::int32_t trench = model.margins.nearest_trench[above];
    if (trench < 0 || model.margins.trenches[trench].lower != crust.plate[i]) continue;
    const double gone_km = std::min(model.distance_km(above, model.margins.trenches[trench].sample),
                                    penetration_km(model, i));
    float& most_km = farthest_km[&pair_of(model, i) - model.state.pairs.data()];
    most_km = std::max(most_km, static_cast<float>(gone_km));
  }
  for (std::size_t k = 0; k < farthest_km.size(); ++k) {
    float& under_km = model.state.pairs[k].under_km;
    under_km = farthest_km[k] > 0.0F ? under_km + farthest_km[k] : 0.0F;
  }
}

}  // namespace geo
