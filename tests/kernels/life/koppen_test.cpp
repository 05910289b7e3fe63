#include "geo/kernels/life/koppen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "geo/core/random.hpp"

namespace geo {
namespace {

using Months = std::array<double, 12>;

// Twelve months with the warmest (or wettest) in July, or in January in the south.
Months harmonic_months(double mean, double amplitude, bool southern) {
  Months months;
  for (int m = 0; m < 12; ++m) {
    months[m] = mean + amplitude * std::cos((m - (southern ? 0 : 6)) * std::numbers::pi / 6);
  }
  return months;
}

TEST(Koppen, ClosedFormEqualsTwelveMonthsInBothHemispheres) {
  const RandomStream random(1, "koppen");
  for (int n = 0; n < 2000; ++n) {
    const double mean = random.uniform(n, 0, -40, 35), range = random.uniform(n, 1, 0, 60);
    const double annual = random.uniform(n, 2, 0, 4000), s = random.uniform(n, 3, -1, 1);
    const auto closed = harmonic_indices(mean, range, annual, s);
    for (const bool southern : {false, true}) {
      SCOPED_TRACE(n);
      const auto months =
          monthly_indices(harmonic_months(mean, range / 2, southern),
                          harmonic_months(annual / 12, annual / 12 * s, southern), southern);
      EXPECT_NEAR(months.mean_c, closed.mean_c, 1e-9);
      EXPECT_NEAR(months.warmest_c, closed.warmest_c, 1e-9);
      EXPECT_NEAR(months.coldest_c, closed.coldest_c, 1e-9);
      EXPECT_EQ(months.months_above_10c, closed.months_above_10c);
      EXPECT_NEAR(months.annual_mm, closed.annual_mm, 1e-8);
      EXPECT_NEAR(months.summer_mm, closed.summer_mm, 1e-8);
      EXPECT_NEAR(months.driest_mm, closed.driest_mm, 1e-9);
      EXPECT_NEAR(months.summer_driest_mm, closed.summer_driest_mm, 1e-9);
      EXPECT_NEAR(months.summer_wettest_mm, closed.summer_wettest_mm, 1e-9);
      EXPECT_NEAR(months.winter_driest_mm, closed.winter_driest_mm, 1e-9);
      EXPECT_NEAR(months.winter_wettest_mm, closed.winter_wettest_mm, 1e-9);
    }
  }
}

TEST(Koppen, EveryClassHasAHarmonicClimate) {
  struct Case {
    int expected;
    double mean_c, range_k, annual_mm, seasonality;
  };
  const Case cases[]{
      {1, 26, 2, 2500, 0.1},   {2, 26, 2, 2500, 0.8},    {3, 26, 4, 1200, 0.9},
      {4, 25, 15, 50, 0.0},    {5, 8, 30, 50, 0.0},      {6, 25, 10, 450, 0.5},
      {7, 8, 25, 250, 0.0},    {8, 17, 14, 600, -0.8},   {9, 14, 10, 800, -0.8},
      {10, 6, 9.5, 900, -0.7}, {11, 19, 16, 1200, 0.9},  {12, 14, 10, 1000, 0.9},
      {13, 6, 9.5, 900, 0.9},  {14, 17, 18, 1200, 0.0},  {15, 10, 12, 900, 0.0},
      {16, 6, 9.5, 900, 0.0},  {17, 10, 30, 500, -0.8},  {18, 6, 24, 500, -0.8},
      {19, -1, 24, 500, -0.8}, {20, -15, 54, 300, -0.8}, {21, 10, 32, 700, 0.9},
      {22, 4, 34, 600, 0.9},   {23, -4, 34, 400, 0.9},   {24, -15, 54, 300, 0.9},
      {25, 9, 30, 800, 0.0},   {26, 5, 28, 700, 0.1},    {27, -2, 30, 500, 0.1},
      {28, -12, 56, 250, 0.3}, {29, -8, 24, 300, 0.2},   {30, -30, 30, 100, 0.0},
  };
  for (const Case& c : cases) {
    const auto climate = harmonic_indices(c.mean_c, c.range_k, c.annual_mm, c.seasonality);
    EXPECT_EQ(koppen_class(climate), c.expected)
        << "T " << c.mean_c << " range " << c.range_k << " P " << c.annual_mm;
  }
}

TEST(Koppen, KnownStationsFallIntoTheirClasses) {
  // Rounded climate normals, January to December.
  struct Station {
    const char* name;
    int expected;
    bool southern;
    Months t, p;
  };
  const Station stations[]{
      {"Singapore",
       1,
       false,
       {26.8, 27.3, 27.9, 28.2, 28.6, 28.5, 28.2, 28.1, 28, 27.9, 27.2, 26.8},
       {222, 105, 151, 164, 164, 135, 147, 149, 128, 168, 250, 332}},
      {"Cairo",
       4,
       false,
       {14, 15.1, 17.6, 21.5, 24.9, 27.4, 28, 27.7, 26, 23.6, 19.2, 15.2},
       {5, 4, 4, 1, 0, 0, 0, 0, 0, 1, 4, 6}},
      {"Rome",
       8,
       false,
       {7.5, 8.2, 10.2, 12.6, 17.2, 21.1, 24.1, 24.5, 20.8, 16.4, 11.4, 8.4},
       {67, 73, 58, 81, 53, 34, 19, 37, 73, 113, 115, 81}},
      {"London",
       15,
       false,
       {5.2, 5.3, 7.6, 9.9, 13.3, 16.5, 18.7, 18.5, 15.7, 12, 8, 5.5},
       {55, 41, 42, 44, 49, 45, 45, 50, 49, 69, 59, 55}},
      {"Moscow",
       26,
       false,
       {-6.5, -6.7, -1, 6.7, 13.2, 17, 19.2, 17, 11.3, 5.6, -1.2, -5.2},
       {52, 41, 35, 37, 49, 80, 85, 82, 68, 71, 55, 52}},
      {"Yakutsk",
       28,
       false,
       {-38.6, -33.8, -20.1, -4.8, 7.5, 16.4, 19.5, 15.2, 6.1, -7.8, -27, -37.6},
       {9, 8, 7, 9, 20, 37, 39, 37, 32, 18, 16, 10}},
      {"Sydney",
       14,
       true,
       {23.5, 23.4, 22.1, 19.5, 16.6, 14.2, 13.4, 14.5, 17, 18.9, 20.4, 22.1},
       {102, 117, 131, 127, 117, 133, 97, 81, 68, 77, 84, 78}},
      {"Vostok",
       30,
       true,
       {-32, -44, -58, -65, -66, -65, -67, -68, -66, -57, -43, -32},
       {1, 1, 2, 2, 3, 2, 2, 2, 2, 2, 1, 1}},
  };
  for (const Station& s : stations) {
    EXPECT_EQ(koppen_class(monthly_indices(s.t, s.p, s.southern)), s.expected) << s.name;
  }
}

TEST(Koppen, DrynessThresholdFollowsTheWetSeason) {
  // At 20 °C: 2T + 28 = 68 cm with summer rain, 40 with winter rain, 54 without a season.
  const auto is_arid = [](double annual_mm, double s) {
    const int k = koppen_class(harmonic_indices(20, 10, annual_mm, s));
    return k >= 4 && k <= 7;
  };
  for (const auto& [s, threshold_mm] : {std::pair{0.8, 680.0}, {-0.8, 400.0}, {0.0, 540.0}}) {
    EXPECT_TRUE(is_arid(threshold_mm - 1, s));
    EXPECT_FALSE(is_arid(threshold_mm + 1, s));
  }
}

TEST(Koppen, AridComesBeforePolar) {
  EXPECT_EQ(koppen_class(harmonic_indices(2, 14, 30, 0)), 5) << "Beck: BWk, Peel would say ET";
}

TEST(Koppen, AClassTellsTheSeasonsThatMadeIt) {
  const auto same = [](const KoppenSeasons& a, const KoppenSeasons& b) {
    if (a.tropical) return b.tropical && a.rainforest == b.rainforest;
    return !b.tropical && a.dry_summers == b.dry_summers && a.short_summers == b.short_summers;
  };
  std::set<int> classes;
  for (double mean_c = -25.0; mean_c <= 30.0; mean_c += 1.0) {
    // Where the year has a range of 60 K, letter a comes with three months above 10 °C.
    for (double range_k = 1.0; range_k <= 46.0; range_k += 5.0) {
      for (double annual_mm = 300.0; annual_mm <= 3300.0; annual_mm += 300.0) {
        for (double s = -0.95; s <= 0.95; s += 0.1) {
          const KoppenIndices climate = harmonic_indices(mean_c, range_k, annual_mm, s);
          const auto own = koppen_class(climate);
          const KoppenSeasons told = seasons_of(own, {}), from_months = seasons_of(climate);
          if (own >= 29 || (own >= 4 && own <= 7)) continue;  // E and B do not tell
          ASSERT_TRUE(same(told, from_months)) << int{own} << ": " << mean_c << " " << range_k;
          classes.insert(own);
        }
      }
    }
  }
  EXPECT_GE(classes.size(), 18U);
}

TEST(Koppen, TheMonthsOfAClassComeBeforeHarmonics) {
  const KoppenIndices long_summer = harmonic_indices(3.0, 32.0, 600.0, 0.3);
  EXPECT_FALSE(seasons_of(long_summer).short_summers);
  EXPECT_TRUE(seasons_of(27, long_summer).short_summers) << "Dfc";
  EXPECT_FALSE(seasons_of(29, long_summer).short_summers) << "ET does not tell";
}

}  // namespace
}  // namespace geo
