#include "geo/kernels/landscape/snow_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geo {
namespace {

TEST(SnowBalance, DegreeDaysOfScatterAloneAreExact) {
  const SnowLaw law;
  const FrostOfYear year = frost_of_year(law, 0.0, 0.0);
  const double exact = law.year_d * law.scatter_k / std::sqrt(2.0 * std::numbers::pi);
  EXPECT_NEAR(year.degree_days, exact, 1e-9 * exact);
  EXPECT_NEAR(year.snow_share, 0.5, 1e-12);
}

TEST(SnowBalance, OfOneMonthIsThatOfTheNormalDistribution) {
  const SnowLaw law;
  for (double t = -10.0; t < 10.0; t += 0.00173) {
    const FrostOfYear year = frost_of_year(law, t * law.scatter_k, 0.0);
    const double density = std::exp(-0.5 * t * t) / std::sqrt(2.0 * std::numbers::pi);
    const double above = 0.5 * std::erfc(-t / std::numbers::sqrt2);
    EXPECT_NEAR(year.snow_share, 1.0 - above, 1e-11) << t;
    EXPECT_NEAR(year.degree_days, law.year_d * law.scatter_k * (density + t * above), 1e-7) << t;
  }
}

TEST(SnowBalance, DegreeDaysMatchAQuadratureOverDays) {
  const SnowLaw law;
  for (const auto& [mean, range] : {std::pair{-12.0, 30.0}, std::pair{2.0, 10.0}}) {
    double sum = 0.0;
    constexpr int kParts = 4000;
    for (int m = 0; m < 12; ++m) {
      const double month = mean + 0.5 * range * std::cos(m * std::numbers::pi / 6.0);
      for (int n = 0; n < kParts; ++n) {
        const double x = -8.0 + 16.0 * (n + 0.5) / kParts;
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
        sum += 16.0 / kParts * density * std::max(0.0, month + law.scatter_k * x) / 12.0;
      }
    }
    // The midpoint rule over the kink at 0 degC: 1e-5.
    EXPECT_NEAR(frost_of_year(law, mean, range).degree_days, law.year_d * sum,
                1e-4 * law.year_d * sum);
  }
}

TEST(SnowBalance, FrostKeepsAllSnowAndWarmthMeltsAsItsDegreeDaysSay) {
  const SnowLaw law;
  EXPECT_NEAR(snow_balance_m_yr(law, -50.0, 10.0, 910.0), 1.0, 1e-9);
  // 10 standard deviations above freezing: no snow, every day melts ice.
  const double days = 45.0 * law.year_d;
  EXPECT_NEAR(snow_balance_m_yr(law, 45.0, 0.0, 500.0), -law.ice_melt_mm_k_d * days / law.ice_kg_m3,
              1e-6);
}

TEST(SnowBalance, MeltwaterFreezesInSnowBeforeAnyIsLost) {
  const SnowLaw law;
  // At -8 degC without seasons a few degree-days melt less than the snow can hold.
  const FrostOfYear year = frost_of_year(law, -8.0, 0.0);
  const double snow = year.snow_share * 2000.0;
  ASSERT_LT(law.snow_melt_mm_k_d * year.degree_days, law.refreezing * snow);
  EXPECT_NEAR(snow_balance_m_yr(law, -8.0, 0.0, 2000.0), snow / law.ice_kg_m3, 1e-12);
}

TEST(SnowBalance, RainOfSummersIsNoSnow) {
  const SnowLaw law;
  // Half of the year far above freezing, half far below: the cosine's mean over the frost is 2 / pi
  // of its amplitude, by seven months rather less.
  const double even = frost_of_year(law, 0.0, 400.0).snow_share;
  const double wet_summers = frost_of_year(law, 0.0, 400.0, 1.0).snow_share;
  EXPECT_NEAR(even, 0.5, 1e-9);
  EXPECT_NEAR(wet_summers, 0.5 - 1.0 / std::numbers::pi, 0.01);
  EXPECT_NEAR(frost_of_year(law, 0.0, 400.0, -1.0).snow_share, 1.0 - wet_summers, 1e-9);
  // Where it never thaws all is snow.
  EXPECT_NEAR(frost_of_year(law, -60.0, 20.0, 1.0).snow_share, 1.0, 1e-9);
  EXPECT_EQ(frost_of_year(law, -5.0, 20.0, 1.0).degree_days,
            frost_of_year(law, -5.0, 20.0).degree_days);
}

TEST(SnowBalance, FallsAsTheYearWarms) {
  const SnowLaw law;
  for (const double range : {0.0, 15.0, 40.0}) {
    double before = snow_balance_m_yr(law, -60.0, range, 800.0);
    for (double mean = -59.5; mean < 30.0; mean += 0.5) {
      const double now = snow_balance_m_yr(law, mean, range, 800.0);
      EXPECT_LE(now, before + 1e-12) << mean << " degC, range " << range;
      before = now;
    }
  }
}

}  // namespace
}  // namespace geo
