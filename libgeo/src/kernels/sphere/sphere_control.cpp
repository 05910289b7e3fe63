#include <cmath>

#include "geo/kernels/ocean_depth.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

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
  set_frames();
  if (!settings_.hold_motions) return;
  state_.plates[plate].is_held = true;
  state_.kept_rotation_rad_myr = net_rotation();
}

void SphereTectonics::hold_motions() {
  for (SpherePlate& plate : state_.plates) plate.is_held = plate.alive;
  state_.kept_rotation_rad_myr = {};
}

template <class Within>
double SphereTectonics::change_samples(Within&& within, bool continental) {
  // Low land, as thick as it takes to float there; floor of the age of its surroundings.
  constexpr float kLand_m = 300.0F, kThick_m = 36000.0F;
  SphereCrust& crust = state_.crust;
  double changed = 0.0, thickened_m = 0.0;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    const std::int16_t p = crust.plate[i];
    if (p < 0 || (crust.continental[i] != 0) == continental || !within(i, p)) continue;
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

double SphereTectonics::change_crust(const Vector3& place, double radius_km, bool continental) {
  const double lowest = std::cos(std::min(radius_km / settings_.radius_km, 3.14159));
  std::vector<Vector3> middle;
  for (const Matrix3& frame : frame_) middle.push_back(back(frame, place));
  return change_samples(
      [&](std::int32_t i, int plate) {
        return dot(mesh_->samples().position(i), middle[plate]) >= lowest;
      },
      continental);
}

double SphereTectonics::change_crust(const std::function<bool(const Vector3&)>& holds,
                                     bool continental) {
  return change_samples(
      [&](std::int32_t i, int plate) {
        return holds(times(frame_[plate], mesh_->samples().position(i)));
      },
      continental);
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
