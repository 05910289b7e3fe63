#pragma once

#include <array>
#include <complex>

namespace geo {

inline constexpr int kMonths = 12;

/// Solar longitude (degrees, 0 at the northern spring equinox) at the middle of a month on a
/// circular orbit: month 0 is January, whose middle lies 64 days before that equinox.
[[nodiscard]] double month_solar_longitude_deg(int month);

/// Daily mean insolation at the top of the atmosphere, W m-2, on a circular orbit:
///   Q = S0/pi (h0 sin(lat) sin(dec) + cos(lat) cos(dec) sin(h0)),  cos h0 = -tan(lat) tan(dec),
/// sin(dec) = sin(obliquity) sin(solar longitude). Berger (1978), eccentricity 0.
[[nodiscard]] double daily_insolation_w_m2(double latitude_deg, double solar_longitude_deg,
                                           double obliquity_deg, double solar_constant_w_m2);

/// Annual mean and first annual harmonic of the insolation at one latitude:
/// Q(L) = mean + Re(harmonic e^{iL}) + higher harmonics, L the solar longitude.
struct InsolationCycle {
  double mean_w_m2;
  std::complex<double> harmonic_w_m2;
};
/// Quadrature over the orbit; relative error below 1e-5.
[[nodiscard]] InsolationCycle insolation_cycle(double latitude_deg, double obliquity_deg,
                                               double solar_constant_w_m2);

/// Insolation at the middle of each month, W m-2.
[[nodiscard]] std::array<double, kMonths> monthly_insolation_w_m2(double latitude_deg,
                                                                  double obliquity_deg,
                                                                  double solar_constant_w_m2);

}  // namespace geo
