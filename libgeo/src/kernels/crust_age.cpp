#include "geo/kernels/crust_age.hpp"

#include <algorithm>
#include <cmath>

namespace geo {
namespace {

/// A point of a ridge, the way its plate leaves it, and how long it takes for a radian.
struct RidgePoint {
  Vector3 position;
  Vector3 away;
  double myr_per_rad;
};

/// Time against the straight flight: floor moves along the spreading direction; what lies aside
/// was made by another part of the ridge, or before this one was there.
double detour(const RidgePoint& ridge, const Vector3& here) {
  constexpr double kAside = 0.4;
  const Vector3 heading = tangent(here, ridge.position);
  const double size2 = dot(heading, heading);
  if (size2 <= 0.0) return 1.0;
  const double along = std::max(0.0, dot(ridge.away, heading));
  return 1.0 / (kAside + (1.0 - kAside) * along * along / size2);
}

/// Square of the least time from any point of the ridges, Myr2; `first` is the point to begin with
/// and becomes the one that was found.
double least_time2(const std::vector<RidgePoint>& ridges, const Vector3& here, std::size_t& first) {
  double least2 = 1e30;
  const auto offer = [&](std::size_t k) {
    const RidgePoint& ridge = ridges[k];
    const double chord2 = std::max(0.0, 2.0 - 2.0 * dot(here, ridge.position));
    const double straight2 = chord2 * ridge.myr_per_rad * ridge.myr_per_rad;
    if (straight2 >= least2) return;
    const double factor = detour(ridge, here);
    const double time2 = straight2 * factor * factor;
    if (time2 >= least2) return;
    least2 = time2;
    first = k;
  };
  if (!ridges.empty()) offer(first);
  for (std::size_t k = 0; k < ridges.size(); ++k) offer(k);
  return least2;
}

}  // namespace

std::vector<float> ocean_age_myr(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                                 std::span<const BoundaryPoint> boundaries,
                                 std::span<const Vector3> rotation_rad_myr, double oldest_myr,
                                 double radius_km) {
  constexpr double kSlowest_mm_yr = 4.0;
  const auto plates = 1 + *std::max_element(plate.begin(), plate.end());
  std::vector<std::vector<RidgePoint>> ridges(plates);
  for (const BoundaryPoint& point : boundaries) {
    if (point.type != BoundaryType::divergent) continue;
    const double half_rate_km_myr = std::max(kSlowest_mm_yr, 0.5 * point.motion.opening);
    const Vector3& at = mesh.position(point.cell);
    const Vector3 relative =
        cross(add(rotation_rad_myr[point.plate], rotation_rad_myr[point.other], -1.0), at);
    ridges[point.plate].push_back({at, normalised(relative), radius_km / half_rate_km_myr});
  }
  std::vector<float> age(mesh.size());
#pragma omp parallel
  {
    // Where the floor of the cell before came from: a guess that spares most detours.
    std::vector<std::size_t> origin(plates, 0);
#pragma omp for schedule(dynamic, 1024)
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      const std::vector<RidgePoint>& own = ridges[plate[cell]];
      const double time = std::sqrt(least_time2(own, mesh.position(cell), origin[plate[cell]]));
      age[cell] = static_cast<float>(oldest_myr * std::tanh(time / oldest_myr));
    }
  }
  return age;
}

}  // namespace geo
