#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/sphere/surface/sphere_water.hpp"
#include "kernels/plates/sphere/sample_sums.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

constexpr auto kAndean = static_cast<std::int8_t>(OrogenyType::andean);
constexpr auto kHimalayan = static_cast<std::int8_t>(OrogenyType::himalayan);
/// Part of the greatest rise from which on the ground is folded.
constexpr double kFolding = 0.35;
/// A collision younger than this is not taken for an arc's work.
constexpr float kYoung_myr = 40.0F;

/// What the trenches of a step do to the plates above them.
class TrenchUplift {
 public:
  explicit TrenchUplift(const SphereTectonics& model)
      : m_(model), relative_(model.margins.trenches.size()), lift_(model.margins.trenches.size()) {
    const SphereSettings& s = m_.settings;
    for (std::size_t k = 0; k < m_.margins.trenches.size(); ++k) {
      const TrenchSample& trench = m_.margins.trenches[k];
      const int own = m_.state.crust.plate[trench.sample];
      relative_[k] = scaled(
          back(m_.frame[own], add(m_.rotation[trench.lower], m_.rotation[own], -1.0)), s.radius_km);
      lift_[k] = std::pow(
          uplift_by_elevation(1e-3 * trench.lower_elevation_m, s.law.trench_km, s.law.summit_km),
          s.elevation_weight);
      if (s.advance_mm_yr > 0.0) lift_[k] *= uplift_by_advance(k);
    }
  }
  struct Work {
    double d_km, f, rate_mm_yr;
    Vector3 speed;  // of the plate that subducts below the sample, mm/yr, in the frame of its plate
  };
  [[nodiscard]] Work at(std::int32_t i, std::int32_t k) const {
    const SphereSettings& s = m_.settings;
    const TectonicConstants& law = s.law;
    Work work{m_.distance_km(i, m_.margins.trenches[k].sample), 0.0, 0.0,
              cross(relative_[k], m_.mesh->samples().position(i))};
    const double reach_km =
        m_.state.crust.continental[i] != 0 ? law.subduction_distance_km : s.arc_reach_km;
    work.f =
        s.driftworld_uplift
            ? std::max(0.0, uplift_by_distance_driftworld(work.d_km, s.uplift_control_km, reach_km))
            : uplift_by_distance(work.d_km, s.uplift_control_km, reach_km);
    work.rate_mm_yr =
        law.uplift_mm_yr * work.f * uplift_by_speed(length(work.speed), law.speed_mm_yr) * lift_[k];
    return work;
  }

 private:
  /// Overriding plates that advance on their trench over the mantle are shortened, those that
  /// retreat are not (Heuret & Lallemand 2005): the component of their motion against that of the
  /// subducting plate.
  [[nodiscard]] double uplift_by_advance(std::size_t k) const {
    constexpr double kAtRest = 1.0 / 3.0, kMost = 5.0 / 3.0;
    const std::int32_t i = m_.margins.trenches[k].sample;
    const int own = m_.state.crust.plate[i];
    const Vector3& here = m_.mesh->samples().position(i);
    const Vector3 closing = normalised(cross(relative_[k], here));
    const Vector3 speed =
        scaled(cross(back(m_.frame[own], m_.rotation[own]), here), m_.settings.radius_km);
    return std::clamp(kAtRest - dot(speed, closing) / m_.settings.advance_mm_yr, 0.0, kMost);
  }

  const SphereTectonics& m_;
  std::vector<Vector3> relative_;  // of each trench, in the frame of its plate
  std::vector<double> lift_;       // how much the height of the subducting crust counts
};

/// The sum of what all plates that subduct below one do to it, each by its own nearest trench.
std::vector<float> summed_uplift_km(const SphereTectonics& model, const TrenchUplift& uplift) {
  const std::vector<TrenchSample>& trenches = model.margins.trenches;
  const std::size_t plates = model.state.plates.size();
  std::vector<std::vector<std::int32_t>> of_pair(plates * plates);
  for (std::size_t k = 0; k < trenches.size(); ++k) {
    const auto upper = static_cast<std::size_t>(model.state.crust.plate[trenches[k].sample]);
    const auto lower = static_cast<std::size_t>(model.state.root(trenches[k].lower));
    of_pair[upper * plates + lower].push_back(static_cast<std::int32_t>(k));
  }
  std::vector<float> uplift_km(model.state.crust.plate.size(), 0.0F);
  const float most = subduction_chord2(model.settings);
  std::vector<TrenchSpot> spots = spots_of_samples(model);
  const auto forget = [&](std::int32_t i) {
    spots[i].trench = -1;
    spots[i].chord2 = most;
  };
  const auto raise_plate = [&](std::size_t p) {
    std::vector<std::int32_t> reached;
    for (std::size_t q = 0; q < plates; ++q) {
      reached.clear();
      hand_on_trenches(model, static_cast<int>(p), of_pair[p * plates + q], spots, &reached);
      for (const std::int32_t i : reached) {
        const double rate_mm_yr = uplift.at(i, spots[i].trench).rate_mm_yr;
        uplift_km[i] += static_cast<float>(rate_mm_yr * model.settings.law.step_myr);
        forget(i);
      }
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t p = 0; p < plates; ++p) errors.guard([&] { raise_plate(p); });
  errors.rethrow();
  return uplift_km;
}

/// What a step does to crust everywhere: uplift of overriding plates, erosion, damping, accretion,
/// ageing.
class CrustStep {
 public:
  enum Sum { kRaised, kEroded, kEmerged, kEmergedArea, kAccreted, kSums };
  using Sums = std::array<double, kSums>;

  explicit CrustStep(SphereTectonics& model)
      : s_(model.settings),
        law_(s_.law),
        crust_(model.state.crust),
        nearest_trench_(model.margins.nearest_trench),
        uplift_(model),
        sea_km_(s_.ocean_share > 0.0 ? 1e-3 * level_above(model, 1.0 - s_.ocean_share)
                                     : 1e-3 * model.state.sea_level_m),
        step_myr_(static_cast<float>(law_.step_myr)),
        decayed_(share_gone(s_.swell_decay_myr)),
        worn_(share_gone(s_.island_wear_myr)) {
    if (s_.add_uplifts) summed_km_ = summed_uplift_km(model, uplift_);
  }

  void pass_over(std::int32_t i, Sums& sum) {
    if (crust_.plate[i] < 0) return;
    const double z_km = 1e-3 * crust_.elevation_m[i];
    const Overriding above = above_trench(i, z_km);
    const double after_km = crust_.continental[i] != 0
                                ? continent_after(i, z_km, above.raised_km, sum)
                                : floor_after(i, z_km, above, sum);
    crust_.elevation_m[i] = static_cast<float>(1e3 * after_km);
  }

 private:
  /// What lies near a trench of its plate.
  struct Overriding {
    double raised_km = 0.0;
    bool is_wedge = false, is_arc = false;
  };

  /// Above the sea, without the load of water.
  [[nodiscard]] double dry_km(double z_km) const { return dry_height(z_km - sea_km_); }
  [[nodiscard]] double share_gone(double time_myr) const {
    return time_myr > 0.0 ? -std::expm1(-law_.step_myr / time_myr) : 0.0;
  }
  [[nodiscard]] Overriding above_trench(std::int32_t i, double z_km) {
    const std::int32_t k = nearest_trench_[i];
    if (k < 0) return {};
    const TrenchUplift::Work work = uplift_.at(i, k);
    const double rise_km =
        s_.add_uplifts ? static_cast<double>(summed_km_[i]) : work.rate_mm_yr * law_.step_myr;
    const double raised_km = std::max(0.0, std::min(rise_km, law_.summit_km - z_km));
    if (work.f > kFolding) {
      turn_fold(i, work.speed);
      const bool collided =
          crust_.orogeny[i] == kHimalayan && crust_.orogeny_age_myr[i] < kYoung_myr;
      if (crust_.continental[i] != 0 && z_km + raised_km > sea_km_ && !collided) {
        crust_.orogeny[i] = kAndean;
        crust_.orogeny_age_myr[i] = -step_myr_;  // 0 when this step has passed
      }
    }
    return {raised_km, work.d_km<s_.accretion_width_km, work.f> kFolding && raised_km > 0.0};
  }
  void turn_fold(std::int32_t i, const Vector3& speed) {
    Vector3 fold{crust_.fold[i][0], crust_.fold[i][1], crust_.fold[i][2]};
    fold = turned_fold(fold, speed, s_.fold_per_km, law_.step_myr);
    const double size = std::max(1.0, length(fold));
    for (int c = 0; c < 3; ++c) crust_.fold[i][c] = static_cast<float>(fold[c] / size);
  }
  /// Height after uplift and erosion, which thicken and thin the crust.
  double continent_after(std::int32_t i, double z_km, double raised_km, Sums& sum) {
    const bool wears = !s_.by_rivers && (!s_.wears_land_alone || z_km > sea_km_);
    const double worn_km = wears ? erosion_km(z_km - sea_km_, law_) : 0.0;
    const double top_km = z_km + raised_km;
    const double thicker_km = s_.rebound * (dry_km(top_km) - dry_km(z_km));
    const double thinner_km = s_.rebound * (dry_km(top_km) - dry_km(top_km + worn_km));
    sum[kRaised] += 1e-3 * put(crust_.thickness_m[i], 1e3 * thicker_km);
    sum[kEroded] -= 1e-3 * put(crust_.thickness_m[i], -1e3 * thinner_km);
    crust_.orogeny_age_myr[i] += step_myr_;
    return top_km + worn_km;
  }
  /// Height after uplift, sinking, wear of islands and accretion; what emerges above a trench
  /// becomes continental.
  double floor_after(std::int32_t i, double z_km, const Overriding& above, Sums& sum) {
    double sunk_km = sunk_at(i, z_km, above.is_arc);
    if (z_km > sea_km_) {
      const double worn_km = (z_km - sea_km_) * worn_;
      sunk_km -= worn_km;
      crust_.thickness_m[i] -= static_cast<float>(1e3 * worn_km);
    }
    z_km += above.raised_km + sunk_km;
    if ((above.is_wedge || s_.fill_abyss) && z_km < s_.accretion_top_km) {
      const double piled_km = std::min(s_.accretion_top_km, z_km + accretion_km(law_));
      sum[kAccreted] += piled_km - z_km;
      z_km = piled_km;
    }
    crust_.age_myr[i] += step_myr_;
    if (z_km > sea_km_ && above.raised_km > 0.0) emerge(i, sum);
    return z_km;
  }
  /// How far floor sinks in the step, less than 0. By age, what volcanoes have laid on it subsides
  /// with it and what has lifted it from below decays.
  [[nodiscard]] double sunk_at(std::int32_t i, double z_km, bool is_arc) const {
    if (!s_.floor_by_age) return damping_km(z_km, law_);
    const double age = crust_.age_myr[i];
    const double plain_km = 1e-3 * (-ocean_depth_m(age) + crust_.thickness_m[i]) - s_.oceanic_km;
    return 1e-3 * (ocean_depth_m(age) - ocean_depth_m(age + law_.step_myr)) -
           (is_arc ? 0.0 : (z_km - plain_km) * decayed_);
  }
  void emerge(std::int32_t i, Sums& sum) {
    crust_.continental[i] = 1;
    crust_.orogeny[i] = kAndean;
    crust_.orogeny_age_myr[i] = 0.0F;
    crust_.thickness_m[i] = static_cast<float>(1e3 * s_.arc_km);
    sum[kEmerged] += 1e-3 * static_cast<double>(crust_.thickness_m[i]);
    sum[kEmergedArea] += 1.0;
  }

  const SphereSettings& s_;
  const TectonicConstants& law_;
  SphereCrust& crust_;
  const std::vector<std::int32_t>& nearest_trench_;
  TrenchUplift uplift_;
  std::vector<float> summed_km_;  // of each sample, where uplifts add up
  double sea_km_;
  float step_myr_;
  double decayed_, worn_;  // shares of a swell and of an island that go in a step
};

}  // namespace

void raise_crust(SphereTectonics& model) {
  CrustStep step(model);
  constexpr std::int32_t kBlock = 4096;
  const std::int32_t n = model.state.crust.size(), blocks = (n + kBlock - 1) / kBlock;
  std::vector<CrustStep::Sums> sums(blocks, CrustStep::Sums{});
#pragma omp parallel for schedule(dynamic, 4)
  for (std::int32_t block = 0; block < blocks; ++block) {
    const std::int32_t end = std::min(n, (block + 1) * kBlock);
    for (std::int32_t i = block * kBlock; i < end; ++i) step.pass_over(i, sums[block]);
  }
  for (const CrustStep::Sums& sum : sums) {
    model.budget.raised_km3 += model.sample_km2() * sum[CrustStep::kRaised];
    model.budget.eroded_km3 += model.sample_km2() * sum[CrustStep::kEroded];
    model.budget.emerged_km3 += model.sample_km2() * sum[CrustStep::kEmerged];
    model.budget.accreted_km3 += model.sample_km2() * sum[CrustStep::kAccreted];
    model.budget.emerged_km2 += model.sample_km2() * sum[CrustStep::kEmergedArea];
  }
}

}  // namespace geo
