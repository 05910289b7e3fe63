#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>

#include "geo/core/field.hpp"
#include "geo/core/grid.hpp"
#include "geo/kernels/life/koppen.hpp"

namespace geo {

/// Some of the biomes.
class BiomeSet {
 public:
  constexpr BiomeSet() = default;
  constexpr BiomeSet(std::initializer_list<Biome> biomes) {
    for (const Biome b : biomes) bits_ |= bit(b);
  }
  [[nodiscard]] constexpr bool has(Biome b) const { return (bits_ & bit(b)) != 0; }
  [[nodiscard]] constexpr BiomeSet without(Biome b) const {
    BiomeSet rest;
    rest.bits_ = bits_ & ~bit(b);
    return rest;
  }

 private:
  static constexpr unsigned bit(Biome b) { return 1U << static_cast<unsigned>(b); }
  unsigned bits_ = 0;
};

/// The land biomes that climate alone sets: all but alpine.
inline constexpr BiomeSet kClimaticBiomes{Biome::tundra,
                                          Biome::boreal_forest,
                                          Biome::temperate_forest,
                                          Biome::temperate_grassland,
                                          Biome::mediterranean_scrub,
                                          Biome::tropical_rainforest,
                                          Biome::tropical_savanna,
                                          Biome::hot_desert,
                                          Biome::subtropical_forest,
                                          Biome::steppe};

/// Biome whose centroid is nearest in (T / 15 °C, P / 500 mm) among some of the climatic ones; of
/// equal distances the first in their list; tundra if there are none. Method: Whittaker (1975).
Biome nearest_biome(double temperature_c, double precipitation_mm_yr,
                    BiomeSet among = kClimaticBiomes);

/// The climatic biomes whose seasons a climate has. Where no month is below 18 °C (Köppen's
/// tropics) these are rainforest, savanna and desert; elsewhere all but the rainforest, and
/// Mediterranean scrub only where summers are the dry season.
BiomeSet biomes_in_season(const KoppenSeasons& seasons);

/// The biome of a climate by its means and seasons: the nearest centroid among those of
/// biomes_in_season. In the tropics a climate of Köppen's classes Af and Am, without a dry season
/// or with rain that outlasts it, is rainforest all the same; a cool forest is boreal where summers
/// are short, temperate elsewhere. Tundra, which is a matter of trees and not of means, only
/// `with_tundra`.
Biome seasonal_biome(double temperature_c, double precipitation_mm_yr, const KoppenSeasons& seasons,
                     bool with_tundra);

/// Part of the harmonic year T = mean + range / 2 cos(θ) that is warmer than a threshold.
struct GrowingSeason {
  double mean_c;  ///< mean temperature of that part; the annual maximum where there is none
  double days;
};
GrowingSeason growing_season(double mean_c, double range_k, double threshold_c);

/// What limits trees everywhere on Earth (Paulsen & Körner 2014): a season above 0.9 °C that
/// lasts 94 days and averages 6.4 °C.
inline constexpr double kSeasonThreshold_c = 0.9;
inline constexpr double kSeasonLength_days = 94.0;
inline constexpr double kTreelineSeason_c = 6.4;

/// By how much a climate is too cold for trees, K: positive beyond the treeline. The limit on the
/// length of the season enters as the warming that would lift the season to it.
double treeline_deficit_k(double mean_c, double range_k);

/// Removes patches of biome smaller than `length_m`: a land cell that shares its biome with fewer
/// than two of the four cells that lie that far to the north, east, south and west takes the
/// most frequent land biome among them (of equal counts the lower number). Two sweeps, each from
/// the result of the one before. A length under half a cell changes nothing. `scratch` holds as
/// many cells as `biome`. Cost: linear, threaded over rows.
/// Throws Bug where sizes differ.
void smooth_biomes(const Grid& grid, double length_m, std::span<std::int8_t> biome,
                   std::span<std::int8_t> scratch);

}  // namespace geo
