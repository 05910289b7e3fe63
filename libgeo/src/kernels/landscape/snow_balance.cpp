#include "geo/kernels/landscape/snow_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

/// The standard normal distribution: density and share below, by cubics that meet both and their
/// slopes at every 1/256; off by less than 1e-11. A glacier asks for seven a cell.
class NormalTable {
 public:
  struct Value {
    double density, below;
  };

  NormalTable() {
    const double per_root = 1.0 / std::sqrt(2.0 * std::numbers::pi);
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const double t = static_cast<double>(k) / kPerUnit - kMost;
      nodes_[k] = {per_root * std::exp(-0.5 * t * t), 0.5 * std::erfc(-t / std::numbers::sqrt2)};
    }
  }
  [[nodiscard]] Value at(double t) const {
    const double place = (t + kMost) * kPerUnit;
    if (!(place > 0.0)) return {0.0, 0.0};
    if (!(place < 2.0 * kMost * kPerUnit)) return {0.0, 1.0};
    const auto k = static_cast<std::size_t>(place);
    const double x = place - static_cast<double>(k);
    const Value &a = nodes_[k], &b = nodes_[k + 1];
    const double left = static_cast<double>(k) / kPerUnit - kMost, right = left + kStep;
    return {cubic(x, a.density, b.density, -left * a.density, -right * b.density),
            cubic(x, a.below, b.below, a.density, b.density)};
  }

 private:
  static constexpr int kMost = 9, kPerUnit = 256;
  static constexpr double kStep = 1.0 / kPerUnit;
  static double cubic(double x, double a, double b, double slope_a, double slope_b) {
    const double rise = b - a, left = kStep * slope_a, right = kStep * slope_b;
    return a + x * (left + x * (3.0 * rise - 2.0 * left - right + x * (left + right - 2.0 * rise)));
  }

  std::array<Value, 2 * kMost * kPerUnit + 1> nodes_;
};

}  // namespace

FrostOfYear frost_of_year(const SnowLaw& law, double mean_c, double range_k, double summer_rain) {
  // Twelve months of a cosine are seven temperatures, those between the ends twice.
  constexpr int kHalf = 6;
  static const std::array<double, kHalf + 1> kCosine = [] {
    std::array<double, kHalf + 1> cosine{};
    for (int m = 0; m <= kHalf; ++m) cosine[m] = std::cos(m * std::numbers::pi / kHalf);
    return cosine;
  }();
  static const NormalTable kNormal;
  FrostOfYear year;
  for (int m = 0; m <= kHalf; ++m) {
    const double weight = (m == 0 || m == kHalf ? 1.0 : 2.0) / (2.0 * kHalf);
    const double t = (mean_c + 0.5 * range_k * kCosine[m]) / law.scatter_k;
    const auto [density, above_freezing] = kNormal.at(t);
    const double frost = 1.0 - above_freezing;
    const double warmth = density + t * above_freezing;
    year.degree_days += weight * law.scatter_k * law.year_d * std::max(0.0, warmth);
    year.snow_share += weight * (1.0 + summer_rain * kCosine[m]) * frost;
  }
  return year;
}

double snow_balance_m_yr(const SnowLaw& law, double mean_c, double range_k,
                         double precipitation_mm_yr, double summer_rain) {
  const FrostOfYear year = frost_of_year(law, mean_c, range_k, summer_rain);
  const double snow_mm = year.snow_share * precipitation_mm_yr;
  const double melted_mm = std::min(snow_mm, law.snow_melt_mm_k_d * year.degree_days);
  const double lost_mm = std::max(0.0, melted_mm - law.refreezing * snow_mm);
  const double days_left =
      law.snow_melt_mm_k_d > 0.0 ? year.degree_days - melted_mm / law.snow_melt_mm_k_d : 0.0;
  // Superimposed ice melts before that below.
  const double ice_mm = law.ice_melt_mm_k_d * std::max(0.0, days_left);
  const double water_to_ice_m = 1.0 / law.ice_kg_m3;
  return water_to_ice_m * (snow_mm - lost_mm - ice_mm);
}

}  // namespace geo
