#pragma once

#include <array>
#include <cstdint>

namespace geo {

/// What the Köppen-Geiger rules need to know of a climate. Temperatures in °C, precipitation in mm
/// (per month unless said). Half-years are the six warm and the six cold months of the hemisphere.
struct KoppenIndices {
  double mean_c = 0.0;       ///< annual mean
  double warmest_c = 0.0;    ///< warmest month
  double coldest_c = 0.0;    ///< coldest month
  int months_above_10c = 0;  ///< months of at least 10 °C
  double annual_mm = 0.0;    ///< per year
  double driest_mm = 0.0;    ///< driest month
  double summer_mm = 0.0;    ///< in the warm half-year
  double summer_driest_mm = 0.0, summer_wettest_mm = 0.0;
  double winter_driest_mm = 0.0, winter_wettest_mm = 0.0;
};

/// Indices of twelve months from January; `southern` makes October to March the summer half.
KoppenIndices monthly_indices(const std::array<double, 12>& temperature_c,
                              const std::array<double, 12>& precipitation_mm, bool southern);

/// Indices of the harmonic year T = mean + range / 2 cos(θ), P = annual / 12 (1 + s cos(θ)),
/// θ = 0 in midsummer and 30 degrees a month, in closed form. The hemisphere drops out: both
/// harmonics count from its summer. `seasonality` is cut to [-1, 1], so that no month is negative.
KoppenIndices harmonic_indices(double mean_c, double range_k, double annual_mm, double seasonality);

/// Whether summers are the dry season, as in Cs and Ds: a month of the summer half-year below 40 mm
/// and a third of the wettest one in winter.
bool has_dry_summers(const KoppenIndices& climate);

/// Whether a tropical climate keeps a rainforest, as in Af and Am (Kottek et al. 2006): no month
/// below 60 mm, or below 100 mm less a 25th of the year's precipitation, which outlasts a short dry
/// season.
bool keeps_rainforest(const KoppenIndices& climate);

/// What decides among biomes of like means.
struct KoppenSeasons {
  bool tropical = false;       ///< no month below 18 °C
  bool dry_summers = false;    ///< second letter s
  bool rainforest = false;     ///< `keeps_rainforest`
  bool short_summers = false;  ///< third letters c and d: at most three months reach 10 °C
};
KoppenSeasons seasons_of(const KoppenIndices& climate);
/// The same where a class tells it: one of A, C and D. Of others, what `climate` says.
KoppenSeasons seasons_of(std::int8_t koppen_class, const KoppenIndices& climate);

/// Köppen-Geiger class, numbered 1 (Af) to 30 (EF) as in Beck et al. (2018), whose rules these are
/// (after Peel et al. 2007): arid B before everything, then A, C, D and polar E. Peel tests E
/// first; the two differ for cold deserts alone.
std::int8_t koppen_class(const KoppenIndices& climate);

}  // namespace geo
