#include "geo/core/projection.hpp"

#include <GeographicLib/Ellipsoid.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

}  // namespace

EqualAreaProjection::EqualAreaProjection(Centre centre, Ellipsoid figure)
    : centre_(centre), figure_(figure) {
  const GeographicLib::Ellipsoid ellipsoid(figure.radius_m, figure.flattening);
  radius_m_ = std::sqrt(ellipsoid.Area() / (4.0 * std::numbers::pi));
  const double authalic = authalic_rad(centre.latitude_deg);
  sine_ = std::sin(authalic);
  cosine_ = std::cos(authalic);
  // Snyder's D: equal scale along the centre's parallel and meridian. Its limit at a pole is 1.
  if (cosine_ > 1e-9) {
    stretch_ = ellipsoid.CircleRadius(centre.latitude_deg) / (radius_m_ * cosine_);
  }
}

double EqualAreaProjection::authalic_rad(double latitude_deg) const {
  if (figure_.flattening == 0.0) return latitude_deg * kRadians;
  return GeographicLib::Ellipsoid(figure_.radius_m, figure_.flattening)
             .AuthalicLatitude(latitude_deg) *
         kRadians;
}

std::array<double, 2> EqualAreaProjection::project(Centre position) const {
  const double beta = authalic_rad(position.latitude_deg);
  const double dlon = (position.longitude_deg - centre_.longitude_deg) * kRadians;
  const double sine = std::sin(beta), cosine = std::cos(beta);
  const double towards = 1.0 + sine_ * sine + cosine_ * cosine * std::cos(dlon);
  constexpr double kAntipode = 1e-12;  // within some ten metres of it only rounding is left
  if (towards <= kAntipode) {
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    return {kNowhere, kNowhere};
  }
  const double scale = radius_m_ * std::sqrt(2.0 / towards);
  return {scale * stretch_ * cosine * std::sin(dlon),
          scale / stretch_ * (cosine_ * sine - sine_ * cosine * std::cos(dlon))};
}

Centre EqualAreaProjection::unproject(double x_m, double y_m) const {
  const double x = x_m / stretch_, y = y_m * stretch_;
  const double rho = std::hypot(x, y);
  if (rho < 1e-9) return centre_;
  const double angle = 2.0 * std::asin(std::min(1.0, rho / (2.0 * radius_m_)));
  const double sine = std::sin(angle), cosine = std::cos(angle);
  const double authalic_sine = std::clamp(cosine * sine_ + y * sine * cosine_ / rho, -1.0, 1.0);
  const double dlon = std::atan2(x * sine, rho * cosine_ * cosine - y * sine_ * sine);
  double latitude = std::asin(authalic_sine) / kRadians;
  if (figure_.flattening != 0.0) {
    latitude = GeographicLib::Ellipsoid(figure_.radius_m, figure_.flattening)
                   .InverseAuthalicLatitude(latitude);
  }
  return {latitude, std::remainder(centre_.longitude_deg + dlon / kRadians, 360.0)};
}

}  // namespace geo
