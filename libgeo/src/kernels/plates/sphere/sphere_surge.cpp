#include <algorithm>
#include <cmath>

#include "sample_sums.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

constexpr auto kHimalayan = static_cast<std::int8_t>(OrogenyType::himalayan);
/// Ground that rises less is not folded.
constexpr double kFolded_km = 0.02;
/// Shortest reach of a collision that is looked for.
constexpr double kLeastReach_km = 1.0;

class Surge {
 public:
  Surge(SphereTectonics& model, const Collision& what)
      : m_(model),
        s_(model.settings),
        crust_(model.state.crust),
        what_(what),
        reach_km_(collision_radius_km(what.speed_mm_yr, what.area_km2, s_.mean_area_km2, s_.law)),
        height_km_(std::min(
            s_.surge_km,
            collision_surge_km(what.area_km2, 0.0, std::max(reach_km_, kLeastReach_km), s_.law))),
        source_(crust_.plate.size(), -1) {}

  void happen() {
    swallow();
    reach_out();
    lift(radius_for(swallowed_km3_));
    m_.budget.swallowed_km3 += swallowed_km3_;
    if (!reached_.empty()) return;
    m_.budget.lost_km3 += swallowed_km3_;
    m_.budget.sediment_subducted_km3 += 1e-3 * m_.sample_km2() * sediment_m_;
  }

 private:
  /// Consumes what the terrane has pushed below the plate. What lies above it is reached first.
  void swallow() {
    for (const std::int32_t i : what_.terrane) {
      const std::int32_t above = m_.margins.partner[i];
      if (m_.margins.hidden[i] == 0 || above < 0 || crust_.plate[above] != what_.upper) continue;
      const double volume_km3 = m_.sample_km2() * 1e-3 * crust_.thickness_m[i];
      crust_.plate[i] = -1;
      sediment_m_ += crust_.sediment_m[i];
      crust_.sediment_m[i] = 0.0F;
      // Where plates are ranked, continents subduct below floor as well.
      if (crust_.continental[above] == 0) {
        m_.budget.lost_km3 += volume_km3;
        continue;
      }
      swallowed_km3_ += volume_km3;
      if (source_[above] >= 0) continue;
      source_[above] = above;
      reached_.push_back(above);
    }
  }
  /// The continent within reach, each sample from its nearest one above the terrane.
  void reach_out() {
    const double half = std::sin(0.5 * std::min(reach_km_ / s_.radius_km, 3.1));
    const auto most = static_cast<float>(4.0 * half * half);
    std::vector<float> chord2_to(crust_.plate.size(), 9.0F);
    for (const std::int32_t i : reached_) chord2_to[i] = 0.0F;
    std::vector<std::int32_t> queue = reached_, next;
    while (!queue.empty()) {
      next.clear();
      for (const std::int32_t i : queue) {
        for (const std::int32_t j : m_.mesh->neighbours(i)) {
          if (!may_rise(j) || source_[j] == source_[i]) continue;
          const Vector3 way = add(at(j), at(source_[i]), -1.0);
          const auto chord2 = static_cast<float>(dot(way, way));
          if (chord2 >= most || chord2 >= chord2_to[j]) continue;
          if (source_[j] < 0) reached_.push_back(j);
          source_[j] = source_[i];
          chord2_to[j] = chord2;
          next.push_back(j);
        }
      }
      queue.swap(next);
    }
    for (const std::int32_t i : reached_) far_km_.push_back(m_.distance_km(i, source_[i]));
  }
  [[nodiscard]] bool may_rise(std::int32_t i) const {
    return crust_.plate[i] == what_.upper && crust_.continental[i] != 0;
  }
  [[nodiscard]] const Vector3& at(std::int32_t i) const { return m_.mesh->samples().position(i); }
  [[nodiscard]] double lifted_km(std::size_t k, double radius_km) const {
    const double above = std::max(0.0, s_.law.summit_km - 1e-3 * crust_.elevation_m[reached_[k]]);
    return std::min(above, height_km_ * collision_profile(far_km_[k], radius_km));
  }
  [[nodiscard]] double volume_km3(double radius_km) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < reached_.size(); ++k) sum += lifted_km(k, radius_km);
    return m_.sample_km2() * s_.rebound * sum;
  }
  /// The reach within which mountains and roots take up no more than a volume.
  [[nodiscard]] double radius_for(double most_km3) const {
    double low = 0.0, high = std::max(reach_km_, kLeastReach_km);
    if (volume_km3(high) <= most_km3) return high;
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (low + high);
      (volume_km3(middle) > most_km3 ? high : low) = middle;
    }
    return low;
  }
  /// Mountains and roots. What the profile does not take thickens the crust above what was
  /// swallowed.
  void lift(double radius_km) {
    const double given_km3 = volume_km3(radius_km);
    const double rest_km = reached_.empty()
                               ? 0.0
                               : (swallowed_km3_ - given_km3) /
                                     (m_.sample_km2() * static_cast<double>(reached_.size()));
    const Vector3 middle = back(m_.frame[what_.upper], what_.centroid);
    WholeGains gains, sediment_gains;
    const double sediment_m =
        reached_.empty() ? 0.0 : sediment_m_ / static_cast<double>(reached_.size());
    for (std::size_t k = 0; k < reached_.size(); ++k) {
      const std::int32_t i = reached_[k];
      const double lifted = lifted_km(k, radius_km);
      const double thicker_m = 1e3 * (s_.rebound * lifted + rest_km);
      const double raised_m = height_after(crust_.elevation_m[i], thicker_m, s_.rebound);
      crust_.elevation_m[i] = static_cast<float>(std::min(1e3 * s_.law.summit_km, raised_m));
      gains.put(crust_.thickness_m[i], thicker_m);
      sediment_gains.put(crust_.sediment_m[i], sediment_m);
      if (lifted < kFolded_km) continue;
      crust_.orogeny[i] = kHimalayan;
      crust_.orogeny_age_myr[i] = 0.0F;
      const Vector3 fold = collision_fold(at(i), middle);
      for (int c = 0; c < 3; ++c) crust_.fold[i][c] = static_cast<float>(fold[c]);
    }
  }

  SphereTectonics& m_;
  const SphereSettings& s_;
  SphereCrust& crust_;
  const Collision& what_;
  double reach_km_, height_km_;
  double swallowed_km3_ = 0.0;
  double sediment_m_ = 0.0;  // of that, added up over samples: it is folded into the mountains
  std::vector<std::int32_t> source_;   // of each sample: the one above the terrane, or -1
  std::vector<std::int32_t> reached_;  // in the order in which they are
  std::vector<double> far_km_;         // of each of these, from its source
};

}  // namespace

void surge(SphereTectonics& model, const Collision& what) { Surge(model, what).happen(); }

}  // namespace geo
