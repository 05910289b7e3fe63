#pragma once

#include <cmath>

#include "geo/core/place.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "support/sampled_sphere.hpp"

namespace geo::test {

inline Vector3 place(double latitude_deg, double longitude_deg) {
  return unit_vector_of({latitude_deg, longitude_deg});
}

/// Two hemispheres of floor about the axis, at speeds of their own (mm/yr, east positive). They
/// close at longitude 180 when the western one, which holds the younger floor, goes west.
inline SphereState hemispheres(const SampledSphere& world, double west_mm_yr, double east_mm_yr) {
  SphereState state;
  state.crust.resize(world.mesh.size());
  for (const double speed_mm_yr : {west_mm_yr, east_mm_yr}) {
    SpherePlate plate;
    plate.axis = {0.0, 0.0, speed_mm_yr < 0.0 ? -1.0 : 1.0};
    plate.speed_rad_myr = std::abs(speed_mm_yr) / kRadius_km;
    state.add_plate(plate);
  }
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    state.crust.plate[i] = longitude_deg(world.samples.position(i)) < 0.0 ? 0 : 1;
    state.crust.thickness_m[i] = 7000.0F;
    state.crust.elevation_m[i] = -5000.0F;
    state.crust.age_myr[i] = state.crust.plate[i] == 0 ? 50.0F : 60.0F;
  }
  return state;
}
/// The same, each with half of the speed at which they part at longitude 0 and close at 180.
inline SphereState hemispheres(const SampledSphere& world, double relative_mm_yr) {
  return hemispheres(world, -0.5 * relative_mm_yr, 0.5 * relative_mm_yr);
}

/// Plates that keep the motions they have: none breaks, and neither slabs nor the frame move them.
inline SphereSettings quiet() {
  SphereSettings settings;
  settings.rift_per_myr = 0.0;
  settings.slab_pull = 0.0;
  settings.no_net_rotation = false;
  return settings;
}

}  // namespace geo::test
