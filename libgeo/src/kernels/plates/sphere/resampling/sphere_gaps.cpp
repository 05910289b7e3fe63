#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/sphere/resampling/sphere_ridges.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// How plates have moved since the last resampling, and so when what lies open now has opened.
class GapHistory {
 public:
  explicit GapHistory(const SphereState& state) : time_myr_(state.past_myr) {
    time_myr_.push_back(state.time_myr);
    for (const SpherePlate& plate : state.plates) {
      std::vector<Matrix3>& frames = frames_.emplace_back();
      for (const Quaternion& turn : plate.past) frames.push_back(turn.matrix());
      frames.push_back(plate.turn.matrix());
    }
  }
  /// Age of the floor at a place between two bodies, a share of the way from the ridge to the
  /// nearer one: the time in which that share of what has parted them there did so. They part from
  /// when they were closest, so that no floor is older than the rift, the reversal or the collision
  /// that made their boundary.
  [[nodiscard]] double age_myr(const Vector3& place, const Vector3& to_farther, int nearer,
                               int farther, double share) const {
    const std::vector<double> opened = opening(place, to_farther, nearer, farther);
    const double whole = *std::max_element(opened.begin(), opened.end());
    if (whole <= 0.0) return 0.0;
    const double wanted = share * whole * (1.0 - kRoundOff);
    auto k = std::ssize(opened) - 1;
    while (opened[k] < wanted) --k;
    const double now_myr = time_myr_.back();
    if (k + 1 == std::ssize(opened)) return 0.0;
    const double part = (wanted - opened[k + 1]) / (opened[k] - opened[k + 1]);
    return now_myr - (time_myr_[k + 1] + part * (time_myr_[k] - time_myr_[k + 1]));
  }

 private:
  static constexpr double kRoundOff = 1e-9;
  /// Least share of the whole motion that is across a gap where plates part; where it is less they
  /// pass each other, and any motion counts.
  static constexpr double kAcross = 0.25;

  /// By how much the bodies have parted since each of the times, radians.
  [[nodiscard]] std::vector<double> opening(const Vector3& place, const Vector3& to_farther,
                                            int nearer, int farther) const {
    const auto &near = frames_[nearer], &far = frames_[farther];
    const Vector3 own = back(near.back(), place), foreign = back(far.back(), place);
    const Vector3 across = back(near.back(), normalised(tangent(to_farther, place)));
    std::vector<double> apart, moved;
    for (std::size_t k = 0; k < time_myr_.size(); ++k) {
      // Where the place of the farther body lay then, as the nearer one saw it.
      const Vector3 then = back(near[k], times(far[k], foreign));
      moved.push_back(angle_between(then, own));
      apart.push_back(-moved.back() * dot(normalised(tangent(then, own)), across));
    }
    const double most = *std::max_element(apart.begin(), apart.end());
    return most >= kAcross * *std::max_element(moved.begin(), moved.end()) ? apart : moved;
  }

  std::vector<double> time_myr_;
  std::vector<std::vector<Matrix3>> frames_;  // of each plate at each of the times
};

/// Places where no plate is, and the nearest sample of the two nearest plates to each.
class Gaps {
 public:
  Gaps(const SphereMesh& mesh, const std::vector<std::int16_t>& owner)
      : mesh_(mesh), owner_(owner), number_(mesh.size(), -1) {
    for (std::int32_t i = 0; i < mesh.size(); ++i) {
      if (owner[i] >= 0) continue;
      number_[i] = static_cast<std::int32_t>(places_.size());
      places_.push_back(i);
    }
    sides_.resize(places_.size());
    hear_from(shores());
  }
  [[nodiscard]] const std::vector<std::int32_t>& places() const { return places_; }
  [[nodiscard]] const std::vector<GapSides>& sides() const { return sides_; }

 private:
  /// True when the place did not know of a source as near of that plate.
  bool offer(std::int32_t i, std::int32_t source) {
    GapSides& at = sides_[number_[i]];
    const Vector3 way = add(mesh_.samples().position(i), mesh_.samples().position(source), -1.0);
    const auto chord2 = static_cast<float>(dot(way, way));
    int slot = -1;
    for (int k = 0; k < 2; ++k) {
      if (at.source[k] >= 0 && owner_[at.source[k]] == owner_[source]) slot = k;
    }
    if (slot < 0) slot = at.source[0] < 0 ? 0 : 1;
    if (chord2 >= at.chord2[slot]) return false;
    at.source[slot] = source;
    at.chord2[slot] = chord2;
    if (at.source[1] >= 0 && at.chord2[1] < at.chord2[0]) {
      std::swap(at.source[0], at.source[1]);
      std::swap(at.chord2[0], at.chord2[1]);
    }
    return true;
  }
  /// Places beside a plate, which know of it.
  [[nodiscard]] std::vector<std::int32_t> shores() {
    std::vector<std::int32_t> found;
    for (const std::int32_t i : places_) {
      bool reached = false;
      for (const std::int32_t j : mesh_.neighbours(i)) {
        if (owner_[j] >= 0) reached = offer(i, j) || reached;
      }
      if (reached) found.push_back(i);
    }
    return found;
  }
  /// Places tell their neighbours what they know, until nobody hears news.
  void hear_from(std::vector<std::int32_t> queue) {
    std::vector<std::int32_t> next;
    while (!queue.empty()) {
      next.clear();
      for (const std::int32_t i : queue) {
        for (const std::int32_t j : mesh_.neighbours(i)) {
          if (owner_[j] >= 0) continue;
          bool reached = false;
          for (const std::int32_t source : sides_[number_[i]].source) {
            if (source >= 0) reached = offer(j, source) || reached;
          }
          if (reached) next.push_back(j);
        }
      }
      queue.swap(next);
    }
  }

  const SphereMesh& mesh_;
  const std::vector<std::int16_t>& owner_;
  std::vector<std::int32_t> number_, places_;  // of a place by its sample, and the other way round
  std::vector<GapSides> sides_;                // of each place
};

/// New floor at a place of a plate between a ridge and the plate's edge.
void lay_floor(const SphereTectonics& model, const GapHistory& history, std::int32_t i,
               const GapSides& sides, const RidgePlace& ridge, std::span<const std::int16_t> body,
               SphereCrust& now) {
  const FibonacciSphere& samples = model.mesh->samples();
  const SphereSettings& s = model.settings;
  const std::int32_t own = sides.source[ridge.side], other = sides.source[1 - ridge.side];
  const double share = ridge_share(ridge.ridge_km, ridge.edge_km);
  const double near_km = ridge.edge_km, far_km = ridge.edge_km + 2.0 * ridge.ridge_km;
  const double mean_km = 1e-3 *
                         (now.elevation_m[own] * far_km +
                          (other >= 0 ? now.elevation_m[other] : now.elevation_m[own]) * near_km) /
                         std::max(1e-9, near_km + far_km);
  const double profile_km = ridge_profile_km(ridge.ridge_km, s.ridge_falloff * s.radius_km, s.law);
  const double age_myr =
      other >= 0 ? history.age_myr(samples.position(i),
                                   add(samples.position(other), samples.position(own), -1.0),
                                   body[own], body[other], share)
                 : 0.0;
  now.age_myr[i] = static_cast<float>(age_myr);
  now.elevation_m[i] = static_cast<float>(
      s.floor_by_age ? -ocean_depth_m(age_myr) : 1e3 * new_floor_km(share, mean_km, profile_km));
  now.thickness_m[i] = static_cast<float>(1e3 * s.oceanic_km);
  for (int c = 0; c < 3; ++c) now.ridge[i][c] = static_cast<float>(ridge.along[c]);
}

}  // namespace

void fill_gaps(SphereTectonics& model, SphereCrust& now, std::vector<std::int16_t>& owner,
               std::span<const std::int16_t> body) {
  const Gaps gaps(*model.mesh, owner);
  const GapHistory history(model.state);
  const auto count = static_cast<std::int32_t>(gaps.places().size());
  const std::vector<RidgePlace> ridge =
      place_ridges(model, {owner, now.continental, gaps.places(), gaps.sides()});
  ParallelErrors errors;
#pragma omp parallel for schedule(static)
  for (std::int32_t k = 0; k < count; ++k) {
    errors.guard(
        [&] { lay_floor(model, history, gaps.places()[k], gaps.sides()[k], ridge[k], body, now); });
  }
  errors.rethrow();
  std::vector<std::int32_t> nearest(count);
  for (std::int32_t k = 0; k < count; ++k) nearest[k] = gaps.sides()[k].source[ridge[k].side];
  stretch_margins(model, gaps.places(), nearest, now, owner);
  for (std::int32_t k = 0; k < count; ++k) owner[gaps.places()[k]] = owner[nearest[k]];
}

}  // namespace geo
