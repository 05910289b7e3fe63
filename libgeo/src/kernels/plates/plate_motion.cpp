#include "geo/kernels/plates/plate_motion.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "geo/core/array_sizes.hpp"

namespace geo {

Vector3 euler_rotation(double pole_latitude_deg, double pole_longitude_deg, double rate_deg_myr) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double lat = pole_latitude_deg * kRadians, lon = pole_longitude_deg * kRadians;
  const Vector3 pole{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
  return scaled(pole, rate_deg_myr * kRadians);
}

EastNorth east_north(const Vector3& vector, const Vector3& unit) {
  const double cos_lat = std::hypot(unit[0], unit[1]);
  const double cos_lon = cos_lat > 0.0 ? unit[0] / cos_lat : 1.0;
  const double sin_lon = cos_lat > 0.0 ? unit[1] / cos_lat : 0.0;
  return {-sin_lon * vector[0] + cos_lon * vector[1],
          -unit[2] * (cos_lon * vector[0] + sin_lon * vector[1]) + cos_lat * vector[2]};
}

void VelocityFit::add(const Vector3& unit, const EastNorth& velocity_mm_yr, double area) {
  const double cos_lat = std::hypot(unit[0], unit[1]);
  const double cos_lon = cos_lat > 0.0 ? unit[0] / cos_lat : 1.0;
  const double sin_lon = cos_lat > 0.0 ? unit[1] / cos_lat : 0.0;
  const Vector3 east{-sin_lon, cos_lon, 0.0};
  const Vector3 north{-unit[2] * cos_lon, -unit[2] * sin_lon, cos_lat};
  const Vector3 velocity = geo::add(scaled(east, velocity_mm_yr.east), north, velocity_mm_yr.north);
  moment_ = geo::add(moment_, cross(unit, velocity), area);
  centre_ = geo::add(centre_, unit, area);
  for (int c = 0; c < 3; ++c) {
    inertia_[c][c] += area;
    inertia_[c] = geo::add(inertia_[c], unit, -area * unit[c]);
  }
}

Vector3 VelocityFit::rotation_rad_myr(double radius_km) const {
  const Vector3 first = cross(inertia_[1], inertia_[2]);
  const double determinant = dot(inertia_[0], first);
  const double trace = inertia_[0][0] + inertia_[1][1] + inertia_[2][2];
  constexpr double kSingular = 1e-9;
  if (determinant > kSingular * trace * trace * trace) {
    const Vector3 solved{dot(moment_, first), dot(moment_, cross(inertia_[2], inertia_[0])),
                         dot(moment_, cross(inertia_[0], inertia_[1]))};
    return scaled(solved, 1.0 / (determinant * radius_km));
  }
  return trace > 0.0 ? scaled(tangent(moment_, normalised(centre_)), 2.0 / (trace * radius_km))
                     : Vector3{};
}

Vector3 net_rotation(std::span<const std::int16_t> plate, std::span<const Vector3> unit,
                     std::span<const double> area_sr, std::span<const Vector3> rotation) {
  check_sizes("net_rotation", plate.size(), {{"unit", unit.size()}, {"area_sr", area_sr.size()}});
  Vector3 sum{};
  for (std::size_t k = 0; k < plate.size(); ++k) {
    const Vector3& r = unit[k];
    sum = add(sum, cross(r, cross(rotation[plate[k]], r)), area_sr[k]);
  }
  return scaled(sum, 3.0 / (8.0 * std::numbers::pi));
}

}  // namespace geo
