#pragma once

#include <array>
#include <span>
#include <vector>

namespace geo {

inline constexpr int kMonths = 12;

/// The path of a planet round its star.
struct Orbit {
  double obliquity_deg = 23.44;
  double eccentricity = 0.0;
  double perihelion_deg = 282.9;  ///< solar longitude at which the planet is nearest to its star
};

/// Where the star stands at one time.
struct Sun {
  double longitude_deg;  ///< 0 at the northern spring equinox
  double nearness;       ///< (mean distance / distance)^2
};

/// The star at a time of the year, which runs from 0 to 1 and has the northern spring equinox 79
/// of 365.25 days after its beginning, by Kepler's equation. Months are twelve equal parts.
[[nodiscard]] Sun sun_at(const Orbit& orbit, double year_fraction);

/// The same in the middle of a month, 0 for January.
[[nodiscard]] Sun sun_of_month(const Orbit& orbit, int month);

/// Daily mean insolation at the top of the atmosphere, W m-2:
///   Q = S0/pi n (h0 sin(lat) sin(dec) + cos(lat) cos(dec) sin(h0)),  cos h0 = -tan(lat) tan(dec),
/// sin(dec) = sin(obliquity) sin(solar longitude), n the star's nearness. Berger (1978).
[[nodiscard]] double daily_insolation_w_m2(double latitude_deg, const Sun& sun,
                                           double obliquity_deg, double solar_constant_w_m2);

/// Annual mean of the insolation at one latitude, by quadrature over the orbit; relative error
/// below 1e-5.
[[nodiscard]] double annual_insolation_w_m2(double latitude_deg, const Orbit& orbit,
                                            double solar_constant_w_m2);
/// The same at many.
[[nodiscard]] std::vector<double> annual_insolation_w_m2(std::span<const double> latitudes_deg,
                                                         const Orbit& orbit,
                                                         double solar_constant_w_m2);

/// Insolation at the middle of each month, W m-2.
[[nodiscard]] std::array<double, kMonths> monthly_insolation_w_m2(double latitude_deg,
                                                                  const Orbit& orbit,
                                                                  double solar_constant_w_m2);

}  // namespace geo
