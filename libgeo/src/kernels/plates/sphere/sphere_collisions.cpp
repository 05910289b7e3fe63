#include <algorithm>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "sample_sums.hpp"
#include "sphere_flood.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

constexpr auto kHimalayan = static_cast<std::int8_t>(OrogenyType::himalayan);
/// A plate that would keep less than this share of the mean area goes along with its terrane.
constexpr double kRemnant = 0.05;

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

/// Mountains of the collided plate around a terrane. The crust that the terrane had pushed below is
/// consumed and given back as their roots: the profile and the reach are those of 4.2, its height
/// at most `surge_km`, and its reach drawn in until its volume is what was swallowed.
void surge(SphereTectonics& model, int upper, std::span<const std::int32_t> terrane,
           const Vector3& centroid, double area_km2, double speed_mm_yr) {
  SphereCrust& crust = model.state.crust;
  const FibonacciSphere& samples = model.mesh->samples();
  const SphereSettings& s = model.settings;
  double swallowed_km3 = 0.0;
  std::vector<std::int32_t> queue, next, reached;
  std::vector<float> chord2_to(crust.plate.size(), 9.0F);
  std::vector<std::int32_t> source(crust.plate.size(), -1);
  for (const std::int32_t i : terrane) {
    const std::int32_t above = model.margins.partner[i];
    if (model.margins.hidden[i] == 0 || above < 0 || crust.plate[above] != upper) continue;
    swallowed_km3 += model.sample_km2() * 1e-3 * crust.thickness_m[i];
    crust.plate[i] = -1;
    if (source[above] >= 0) continue;
    source[above] = above;
    chord2_to[above] = 0.0F;
    queue.push_back(above);
  }
  const double reach_km = collision_radius_km(speed_mm_yr, area_km2, s.mean_area_km2, s.law);
  const double half = std::sin(0.5 * std::min(reach_km / s.radius_km, 3.1));
  const auto most = static_cast<float>(4.0 * half * half);
  reached = queue;
  while (!queue.empty()) {
    next.clear();
    for (const std::int32_t i : queue) {
      for (const std::int32_t j : model.mesh->neighbours(i)) {
        if (crust.plate[j] != upper || crust.continental[j] == 0 || source[j] == source[i])
          continue;
        const Vector3 way = add(samples.position(j), samples.position(source[i]), -1.0);
        const auto chord2 = static_cast<float>(dot(way, way));
        if (chord2 >= most || chord2 >= chord2_to[j]) continue;
        if (source[j] < 0) reached.push_back(j);
        source[j] = source[i];
        chord2_to[j] = chord2;
        next.push_back(j);
      }
    }
    queue.swap(next);
  }
  const double height_km =
      std::min(s.surge_km, collision_surge_km(area_km2, 0.0, std::max(reach_km, 1.0), s.law));
  std::vector<double> far_km;
  for (const std::int32_t i : reached) far_km.push_back(model.distance_km(i, source[i]));
  const auto lifted_km = [&](std::size_t k, double radius_km) {
    const double above = std::max(0.0, s.law.summit_km - 1e-3 * crust.elevation_m[reached[k]]);
    return std::min(above, height_km * collision_profile(far_km[k], radius_km));
  };
  const auto volume_km3 = [&](double radius_km) {
    double sum = 0.0;
    for (std::size_t k = 0; k < reached.size(); ++k) sum += lifted_km(k, radius_km);
    return model.sample_km2() * s.rebound * sum;
  };
  double low = 0.0, high = std::max(reach_km, 1.0);
  if (volume_km3(high) > swallowed_km3) {
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (low + high);
      (volume_km3(middle) > swallowed_km3 ? high : low) = middle;
    }
    high = low;
  }
  // What the profile does not take thickens the crust above what was swallowed.
  const double given_km3 = volume_km3(high);
  const double rest_km = reached.empty()
                             ? 0.0
                             : (swallowed_km3 - given_km3) /
                                   (model.sample_km2() * static_cast<double>(reached.size()));
  const Vector3 q = back(model.frame[upper], centroid);
  WholeGains gains;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const std::int32_t i = reached[k];
    const double lifted = lifted_km(k, high);
    const double thicker_m = 1e3 * (s.rebound * lifted + rest_km);
    const double raised_m = height_after(crust.elevation_m[i], thicker_m, s.rebound);
    crust.elevation_m[i] = static_cast<float>(std::min(1e3 * s.law.summit_km, raised_m));
    gains.put(crust.thickness_m[i], thicker_m);
    if (lifted < 0.02) continue;
    crust.orogeny[i] = kHimalayan;
    crust.orogeny_age_myr[i] = 0.0F;
    const Vector3 fold = collision_fold(samples.position(i), q);
    for (int c = 0; c < 3; ++c) crust.fold[i][c] = static_cast<float>(fold[c]);
  }
  model.budget.swallowed_km3 += swallowed_km3;
  if (reached.empty()) model.budget.lost_km3 += swallowed_km3;
}

/// Slab break, suture and surge: the terrane that holds `sample` comes to its partner's plate.
void collide(SphereTectonics& model, std::int32_t sample) {
  SphereCrust& crust = model.state.crust;
  const FibonacciSphere& samples = model.mesh->samples();
  const int lower = crust.plate[sample], upper = crust.plate[model.margins.partner[sample]];
  const std::vector<std::int32_t> terrane = terrane_of(model, sample);
  const double area_km2 = model.sample_km2() * static_cast<double>(terrane.size());
  Vector3 sum{};
  for (const std::int32_t i : terrane) sum = add(sum, samples.position(i));
  const Vector3 centroid = times(model.frame[lower], normalised(sum));
  // Of what drives them: their continents have slowed each other by now.
  const Vector3 relative =
      add(driven_rotation(model.state, lower), driven_rotation(model.state, upper), -1.0);
  const double speed_mm_yr = model.settings.radius_km * length(cross(relative, centroid));
  surge(model, upper, terrane, centroid, area_km2, speed_mm_yr);
  model.state.pair(lower, model.state.root(upper)).under_km = 0.0F;

  SpherePlate body = model.state.plates[lower];
  body.id = -1;
  body.carrier = static_cast<std::int16_t>(upper);
  body.born_myr = model.state.time_myr;
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
    for (const std::int32_t i : terrane) {
      if (crust.plate[i] >= 0) crust.plate[i] = static_cast<std::int16_t>(carried);
    }
  }
  derive_motion(model);
  ++model.budget.collisions;
  model.events.push_back(
      {SphereEvent::Kind::collision, model.state.time_myr, lower, upper, centroid, area_km2});
}

}  // namespace

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
      const double still_km = needed_km - pair_of(model, i).under_km;
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
