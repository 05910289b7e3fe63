#include <cmath>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

int SphereTectonics::plate_at(const Vector3& place) const {
  std::int32_t top = -1;
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    if (!state_.plates[p].alive) continue;
    const std::int32_t sample = mesh_->samples().nearest(back(frame_[p], place));
    if (state_.crust.plate[sample] != static_cast<std::int16_t>(p)) continue;
    if (top < 0 || is_on_top(sample, top)) top = sample;
  }
  return top < 0 ? -1 : state_.root(state_.crust.plate[top]);
}

void SphereTectonics::set_motion(int plate, const Vector3& axis, double speed_rad_myr) {
  state_.plates[plate].axis = normalised(axis);
  state_.plates[plate].speed_rad_myr = speed_rad_myr;
  state_.plates[plate].yielding = {};
  set_frames();
  if (!settings_.hold_motions) return;
  state_.plates[plate].is_held = true;
  state_.kept_rotation_rad_myr = net_rotation();
}

void SphereTectonics::hold_motions() {
  for (SpherePlate& plate : state_.plates) plate.is_held = plate.alive;
  state_.kept_rotation_rad_myr = {};
}

double SphereTectonics::change_crust(const std::function<bool(const Vector3&)>& holds,
                                     bool continental, double warp_km) {
  // Low land, as thick as it takes to float there; floor of the age of its surroundings.
  constexpr float kLand_m = 300.0F, kThick_m = 36000.0F;
  // Bays eight times as long as they are deep at the most, and what lies in them.
  constexpr double kWavelength = 8.0, kMost = 2.2;
  constexpr int kOctaves = 6;
  const auto warped = [&](const Vector3& at) {
    if (warp_km <= 0.0) return at;
    Vector3 out = at;
    for (int c = 0; c < 3; ++c) {
      const Vector3 shifted{at[0] + 3.1 * c, at[1] - 1.7 * c, at[2] + 0.9 * c};
      out[c] += kMost * warp_km / settings_.radius_km *
                coasts_.fbm(shifted, settings_.radius_km / (kWavelength * warp_km), kOctaves);
    }
    return normalised(out);
  };
  SphereCrust& crust = state_.crust;
  double changed = 0.0, thickened_m = 0.0;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    const std::int16_t p = crust.plate[i];
    if (p < 0 || (crust.continental[i] != 0) == continental) continue;
    if (!holds(warped(times(frame_[p], mesh_->samples().position(i))))) continue;
    changed += sample_km2();
    thickened_m += continental ? kThick_m : -crust.thickness_m[i];
    crust.continental[i] = continental ? 1 : 0;
    crust.orogeny[i] = 0;
    crust.orogeny_age_myr[i] = 0.0F;
    crust.thickness_m[i] = continental ? kThick_m : static_cast<float>(1e3 * settings_.oceanic_km);
    crust.elevation_m[i] =
        continental ? kLand_m
                    : static_cast<float>(settings_.floor_by_age ? -ocean_depth_m(crust.age_myr[i])
                                                                : 1e3 * settings_.law.abyss_km);
  }
  budget_.changed_km3 += 1e-3 * sample_km2() * thickened_m;
  repartition();
  return changed;
}

std::vector<double> SphereTectonics::plate_areas_km2() const {
  std::vector<double> area(state_.plates.size(), 0.0);
  for (std::size_t p = 0; p < area.size(); ++p) {
    area[state_.root(static_cast<int>(p))] +=
        sample_km2() * partition_.cap(static_cast<int>(p)).samples;
  }
  return area;
}

}  // namespace geo
