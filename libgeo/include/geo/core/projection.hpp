#pragma once

#include <array>

#include "geo/core/grid.hpp"

namespace geo {

/// Lambert azimuthal equal-area projection of the ellipsoid about a centre, oblique and polar
/// aspects alike (Snyder 1987, eqs 24-2 to 24-34; authalic latitudes from GeographicLib). The same
/// map as PROJ's "+proj=laea". Areas are true everywhere, directions at the centre; at 200 km from
/// it on Earth lengths are off by 1e-4.
class EqualAreaProjection {
 public:
  explicit EqualAreaProjection(Centre centre, Ellipsoid figure = {});

  /// Easting and northing, m, of a geographic position. The antipode of the centre has none: it
  /// comes back as infinity.
  [[nodiscard]] std::array<double, 2> project(Centre position) const;
  /// Position of a projected point, longitude within -180..180. Points beyond the planet (further
  /// than twice the authalic radius) land at the antipode.
  [[nodiscard]] Centre unproject(double x_m, double y_m) const;
  /// Radius of the sphere of the planet's area, m.
  [[nodiscard]] double authalic_radius_m() const noexcept { return radius_m_; }

 private:
  [[nodiscard]] double authalic_rad(double latitude_deg) const;
  Centre centre_;
  Ellipsoid figure_;
  double radius_m_ = 0.0, stretch_ = 1.0, sine_ = 0.0, cosine_ = 1.0;
};

}  // namespace geo
