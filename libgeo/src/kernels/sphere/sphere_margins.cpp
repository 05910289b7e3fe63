#include <algorithm>
#include <cmath>

#include "geo/kernels/sphere_boundaries.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {
namespace {

/// Share of its first thickness that stretched crust keeps at a share of the margin's width.
double kept(double s) {
  constexpr double kOuter = 0.25;
  return 1.0 - (1.0 - kOuter) * s * s * (3.0 - 2.0 * s);
}
/// Thinner crust is itself a margin, and does not break into another one.
constexpr float kWhole_m = 20000.0F;
/// Height lost below water for each that a dry column loses.
constexpr double kWaterLoad = 1.45;

}  // namespace

/// Passive margins: where a continent has broken, the nearest part of the gap is its own crust,
/// stretched. What it takes flows from inland, whose crust thins evenly, so that the volume of the
/// continent stays; where that does not suffice, the margin is as much thinner.
void SphereTectonics::stretch_margins(std::span<const std::int32_t> gaps,
                                      std::span<const std::int32_t> nearest, SphereCrust& now,
                                      std::span<const std::int16_t> owner) {
  const SphereSettings& s = settings_;
  if (s.margin_km <= 0.0 || s.margin_thinning <= 0.0) return;
  std::vector<std::int32_t> number(mesh_->size(), -1), source, margin;
  std::vector<double> wanted_m, has_m;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const std::int32_t edge = nearest[k];
    if (now.continental[edge] == 0 || now.thickness_m[edge] < kWhole_m) continue;
    const double far_km = distance_km(gaps[k], edge);
    if (far_km > s.margin_km) continue;
    margin.push_back(static_cast<std::int32_t>(k));
    if (number[edge] < 0) {
      number[edge] = static_cast<std::int32_t>(source.size());
      source.push_back(edge);
      wanted_m.push_back(0.0);
    }
    wanted_m[number[edge]] += now.thickness_m[edge] * kept(far_km / s.margin_km);
  }
  if (margin.empty()) return;
  has_m.assign(source.size(), 0.0);
  const auto inland = nearest_samples(*mesh_, source, s.margin_source_km / s.radius_km);
  const auto gives = [&](std::int32_t i) {
    return inland[i] >= 0 && owner[i] >= 0 && now.continental[i] != 0 &&
           now.thickness_m[i] >= kWhole_m && owner[i] == owner[source[inland[i]]];
  };
  for (std::int32_t i = 0; i < mesh_->size(); ++i) {
    if (gives(i)) has_m[inland[i]] += now.thickness_m[i];
  }
  std::vector<double> thinning(source.size()), met(source.size());
  for (std::size_t k = 0; k < source.size(); ++k) {
    thinning[k] = std::min(s.margin_thinning, wanted_m[k] / has_m[k]);
    met[k] = thinning[k] * has_m[k] / wanted_m[k];
  }
  for (const std::int32_t k : margin) {
    const std::int32_t i = gaps[k], edge = nearest[k], group = number[edge];
    const double full_m = now.thickness_m[edge];
    const double thick_m = full_m * kept(distance_km(i, edge) / s.margin_km) * met[group];
    const double dry_m = now.elevation_m[edge] - (full_m - thick_m) / s.rebound;
    now.continental[i] = 1;
    now.thickness_m[i] = static_cast<float>(thick_m);
    // Never deeper than the floor beside it.
    const double floor_m = 1e3 * s.law.abyss_km;
    now.elevation_m[i] =
        static_cast<float>(std::max(0.5 * floor_m, dry_m < 0.0 ? kWaterLoad * dry_m : dry_m));
    now.age_myr[i] = 0.0F;
    now.orogeny_age_myr[i] = now.orogeny_age_myr[edge];
    now.ridge[i] = {};
    budget_.stretched_km2 += sample_km2();
  }
  for (std::int32_t i = 0; i < mesh_->size(); ++i) {
    if (!gives(i)) continue;
    const double lost_m = thinning[inland[i]] * now.thickness_m[i];
    now.thickness_m[i] -= static_cast<float>(lost_m);
    now.elevation_m[i] -= static_cast<float>(lost_m / s.rebound);
  }
}

}  // namespace geo
