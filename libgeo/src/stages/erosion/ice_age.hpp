#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/planet.hpp"
#include "geo/core/stage.hpp"
#include "geo/kernels/landscape/glacial_erosion.hpp"
#include "geo/kernels/landscape/plastic_ice.hpp"
#include "geo/kernels/landscape/snow_balance.hpp"
#include "geo/stages/erosion/drainage.hpp"

namespace geo {

/// Glaciers and ice sheets through the cold and the warm times of a run's last `glacial_time_yr`.
/// Each has a climate of its own: the given one, and one colder by `glacial_cooling_k`, more at the
/// poles. Ice grows from what it was in the time before: a few rounds of surface (plastic ice on a
/// bed that its weight holds down), snow balance at that surface, and flux, which says what is
/// covered next.
class IceAge {
 public:
  IceAge(const ErosionParameters& parameters, const Grid& grid, const Planet& planet);

  /// How much of a step that ends `before_today_yr` ago belongs to the ice, yr.
  [[nodiscard]] double years_of_step(double before_today_yr) const;
  /// Lets the ice of `years_yr` work on a surface; see IceWork.
  [[nodiscard]] std::vector<SparseValues<double>> work(const LandClimate& climate, double years_yr,
                                                       std::span<float> elevation_m);
  /// Lets the ice grow or shrink for some rounds in a climate, or in one that is `warmer_k` warmer.
  void follow(const LandClimate& climate, double warmer_k, int rounds,
              std::span<const float> elevation_m);
  /// Ice on the land of today, once its surface is finished: what lives on of that in the climate.
  void settle_today(const LandClimate& climate, std::span<const float> elevation_m);

  /// Of the time settled last, m; mean of the cell. Empty before.
  [[nodiscard]] std::span<const float> thickness_m() const { return thickness_m_; }
  /// Of that ice and of the ground that it holds down.
  [[nodiscard]] std::vector<float> surface_m(std::span<const float> elevation_m) const;
  /// The same of today. With it all that is left of the ice goes.
  [[nodiscard]] std::vector<float> take_thickness_m();
  /// By how much its weight holds down the land beneath and beside it, m; the surface of the ice,
  /// and land without it, stay above the sea.
  [[nodiscard]] std::span<const float> sunk_m() const { return sunk_m_; }
  /// Snow, melt and calving, and how far they close.
  void report(Budget& budget) const;

 private:
  /// A time of one climate.
  struct Age {
    double cooling_k;
    double grounding_m;  ///< deepest sea that ice stands in
    int rounds;
  };
  /// The climate of the cells that ice may come to, which are few.
  struct Cold {
    std::vector<Index> cells;  ///< ascending
    std::vector<float> sea_level_temperature_c, range_k, precipitation_mm_yr, summer_rain;
    std::vector<float> balanced_at_m;  ///< surface that the balance was taken at; NaN: none yet
    bool knows_ice = false;  ///< whether they are of the surface of the ice, not of the ground
  };
  void settle(const LandClimate& climate, const Age& age, std::span<const float> elevation_m);
  void sort_ground(const LandClimate& climate, const Age& age, std::span<const float> elevation_m);
  [[nodiscard]] Cold cold_cells(const LandClimate& climate) const;
  void balance(Cold& cold, const Age& age, std::span<const float> elevation_m,
               SparseValues<float>& balance_m_yr) const;
  void lay(const LandClimate& climate);
  void measure(std::span<const float> elevation_m);
  void melt_away();
  void weigh(std::span<const float> elevation_m);
  [[nodiscard]] double cooling_k(const Age& age, int row) const;

  const ErosionParameters& p_;
  const Grid& grid_;
  SnowLaw snow_;
  GlacialErosion erosion_;
  double k_m_;
  std::vector<IceGround> next_;  ///< what will be covered; empty before the first ice
  std::vector<float> sunk_m_, thickness_m_;
  // While ice works, and what its sums are told from afterwards:
  std::vector<IceGround> ground_;  ///< what the flux stands on
  std::vector<float> bed_m_;
  IceSurface surface_;
  IceFlux flux_;
};

}  // namespace geo
