#include "geo/kernels/plates/plate_motion.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

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

Vector3 net_rotation(std::span<const std::int16_t> plate, std::span<const Vector3> unit,
                     std::span<const double> area_sr, std::span<const Vector3> rotation) {
  Vector3 sum{};
  for (std::size_t k = 0; k < plate.size(); ++k) {
    const Vector3& r = unit[k];
    sum = add(sum, cross(r, cross(rotation[plate[k]], r)), area_sr[k]);
  }
  return scaled(sum, 3.0 / (8.0 * std::numbers::pi));
}

}  // namespace geo
