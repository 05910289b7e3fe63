#include "geo/kernels/climate/insolation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

/// Kepler's equation M = E - e sin E by Newton's method.
double eccentric_anomaly(double mean_anomaly, double eccentricity) {
  double anomaly = mean_anomaly + eccentricity * std::sin(mean_anomaly);
  for (int step = 0; step < 20; ++step) {
    const double error = anomaly - eccentricity * std::sin(anomaly) - mean_anomaly;
    anomaly -= error / (1.0 - eccentricity * std::cos(anomaly));
  }
  return anomaly;
}

}  // namespace

Sun sun_at(const Orbit& orbit, double year_fraction) {
  constexpr double kEquinox = 79.0 / 365.25;
  const double e = orbit.eccentricity;
  const double perihelion = orbit.perihelion_deg * kRadians;
  // Mean anomaly at the equinox, whose true anomaly is minus the longitude of the perihelion.
  const double squeeze = std::sqrt((1.0 - e) / (1.0 + e));
  const double at_equinox =
      2.0 * std::atan2(squeeze * std::sin(-0.5 * perihelion), std::cos(0.5 * perihelion));
  const double mean_anomaly =
      at_equinox - e * std::sin(at_equinox) + 2.0 * kPi * (year_fraction - kEquinox);
  const double anomaly = eccentric_anomaly(mean_anomaly, e);
  const double true_anomaly =
      2.0 * std::atan2(std::sin(0.5 * anomaly) / squeeze, std::cos(0.5 * anomaly));
  const double distance = 1.0 - e * std::cos(anomaly);
  const double longitude_deg = (true_anomaly + perihelion) / kRadians;
  return {longitude_deg - 360.0 * std::floor(longitude_deg / 360.0), 1.0 / (distance * distance)};
}

Sun sun_of_month(const Orbit& orbit, int month) { return sun_at(orbit, (month + 0.5) / kMonths); }

double daily_insolation_w_m2(double latitude_deg, const Sun& sun, double obliquity_deg,
                             double solar_constant_w_m2) {
  const double sin_declination =
      std::sin(obliquity_deg * kRadians) * std::sin(sun.longitude_deg * kRadians);
  const double cos_declination = std::sqrt(std::max(0.0, 1.0 - sin_declination * sin_declination));
  const double sin_latitude = std::sin(latitude_deg * kRadians);
  const double cos_latitude = std::cos(latitude_deg * kRadians);
  const double along = sin_latitude * sin_declination;
  const double across = cos_latitude * cos_declination;
  const double starlight_w_m2 = solar_constant_w_m2 * sun.nearness;
  if (along >= across) return starlight_w_m2 * along;  // the sun does not set
  if (along <= -across) return 0.0;                    // it does not rise
  const double hour_angle = std::acos(-along / across);
  return starlight_w_m2 / kPi * (hour_angle * along + across * std::sin(hour_angle));
}

double annual_insolation_w_m2(double latitude_deg, const Orbit& orbit, double solar_constant_w_m2) {
  const std::array<double, 1> latitude{latitude_deg};
  return annual_insolation_w_m2(latitude, orbit, solar_constant_w_m2).front();
}

std::vector<double> annual_insolation_w_m2(std::span<const double> latitudes_deg,
                                           const Orbit& orbit, double solar_constant_w_m2) {
  constexpr int kSteps = 720;
  std::array<Sun, kSteps> suns;
  for (int step = 0; step < kSteps; ++step) suns[step] = sun_at(orbit, (step + 0.5) / kSteps);
  std::vector<double> means;
  means.reserve(latitudes_deg.size());
  for (const double latitude_deg : latitudes_deg) {
    double sum = 0.0;
    for (const Sun& sun : suns) {
      sum += daily_insolation_w_m2(latitude_deg, sun, orbit.obliquity_deg, solar_constant_w_m2);
    }
    means.push_back(sum / kSteps);
  }
  return means;
}

std::array<double, kMonths> monthly_insolation_w_m2(double latitude_deg, const Orbit& orbit,
                                                    double solar_constant_w_m2) {
  std::array<double, kMonths> months{};
  for (int month = 0; month < kMonths; ++month) {
    months[month] = daily_insolation_w_m2(latitude_deg, sun_of_month(orbit, month),
                                          orbit.obliquity_deg, solar_constant_w_m2);
  }
  return months;
}

}  // namespace geo
