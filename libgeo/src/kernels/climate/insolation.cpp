#include "geo/kernels/climate/insolation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {
constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;
}  // namespace

double month_solar_longitude_deg(int month) {
  constexpr double kMidJanuary = 296.9;  // 64 of 365.25 days before the equinox
  return std::fmod(kMidJanuary + 30.0 * month, 360.0);
}

double daily_insolation_w_m2(double latitude_deg, double solar_longitude_deg, double obliquity_deg,
                             double solar_constant_w_m2) {
  const double sin_declination =
      std::sin(obliquity_deg * kRadians) * std::sin(solar_longitude_deg * kRadians);
  const double cos_declination = std::sqrt(std::max(0.0, 1.0 - sin_declination * sin_declination));
  const double sin_latitude = std::sin(latitude_deg * kRadians);
  const double cos_latitude = std::cos(latitude_deg * kRadians);
  const double along = sin_latitude * sin_declination;
  const double across = cos_latitude * cos_declination;
  if (along >= across) return solar_constant_w_m2 * along;  // the sun does not set
  if (along <= -across) return 0.0;                         // it does not rise
  const double hour_angle = std::acos(-along / across);
  return solar_constant_w_m2 / kPi * (hour_angle * along + across * std::sin(hour_angle));
}

InsolationCycle insolation_cycle(double latitude_deg, double obliquity_deg,
                                 double solar_constant_w_m2) {
  constexpr int kSteps = 720;
  double mean = 0.0;
  std::complex<double> harmonic = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const double longitude_deg = (step + 0.5) * 360.0 / kSteps;
    const double insolation =
        daily_insolation_w_m2(latitude_deg, longitude_deg, obliquity_deg, solar_constant_w_m2);
    mean += insolation;
    harmonic += insolation * std::polar(1.0, -longitude_deg * kRadians);
  }
  return {mean / kSteps, 2.0 / kSteps * harmonic};
}

std::array<double, kMonths> monthly_insolation_w_m2(double latitude_deg, double obliquity_deg,
                                                    double solar_constant_w_m2) {
  std::array<double, kMonths> months{};
  for (int month = 0; month < kMonths; ++month) {
    months[month] = daily_insolation_w_m2(latitude_deg, month_solar_longitude_deg(month),
                                          obliquity_deg, solar_constant_w_m2);
  }
  return months;
}

}  // namespace geo
