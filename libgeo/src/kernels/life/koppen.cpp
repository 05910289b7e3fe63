#include "geo/kernels/life/koppen.hpp"

#include <algorithm>

namespace geo {
namespace {

// Positions in Beck's table of the first class of each group.
constexpr int kAf = 1, kAm = 2, kAw = 3, kBWh = 4, kBWk = 5, kBSh = 6, kBSk = 7;
constexpr int kCsa = 8, kCwa = 11, kCfa = 14, kDsa = 17, kDwa = 21, kDfa = 25, kET = 29, kEF = 30;

// cos(0), cos(30°) ... cos(180°): the months on either side of midsummer.
constexpr std::array<double, 7> kCosine{1.0,  0.86602540378443865,  0.5, 0.0,
                                        -0.5, -0.86602540378443865, -1.0};
// Sum of the cosines of the summer half-year, three months before midsummer to two after it.
constexpr double kSummerCosine = 1.0 + 2 * 0.86602540378443865 + 2 * 0.5;

double dryness_threshold_mm(const KoppenIndices& c) {
  const double summer_share = c.annual_mm > 0 ? c.summer_mm / c.annual_mm : 0.5;
  if (summer_share > 0.7) return 10 * (2 * c.mean_c + 28);
  if (summer_share < 0.3) return 10 * 2 * c.mean_c;
  return 10 * (2 * c.mean_c + 14);
}

// Third letter of C and D: 0 hot summer, 1 warm, 2 cold, 3 very cold winter (D alone).
int summer_letter(const KoppenIndices& c) {
  if (c.warmest_c >= 22) return 0;
  if (c.months_above_10c >= 4) return 1;
  return c.coldest_c < -38 ? 3 : 2;
}

}  // namespace

KoppenIndices monthly_indices(const std::array<double, 12>& temperature_c,
                              const std::array<double, 12>& precipitation_mm, bool southern) {
  KoppenIndices c;
  c.warmest_c = *std::max_element(temperature_c.begin(), temperature_c.end());
  c.coldest_c = *std::min_element(temperature_c.begin(), temperature_c.end());
  c.driest_mm = *std::min_element(precipitation_mm.begin(), precipitation_mm.end());
  c.summer_driest_mm = c.winter_driest_mm = 1e30;
  for (int month = 0; month < 12; ++month) {
    const double t = temperature_c[month], p = precipitation_mm[month];
    c.mean_c += t / 12;
    c.annual_mm += p;
    c.months_above_10c += t >= 10;
    const bool april_to_september = month >= 3 && month < 9;
    if (april_to_september != southern) {
      c.summer_mm += p;
      c.summer_driest_mm = std::min(c.summer_driest_mm, p);
      c.summer_wettest_mm = std::max(c.summer_wettest_mm, p);
    } else {
      c.winter_driest_mm = std::min(c.winter_driest_mm, p);
      c.winter_wettest_mm = std::max(c.winter_wettest_mm, p);
    }
  }
  return c;
}

KoppenIndices harmonic_indices(double mean_c, double range_k, double annual_mm,
                               double seasonality) {
  KoppenIndices c;
  const double half = 0.5 * range_k;
  c.mean_c = mean_c;
  c.warmest_c = mean_c + half;
  c.coldest_c = mean_c - half;
  for (int k = 0; k < 7; ++k) {
    const int months = k == 0 || k == 6 ? 1 : 2;
    if (mean_c + half * kCosine[k] >= 10) c.months_above_10c += months;
  }
  const double s = std::clamp(seasonality, -1.0, 1.0);
  const double month_mm = annual_mm / 12;
  c.annual_mm = annual_mm;
  c.summer_mm = annual_mm * (0.5 + s * kSummerCosine / 12);
  // Each half-year runs from a month of mean precipitation to the extreme of its season.
  const double midsummer_mm = month_mm * (1 + s), midwinter_mm = month_mm * (1 - s);
  c.driest_mm = std::min(midsummer_mm, midwinter_mm);
  c.summer_driest_mm = std::min(month_mm, midsummer_mm);
  c.summer_wettest_mm = std::max(month_mm, midsummer_mm);
  c.winter_driest_mm = std::min(month_mm, midwinter_mm);
  c.winter_wettest_mm = std::max(month_mm, midwinter_mm);
  return c;
}

bool has_dry_summers(const KoppenIndices& c) {
  return c.summer_driest_mm < 40 && c.summer_driest_mm < c.winter_wettest_mm / 3;
}

bool keeps_rainforest(const KoppenIndices& c) {
  return c.driest_mm >= std::min(60.0, 100.0 - c.annual_mm / 25.0);
}

KoppenSeasons seasons_of(const KoppenIndices& c) {
  return {.tropical = c.coldest_c >= 18,
          .dry_summers = has_dry_summers(c),
          .rainforest = keeps_rainforest(c),
          .short_summers = c.months_above_10c <= 3};
}

KoppenSeasons seasons_of(std::int8_t koppen_class, const KoppenIndices& climate) {
  constexpr int kLettersOfC = 3, kLettersOfD = 4, kCold = 2;  // a, b, c, d
  if (koppen_class >= kAf && koppen_class <= kAw) {
    return {.tropical = true, .rainforest = koppen_class != kAw};
  }
  if (koppen_class >= kCsa && koppen_class < kDsa) {
    return {.dry_summers = koppen_class < kCwa,
            .short_summers = (koppen_class - kCsa) % kLettersOfC >= kCold};
  }
  if (koppen_class >= kDsa && koppen_class < kET) {
    return {.dry_summers = koppen_class < kDwa,
            .short_summers = (koppen_class - kDsa) % kLettersOfD >= kCold};
  }
  return seasons_of(climate);
}

std::int8_t koppen_class(const KoppenIndices& c) {
  const double threshold_mm = dryness_threshold_mm(c);
  if (c.annual_mm < threshold_mm) {
    const bool hot = c.mean_c >= 18;
    if (c.annual_mm < 0.5 * threshold_mm) return hot ? kBWh : kBWk;
    return hot ? kBSh : kBSk;
  }
  if (c.coldest_c >= 18) {
    if (c.driest_mm >= 60) return kAf;
    return keeps_rainforest(c) ? kAm : kAw;
  }
  if (c.warmest_c <= 10) return c.warmest_c > 0 ? kET : kEF;

  bool dry_summer = has_dry_summers(c);
  bool dry_winter = c.winter_driest_mm < c.summer_wettest_mm / 10;
  if (dry_summer && dry_winter) {  // Beck: the drier half-year decides
    dry_summer = c.summer_mm < 0.5 * c.annual_mm;
    dry_winter = !dry_summer;
  }
  const int letter = summer_letter(c);
  if (c.coldest_c > 0) {
    return static_cast<std::int8_t>((dry_summer ? kCsa : dry_winter ? kCwa : kCfa) + letter);
  }
  return static_cast<std::int8_t>((dry_summer ? kDsa : dry_winter ? kDwa : kDfa) + letter);
}

}  // namespace geo
