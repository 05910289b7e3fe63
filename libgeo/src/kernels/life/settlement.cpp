#include "geo/kernels/life/settlement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/numerics/shapes.hpp"

namespace geo {
namespace {

constexpr double kMonth_d = 365.25 / 12.0;
constexpr double kHoldridge_mm_yr_k = 58.93;

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

/// Only warmth between 0 and 30 degC counts for plants (Holdridge 1967).
double potential_mm(double temperature_c) {
  return kHoldridge_mm_yr_k / 12.0 * std::clamp(temperature_c, 0.0, 30.0);
}

/// What a body can do in a month, `wet` being its rain over what could evaporate, at most 1. The
/// noon is as much warmer as the nights are colder than the mean: by 4 K over wet ground, by 7 K
/// over dry. Air is near saturation where the ground is wet, and holds its water through the day.
double work_capacity(double temperature_c, double wet) {
  const double mean_humidity = 0.35 + 0.45 * wet, noon_c = temperature_c + 7.0 - 3.0 * wet;
  const auto saturation = [](double c) { return std::exp(17.27 * c / (c + 237.7)); };
  const double noon_humidity = mean_humidity * saturation(temperature_c) / saturation(noon_c);
  const double globe_c = 0.7 * wet_bulb_c(noon_c, noon_humidity) + 0.3 * noon_c;
  const double excess_k = std::max(0.0, globe_c - 25.0);
  return std::max(0.0, 1.0 - 0.25 * std::cbrt(excess_k * excess_k));
}

/// The same from a table: within 0.01 of it, and a tenth of the time.
class WorkCapacity {
 public:
  WorkCapacity() {
    for (int i = 0; i <= kTemperatures; ++i) {
      for (int k = 0; k <= kWets; ++k) {
        table_[i][k] = work_capacity(kColdest_c + i * kStep_k, static_cast<double>(k) / kWets);
      }
    }
  }
  [[nodiscard]] double at(double temperature_c, double wet) const {
    const double x = std::clamp((temperature_c - kColdest_c) / kStep_k, 0.0, kTemperatures - 1e-9);
    const double y = std::clamp(wet * kWets, 0.0, kWets - 1e-9);
    const int i = static_cast<int>(x), k = static_cast<int>(y);
    const auto row = [&](int r) { return std::lerp(table_[r][k], table_[r][k + 1], y - k); };
    return std::lerp(row(i), row(i + 1), x - i);
  }

 private:
  static constexpr int kTemperatures = 160, kWets = 16;
  static constexpr double kColdest_c = 5.0, kStep_k = 0.25;  // colder, nothing limits work
  std::array<std::array<double, kWets + 1>, kTemperatures + 1> table_{};
};

}  // namespace

MonthlyClimate harmonic_months(double mean_c, double range_k, double annual_mm,
                               double seasonality) {
  MonthlyClimate months{};
  const double s = std::clamp(seasonality, -1.0, 1.0);
  for (int m = 0; m < 12; ++m) {
    const double wave = std::cos(std::numbers::pi / 6.0 * m);
    months.temperature_c[m] = mean_c + 0.5 * range_k * wave;
    months.precipitation_mm[m] = annual_mm / 12.0 * (1.0 + s * wave);
  }
  return months;
}

SettlementLimits settlement_limits(const MonthlyClimate& climate) {
  static const WorkCapacity work;
  double degree_days = 0.0, potential = 0.0, annual = 0.0, capacity = 0.0, mean_c = 0.0;
  for (int m = 0; m < 12; ++m) {
    const double t = climate.temperature_c[m], rain = climate.precipitation_mm[m];
    degree_days += kMonth_d * std::max(0.0, t - 5.0);
    annual += rain;
    const double can_evaporate = potential_mm(t);
    potential += can_evaporate;
    capacity += work.at(t, can_evaporate > 0.0 ? std::min(1.0, rain / can_evaporate) : 1.0) / 12.0;
    mean_c += t / 12.0;
  }
  const double actual = annual > 0.0 ? annual * budyko_evaporated_share(potential / annual) : 0.0;
  const double moisture = potential > 0.0 ? actual / potential : 1.0;
  constexpr double kLeached = 0.5;  // of the yield, on ferralsols and acrisols without fertiliser
  const double leaching =
      smooth_step(15.0, 24.0, mean_c) * smooth_step(200.0, 1200.0, annual - actual);
  return {.warmth = logistic(0.0052 * (degree_days - 1334.0)),
          .water = logistic(14.705 * (moisture - 0.3295)),
          .heat = capacity,
          .soil = 1.0 - kLeached * leaching};
}

double slope_limit(double slope) { return std::clamp((0.45 - slope) / (0.45 - 0.08), 0.0, 1.0); }

double field_slope(double range_m, double length_m) {
  constexpr double kField_m = 1000.0;
  return length_m > kField_m ? range_m / std::sqrt(length_m * kField_m) : range_m / length_m;
}

double wet_bulb_c(double temperature_c, double relative_humidity) {
  const double t = temperature_c, h = 100.0 * std::clamp(relative_humidity, 0.05, 0.99);
  return t * std::atan(0.151977 * std::sqrt(h + 8.313659)) + std::atan(t + h) -
         std::atan(h - 1.676331) + 0.00391838 * h * std::sqrt(h) * std::atan(0.023101 * h) -
         4.686035;
}

}  // namespace geo
