#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "sample_sums.hpp"
#include "sphere_steps.hpp"

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

}  // namespace

/// Uplift of overriding plates, erosion, damping, accretion, ageing: all that goes on everywhere.
void raise_crust(SphereTectonics& model) {
  const SphereSettings& s = model.settings;
  const TectonicConstants& law = s.law;
  SphereCrust& crust = model.state.crust;
  const auto step_myr = static_cast<float>(law.step_myr);
  const auto share_gone = [&](double time_myr) {
    return time_myr > 0.0 ? -std::expm1(-law.step_myr / time_myr) : 0.0;
  };
  const double decayed = share_gone(s.swell_decay_myr), worn = share_gone(s.island_wear_myr);
  const TrenchUplift uplift(model);
  std::vector<float> summed_km;
  if (s.add_uplifts) summed_km = summed_uplift_km(model, uplift);
  enum { kRaised, kEroded, kEmerged, kEmergedArea, kAccreted, kSums };
  constexpr std::int32_t kBlock = 4096;
  const std::int32_t n = crust.size(), blocks = (n + kBlock - 1) / kBlock;
  std::vector<std::array<double, kSums>> sums(blocks, std::array<double, kSums>{});
#pragma omp parallel for schedule(dynamic, 4)
  for (std::int32_t block = 0; block < blocks; ++block) {
    auto& sum = sums[block];
    for (std::int32_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
      if (crust.plate[i] < 0) continue;
      double z_km = 1e-3 * crust.elevation_m[i], raised_km = 0.0;
      bool wedge = false, is_arc = false;
      if (const std::int32_t k = model.margins.nearest_trench[i]; k >= 0) {
        const auto work = uplift.at(i, k);
        const double rise_km =
            s.add_uplifts ? static_cast<double>(summed_km[i]) : work.rate_mm_yr * law.step_myr;
        raised_km = std::max(0.0, std::min(rise_km, law.summit_km - z_km));
        wedge = work.d_km < s.accretion_width_km;
        is_arc = work.f > kFolding && raised_km > 0.0;
        if (work.f > kFolding) {
          Vector3 fold{crust.fold[i][0], crust.fold[i][1], crust.fold[i][2]};
          fold = turned_fold(fold, work.speed, s.fold_per_km, law.step_myr);
          const double size = std::max(1.0, length(fold));
          for (int c = 0; c < 3; ++c) crust.fold[i][c] = static_cast<float>(fold[c] / size);
          const bool collided =
              crust.orogeny[i] == kHimalayan && crust.orogeny_age_myr[i] < kYoung_myr;
          if (crust.continental[i] != 0 && z_km + raised_km > 0.0 && !collided) {
            crust.orogeny[i] = kAndean;
            crust.orogeny_age_myr[i] = -step_myr;  // 0 when this step has passed
          }
        }
      }
      if (crust.continental[i] != 0) {
        const bool wears = !s.by_rivers && (!s.wears_land_alone || z_km > 0.0);
        const double worn_km = wears ? erosion_km(z_km, law) : 0.0, top_km = z_km + raised_km;
        const double thicker_km = s.rebound * (dry_height(top_km) - dry_height(z_km));
        const double thinner_km = s.rebound * (dry_height(top_km) - dry_height(top_km + worn_km));
        z_km = top_km + worn_km;
        sum[kRaised] += 1e-3 * put(crust.thickness_m[i], 1e3 * thicker_km);
        sum[kEroded] -= 1e-3 * put(crust.thickness_m[i], -1e3 * thinner_km);
        crust.orogeny_age_myr[i] += step_myr;
      } else {
        const double age = crust.age_myr[i];
        double sunk_km = 0.0;
        if (s.floor_by_age) {
          // What volcanoes have laid on floor subsides with it; what has lifted it from below
          // decays.
          const double plain_km =
              1e-3 * (-ocean_depth_m(age) + crust.thickness_m[i]) - s.oceanic_km;
          sunk_km = 1e-3 * (ocean_depth_m(age) - ocean_depth_m(age + law.step_myr)) -
                    (is_arc ? 0.0 : (z_km - plain_km) * decayed);
        } else {
          sunk_km = damping_km(z_km, law);
        }
        if (z_km > 0.0) {
          const double worn_km = z_km * worn;
          sunk_km -= worn_km;
          crust.thickness_m[i] -= static_cast<float>(1e3 * worn_km);
        }
        z_km += raised_km + sunk_km;
        if ((wedge || s.fill_abyss) && z_km < s.accretion_top_km) {
          const double piled_km = std::min(s.accretion_top_km, z_km + accretion_km(law));
          sum[kAccreted] += piled_km - z_km;
          z_km = piled_km;
        }
        crust.age_myr[i] += step_myr;
        if (z_km > 0.0 && raised_km > 0.0) {
          crust.continental[i] = 1;
          crust.orogeny[i] = kAndean;
          crust.orogeny_age_myr[i] = 0.0F;
          crust.thickness_m[i] = static_cast<float>(1e3 * s.arc_km);
          sum[kEmerged] += 1e-3 * static_cast<double>(crust.thickness_m[i]);
          sum[kEmergedArea] += 1.0;
        }
      }
      crust.elevation_m[i] = static_cast<float>(1e3 * z_km);
    }
  }
  for (const auto& sum : sums) {
    model.budget.raised_km3 += model.sample_km2() * sum[kRaised];
    model.budget.eroded_km3 += model.sample_km2() * sum[kEroded];
    model.budget.emerged_km3 += model.sample_km2() * sum[kEmerged];
    model.budget.accreted_km3 += model.sample_km2() * sum[kAccreted];
    model.budget.emerged_km2 += model.sample_km2() * sum[kEmergedArea];
  }
}

}  // namespace geo
