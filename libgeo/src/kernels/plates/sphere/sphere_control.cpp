#include <cmath>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "sphere_steps.hpp"

namespace geo {

int plate_at(const SphereTectonics& model, const Vector3& place) {
  std::int32_t top = -1;
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    if (!model.state.plates[p].alive) continue;
    const std::int32_t sample = model.mesh->samples().nearest(back(model.frame[p], place));
    if (model.state.crust.plate[sample] != static_cast<std::int16_t>(p)) continue;
    if (top < 0 || is_on_top(model, sample, top)) top = sample;
  }
  return top < 0 ? -1 : model.state.root(model.state.crust.plate[top]);
}

void set_motion(SphereTectonics& model, int plate, const Vector3& axis, double speed_rad_myr) {
  model.state.plates[plate].axis = normalised(axis);
  model.state.plates[plate].speed_rad_myr = speed_rad_myr;
  model.state.plates[plate].yielding = {};
  model.state.plates[plate].driver = -1;
  derive_motion(model);
  if (!model.settings.hold_motions) return;
  model.state.plates[plate].is_held = true;
  model.state.kept_rotation_rad_myr = net_rotation(model);
}

void guide_plate(SphereTectonics& model, int plate, const Vector3& rotation_rad_myr) {
  SpherePlate& guided = model.state.plates[plate];
  guided.speed_rad_myr = length(rotation_rad_myr);
  if (guided.speed_rad_myr > 0.0) guided.axis = normalised(rotation_rad_myr);
  guided.yielding = {};
  guided.is_held = true;
  derive_motion(model);
}

void hold_motions(SphereTectonics& model) {
  for (SpherePlate& plate : model.state.plates) plate.is_held = plate.alive;
  model.state.kept_rotation_rad_myr = {};
}

double change_crust(SphereTectonics& model, const std::function<bool(const Vector3&)>& holds,
                    bool continental, double warp_km) {
  // Low land, as thick as it takes to float there; floor of the age of its surroundings.
  constexpr float kLand_m = 300.0F, kThick_m = 36000.0F;
  // Bays eight times as long as they are deep at the most, and what lies in them.
  constexpr double kWavelength = 8.0, kMost = 2.2;
  constexpr int kOctaves = 6;
  const Noise coasts(model.seed, "plates.changed_coasts");
  const auto warped = [&](const Vector3& at) {
    if (warp_km <= 0.0) return at;
    Vector3 out = at;
    for (int c = 0; c < 3; ++c) {
      const Vector3 shifted{at[0] + 3.1 * c, at[1] - 1.7 * c, at[2] + 0.9 * c};
      out[c] += kMost * warp_km / model.settings.radius_km *
                coasts.fbm(shifted, model.settings.radius_km / (kWavelength * warp_km), kOctaves);
    }
    return normalised(out);
  };
  SphereCrust& crust = model.state.crust;
  double changed = 0.0, thickened_m = 0.0;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    const std::int16_t p = crust.plate[i];
    if (p < 0 || (crust.continental[i] != 0) == continental) continue;
    if (!holds(warped(times(model.frame[p], model.mesh->samples().position(i))))) continue;
    changed += model.sample_km2();
    thickened_m += continental ? kThick_m : -crust.thickness_m[i];
    crust.continental[i] = continental ? 1 : 0;
    crust.orogeny[i] = 0;
    crust.orogeny_age_myr[i] = 0.0F;
    crust.thickness_m[i] =
        continental ? kThick_m : static_cast<float>(1e3 * model.settings.oceanic_km);
    crust.elevation_m[i] =
        continental
            ? kLand_m
            : static_cast<float>(model.settings.floor_by_age ? -ocean_depth_m(crust.age_myr[i])
                                                             : 1e3 * model.settings.law.abyss_km);
  }
  model.budget.changed_km3 += 1e-3 * model.sample_km2() * thickened_m;
  derive_plates(model);
  return changed;
}

std::vector<double> plate_areas_km2(const SphereTectonics& model) {
  std::vector<double> area(model.state.plates.size(), 0.0);
  for (std::size_t p = 0; p < area.size(); ++p) {
    area[model.state.root(static_cast<int>(p))] +=
        model.sample_km2() * model.partition.cap(static_cast<int>(p)).samples;
  }
  return area;
}

}  // namespace geo
