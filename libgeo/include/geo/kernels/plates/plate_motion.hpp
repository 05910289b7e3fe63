#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geo/core/vector3.hpp"

namespace geo {

/// Rigid motion of plates (Euler's theorem; Cox & Hart 1986): v = Ω × r. Rotations are vectors
/// along the Euler pole, radians per Myr.

/// Rotation about a pole given in degrees, degrees per Myr.
[[nodiscard]] Vector3 euler_rotation(double pole_latitude_deg, double pole_longitude_deg,
                                     double rate_deg_myr);

/// Velocity at a unit vector, mm/yr, as a vector in space. 1 km/Myr is 1 mm/yr.
[[nodiscard]] inline Vector3 velocity_mm_yr(const Vector3& rotation_rad_myr, const Vector3& unit,
                                            double radius_km) {
  return scaled(cross(rotation_rad_myr, unit), radius_km);
}

/// Eastward and northward parts of a vector at a place; at a pole east is that of longitude 0.
struct EastNorth {
  double east, north;
};
[[nodiscard]] EastNorth east_north(const Vector3& vector, const Vector3& unit);

/// The rotation that velocities over a plate tell: the Ω of the least ∫ |v - Ω × r|² dA.
class VelocityFit {
 public:
  /// Adds a piece of the plate: its unit vector, velocity (mm/yr) and weight.
  void add(const Vector3& unit, const EastNorth& velocity_mm_yr, double area);
  /// rad/Myr; of a plate so small that its turn about itself cannot be told, without that.
  [[nodiscard]] Vector3 rotation_rad_myr(double radius_km) const;

 private:
  Vector3 moment_{}, centre_{};
  std::array<Vector3, 3> inertia_{};  // ∫ (1 - r rᵀ) dA
};

/// Net rotation of the lithosphere, (3 / 8 pi) Σ ∫ r × (Ω × r) dA over all plates; subtracting it
/// from every plate leaves none.
/// @param plate     plate of each piece of the sphere
/// @param unit      its position
/// @param area_sr   its solid angle; together 4 pi
/// @param rotation  of each plate
[[nodiscard]] Vector3 net_rotation(std::span<const std::int16_t> plate,
                                   std::span<const Vector3> unit, std::span<const double> area_sr,
                                   std::span<const Vector3> rotation);

}  // namespace geo
