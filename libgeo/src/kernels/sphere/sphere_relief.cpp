#include <algorithm>
#include <array>
#include <cmath>

#include "geo/kernels/ocean_depth.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {
namespace {

constexpr auto kAndean = static_cast<std::int8_t>(OrogenyType::andean);
constexpr auto kHimalayan = static_cast<std::int8_t>(OrogenyType::himalayan);
/// Part of the greatest rise from which on the ground is folded.
constexpr double kFolding = 0.35;
/// A collision younger than this is not taken for an arc's work.
constexpr float kYoung_myr = 40.0F;

}  // namespace

/// Uplift of overriding plates, erosion, damping, accretion, ageing: all that goes on everywhere.
void SphereTectonics::raise() {
  const FibonacciSphere& samples = mesh_->samples();
  const SphereSettings& s = settings_;
  const TectonicConstants& law = s.law;
  SphereCrust& crust = state_.crust;
  const auto step_myr = static_cast<float>(law.step_myr);
  // What each front moves like, in the frame of its plate.
  std::vector<Vector3> relative(fronts_.size());
  for (std::size_t k = 0; k < fronts_.size(); ++k) {
    const int own = crust.plate[fronts_[k].sample];
    relative[k] = scaled(back(frame_[own], add(rotation_[fronts_[k].lower], rotation_[own], -1.0)),
                         s.radius_km);
  }
  // How much the height of what goes down counts.
  std::vector<double> lift(fronts_.size());
  for (std::size_t k = 0; k < fronts_.size(); ++k) {
    lift[k] = std::pow(
        uplift_by_elevation(1e-3 * fronts_[k].lower_elevation_m, law.trench_km, law.summit_km),
        s.elevation_weight);
  }
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
      bool wedge = false;
      if (const std::int32_t k = front_of_[i]; k >= 0) {
        const Front& front = fronts_[k];
        const double d_km = distance_km(i, front.sample);
        const Vector3 speed = cross(relative[k], samples.position(i));
        const double reach_km =
            crust.continental[i] != 0 ? law.subduction_distance_km : s.arc_reach_km;
        const double f =
            s.driftworld_uplift
                ? std::max(0.0, uplift_by_distance_driftworld(d_km, s.uplift_control_km, reach_km))
                : uplift_by_distance(d_km, s.uplift_control_km, reach_km);
        const double rate =
            law.uplift_mm_yr * f * uplift_by_speed(length(speed), law.speed_mm_yr) * lift[k];
        raised_km = std::max(0.0, std::min(rate * law.step_myr, law.summit_km - z_km));
        wedge = d_km < s.accretion_width_km;
        if (f > kFolding) {
          Vector3 fold{crust.fold[i][0], crust.fold[i][1], crust.fold[i][2]};
          fold = turned_fold(fold, speed, s.fold_per_km, law.step_myr);
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
        const double worn_km = erosion_km(z_km, law);
        z_km += raised_km + worn_km;
        crust.thickness_m[i] += static_cast<float>(1e3 * s.rebound * (raised_km + worn_km));
        sum[kRaised] += s.rebound * raised_km;
        sum[kEroded] -= s.rebound * worn_km;
        crust.orogeny_age_myr[i] += step_myr;
      } else {
        const double age = crust.age_myr[i];
        const double sunk_km = s.floor_by_age
                                   ? 1e-3 * (ocean_depth_m(age) - ocean_depth_m(age + law.step_myr))
                                   : damping_km(z_km, law);
        z_km += raised_km + sunk_km;
        if (wedge && z_km < s.accretion_top_km) {
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
          sum[kEmerged] += s.arc_km;
          sum[kEmergedArea] += 1.0;
        }
      }
      crust.elevation_m[i] = static_cast<float>(1e3 * z_km);
    }
  }
  for (const auto& sum : sums) {
    budget_.raised_km3 += sample_km2() * sum[kRaised];
    budget_.eroded_km3 += sample_km2() * sum[kEroded];
    budget_.emerged_km3 += sample_km2() * sum[kEmerged];
    budget_.accreted_km3 += sample_km2() * sum[kAccreted];
    budget_.emerged_km2 += sample_km2() * sum[kEmergedArea];
  }
}

}  // namespace geo
