#include <algorithm>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "sample_sums.hpp"
#include "sphere_flood.hpp"

namespace geo {
namespace {

constexpr auto kHimalayan = static_cast<std::int8_t>(OrogenyType::himalayan);
/// A plate that would keep less than this share of the mean area goes along with its terrane.
constexpr double kRemnant = 0.05;

}  // namespace

std::vector<std::int32_t> SphereTectonics::terrane_of(std::int32_t sample) const {
  const SphereCrust& crust = state_.crust;
  const std::int16_t plate = crust.plate[sample];
  std::vector<std::uint8_t> seen(crust.plate.size(), 0);
  return flooded_from(*mesh_, sample, seen, [&](std::int32_t j) {
    return crust.plate[j] == plate && crust.continental[j] != 0;
  });
}

/// Continents that have gone far enough below another one collide with it.
void SphereTectonics::collide() {
  const SphereCrust& crust = state_.crust;
  const auto count = static_cast<std::int32_t>(contacts_.size());
  const double needed_km = settings_.merge_plates ? 0.0 : settings_.penetration_km;
  constexpr std::int32_t kChunk = 1024;
  std::vector<std::vector<std::int32_t>> found((count + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t k = from; k < std::min(count, from + kChunk); ++k) {
      const std::int32_t i = contacts_[k], above = partner_[i];
      if (hidden_[i] == 0 || crust.continental[i] == 0 || crust.continental[above] == 0) continue;
      const std::int32_t trench = trench_of_[above];
      if (trench < 0 || trenches_[trench].lower != crust.plate[i]) continue;
      const double still_km = needed_km - pair_of(i).under_km;
      if (distance_km(above, trenches_[trench].sample) < still_km) continue;
      if (penetration_km(i) < still_km) continue;
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
    if (crust.plate[i] < 0 || crust.plate[partner_[i]] < 0) continue;
    if (state_.root(crust.plate[i]) == state_.root(crust.plate[partner_[i]])) continue;
    collide(i);
    changed = true;
  }
  if (changed) repartition();
}

/// Before all crust is resampled, and what lies below a continent becomes its root: pairs remember
/// how far they have come by then, as far as it would have counted.
void SphereTectonics::remember_penetration() {
  const SphereCrust& crust = state_.crust;
  std::vector<float> farthest_km(state_.pairs.size(), 0.0F);
  for (const std::int32_t i : contacts_) {
    const std::int32_t above = partner_[i];
    if (hidden_[i] == 0 || crust.plate[i] < 0 || crust.plate[above] < 0) continue;
    if (crust.continental[i] == 0 || crust.continental[above] == 0) continue;
    const std::int32_t trench = trench_of_[above];
    if (trench < 0 || trenches_[trench].lower != crust.plate[i]) continue;
    const double gone_km =
        std::min(distance_km(above, trenches_[trench].sample), penetration_km(i));
    float& most_km = farthest_km[&pair_of(i) - state_.pairs.data()];
    most_km = std::max(most_km, static_cast<float>(gone_km));
  }
  for (std::size_t k = 0; k < farthest_km.size(); ++k) {
    float& under_km = state_.pairs[k].under_km;
    under_km = farthest_km[k] > 0.0F ? under_km + farthest_km[k] : 0.0F;
  }
}

/// The pair that moves as a sample and what it touches do.
const PlatePair& SphereTectonics::pair_of(std::int32_t sample) const {
  const auto& plate = state_.crust.plate;
  return state_.pair(state_.root(plate[sample]), state_.root(plate[partner_[sample]]));
}

/// How far a sample has been thrust below another plate: back along the way by which it has come
/// since all crust was resampled, when no plates overlapped, to that plate's edge, which it finds
/// to a quarter of the spacing. Never more than that way itself.
double SphereTectonics::penetration_km(std::int32_t sample) const {
  const FibonacciSphere& samples = mesh_->samples();
  const int lower = state_.crust.plate[sample], upper = state_.crust.plate[partner_[sample]];
  const Vector3& from = samples.position(sample);  // in the frame of the plate above
  const Vector3 here = times(back_times(frame_[upper], frame_[lower]), from);
  const double way = angle_between(here, from);
  const Vector3 home = normalised(cross(here, from));
  const double half = 0.5 * samples.spacing();
  double gone = 0.0;
  while (gone < way && state_.crust.plate[samples.nearest(rotated(here, scaled(home, gone)))] ==
                           static_cast<std::int16_t>(upper)) {
    gone += half;
  }
  return settings_.radius_km * std::clamp(gone - 0.5 * half, 0.0, way);
}

/// Slab break, suture and surge: the terrane that holds `sample` comes to its partner's plate.
void SphereTectonics::collide(std::int32_t sample) {
  SphereCrust& crust = state_.crust;
  const FibonacciSphere& samples = mesh_->samples();
  const int lower = crust.plate[sample], upper = crust.plate[partner_[sample]];
  const std::vector<std::int32_t> terrane = terrane_of(sample);
  const double area_km2 = sample_km2() * static_cast<double>(terrane.size());
  Vector3 sum{};
  for (const std::int32_t i : terrane) sum = add(sum, samples.position(i));
  const Vector3 centroid = times(frame_[lower], normalised(sum));
  // Of what drives them: their continents have slowed each other by now.
  const Vector3 relative = add(driven_rotation(lower), driven_rotation(upper), -1.0);
  const double speed_mm_yr = settings_.radius_km * length(cross(relative, centroid));
  surge(upper, terrane, centroid, area_km2, speed_mm_yr);
  state_.pair(lower, state_.root(upper)).under_km = 0.0F;

  SpherePlate body = state_.plates[lower];
  body.id = -1;
  body.carrier = static_cast<std::int16_t>(upper);
  body.born_myr = state_.time_myr;
  // What has come off a plate in this step is a terrane as a whole.
  const bool is_whole = lower >= partition_.plates();
  const double rest_km2 =
      is_whole
          ? 0.0
          : sample_km2() * (partition_.cap(lower).samples - static_cast<double>(terrane.size()));
  if (settings_.merge_plates || rest_km2 < kRemnant * settings_.mean_area_km2) {
    const int root = state_.root(upper);
    state_.plates[lower].carrier = static_cast<std::int16_t>(root);
    state_.end_life(state_.plates[lower].id, state_.plates[root].id);
  } else {
    const int carried = state_.add_plate(body);
    for (const std::int32_t i : terrane) {
      if (crust.plate[i] >= 0) crust.plate[i] = static_cast<std::int16_t>(carried);
    }
  }
  set_frames();
  ++budget_.collisions;
  events_.push_back(
      {SphereEvent::Kind::collision, state_.time_myr, lower, upper, centroid, area_km2});
}

/// Mountains of the collided plate around a terrane. The crust that the terrane had pushed below is
/// consumed and given back as their roots: the profile and the reach are those of 4.2, its height
/// at most `surge_km`, and its reach drawn in until its volume is what was swallowed.
void SphereTectonics::surge(int upper, std::span<const std::int32_t> terrane,
                            const Vector3& centroid, double area_km2, double speed_mm_yr) {
  SphereCrust& crust = state_.crust;
  const FibonacciSphere& samples = mesh_->samples();
  const SphereSettings& s = settings_;
  double swallowed_km3 = 0.0;
  std::vector<std::int32_t> queue, next, reached;
  std::fill(chord2_.begin(), chord2_.end(), 9.0F);
  std::vector<std::int32_t> source(crust.plate.size(), -1);
  for (const std::int32_t i : terrane) {
    const std::int32_t above = partner_[i];
    if (hidden_[i] == 0 || above < 0 || crust.plate[above] != upper) continue;
    swallowed_km3 += sample_km2() * 1e-3 * crust.thickness_m[i];
    crust.plate[i] = -1;
    if (source[above] >= 0) continue;
    source[above] = above;
    chord2_[above] = 0.0F;
    queue.push_back(above);
  }
  const double reach_km = collision_radius_km(speed_mm_yr, area_km2, s.mean_area_km2, s.law);
  const double half = std::sin(0.5 * std::min(reach_km / s.radius_km, 3.1));
  const auto most = static_cast<float>(4.0 * half * half);
  reached = queue;
  while (!queue.empty()) {
    next.clear();
    for (const std::int32_t i : queue) {
      for (const std::int32_t j : mesh_->neighbours(i)) {
        if (crust.plate[j] != upper || crust.continental[j] == 0 || source[j] == source[i])
          continue;
        const Vector3 way = add(samples.position(j), samples.position(source[i]), -1.0);
        const auto chord2 = static_cast<float>(dot(way, way));
        if (chord2 >= most || chord2 >= chord2_[j]) continue;
        if (source[j] < 0) reached.push_back(j);
        source[j] = source[i];
        chord2_[j] = chord2;
        next.push_back(j);
      }
    }
    queue.swap(next);
  }
  const double height_km =
      std::min(s.surge_km, collision_surge_km(area_km2, 0.0, std::max(reach_km, 1.0), s.law));
  std::vector<double> far_km;
  for (const std::int32_t i : reached) far_km.push_back(distance_km(i, source[i]));
  const auto lifted_km = [&](std::size_t k, double radius_km) {
    const double above = std::max(0.0, s.law.summit_km - 1e-3 * crust.elevation_m[reached[k]]);
    return std::min(above, height_km * collision_profile(far_km[k], radius_km));
  };
  const auto volume_km3 = [&](double radius_km) {
    double sum = 0.0;
    for (std::size_t k = 0; k < reached.size(); ++k) sum += lifted_km(k, radius_km);
    return sample_km2() * s.rebound * sum;
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
  const double rest_km = reached.empty() ? 0.0
                                         : (swallowed_km3 - given_km3) /
                                               (sample_km2() * static_cast<double>(reached.size()));
  const Vector3 q = back(frame_[upper], centroid);
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
  budget_.swallowed_km3 += swallowed_km3;
  if (reached.empty()) budget_.lost_km3 += swallowed_km3;
}

}  // namespace geo
