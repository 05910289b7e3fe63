#include "geo/stages/biomes/biomes.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/life/koppen.hpp"
#include "geo/kernels/life/productivity.hpp"
#include "geo/kernels/life/settlement.hpp"
#include "geo/kernels/life/whittaker.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/shapes.hpp"

namespace geo {
namespace {

constexpr double kSavanna_c = 18.0;      // Köppen's limit of the tropics
constexpr double kBorealForest_c = 5.0;  // half-way between the two forests' centroids
constexpr double kFullYield = 2500.0;    // g m-2 yr-1, tropical rainforest

constexpr std::int8_t id(Biome biome) { return static_cast<std::int8_t>(biome); }

/// What a biome needs to know of a climate.
struct Climate {
  double temperature_c, rain_mm_yr;
  KoppenSeasons seasons;
};

/// Treelines that fray: a coherent noise shifts them up and down by position alone.
class Treeline {
 public:
  Treeline(const BiomesParameters& p, const Grid& grid, std::uint64_t seed)
      : p_(p),
        grid_(grid),
        thermal_(p.treeline == "thermal"),
        noise_(seed, "biomes.treeline"),
        frequency_(grid.figure().radius_m / (p.treeline_noise_km * 1000)),
        lapse_k_m_(p.lapse_rate_k_km / 1000) {}

  /// The biome of a land cell before rivers and smoothing.
  [[nodiscard]] Biome biome(int i, int j, double elevation_m, double range_k,
                            const Climate& climate) const {
    const double temperature_c = climate.temperature_c;
    if (!thermal_) {
      const Biome open = by_climate(climate, true);
      return grows_at_treeline(open) && above_fixed_line(i, j, elevation_m) ? Biome::alpine : open;
    }
    const double cold_k = treeline_deficit_k(temperature_c, range_k);
    const double spread_k = p_.treeline_noise_m * lapse_k_m_;
    const double shift_k = std::abs(cold_k) < spread_k ? spread_k * noise(i, j) : 0.0;
    if (cold_k + shift_k <= 0) {
      return by_climate(climate, false);
    }
    // Treeless by height where what stands above the foothills cools by more than the sea level
    // there lacks, else by latitude: the border of the two follows the terrain, not a parallel.
    const double at_sea_level_c = temperature_c + std::max(elevation_m, 0.0) * lapse_k_m_;
    const double lacking_k = std::max(0.0, treeline_deficit_k(at_sea_level_c, range_k));
    if (lacking_k > 0.0 && temperature_c + 0.5 * range_k < 0.0)
      return Biome::tundra;  // or the ice on it
    const double cooled_k = (elevation_m - p_.mountain_m) * lapse_k_m_;
    return cooled_k > lacking_k ? Biome::alpine : Biome::tundra;
  }

 private:
  [[nodiscard]] Biome by_climate(const Climate& climate, bool with_tundra) const {
    const auto& [temperature_c, rain_mm, seasons] = climate;
    if (p_.seasons) return seasonal_biome(temperature_c, rain_mm, seasons, with_tundra);
    return nearest_biome(temperature_c, rain_mm,
                         with_tundra ? kClimaticBiomes : kClimaticBiomes.without(Biome::tundra));
  }
  static bool grows_at_treeline(Biome b) {
    return b == Biome::boreal_forest || b == Biome::temperate_forest ||
           b == Biome::tropical_rainforest || b == Biome::subtropical_forest ||
           b == Biome::temperate_grassland;
  }
  [[nodiscard]] bool above_fixed_line(int i, int j, double elevation_m) const {
    if (elevation_m <= p_.treeline_onset_m) return false;
    const double top_m = p_.treeline_m + p_.treeline_noise_m * full_noise(i, j);
    if (elevation_m > top_m) return true;
    // Between onset and treeline: patches, the denser the higher.
    const double share =
        (elevation_m - p_.treeline_onset_m) / std::max(top_m - p_.treeline_onset_m, 1.0);
    return 0.5 + 1.2 * noise_.fbm(grid_.unit_vector(i, j), 4 * frequency_, 2) < share;
  }
  /// Noise that comes as far as its amplitude.
  [[nodiscard]] double full_noise(int i, int j) const {
    const auto at = grid_.unit_vector(i, j);
    return noise_.value(static_cast<float>(at[0] * frequency_),
                        static_cast<float>(at[1] * frequency_),
                        static_cast<float>(at[2] * frequency_));
  }
  [[nodiscard]] double noise(int i, int j) const {
    return noise_.fbm(grid_.unit_vector(i, j), frequency_, 3);
  }

  const BiomesParameters& p_;
  const Grid& grid_;
  bool thermal_;
  Noise noise_;
  double frequency_;
  double lapse_k_m_;
};

// Water at hand carries trees where the rain alone does not.
std::int8_t riparian(std::int8_t dry, double temperature_c) {
  if (dry != id(Biome::hot_desert) && dry != id(Biome::steppe) &&
      dry != id(Biome::mediterranean_scrub) && dry != id(Biome::temperate_grassland)) {
    return dry;
  }
  if (temperature_c >= kSavanna_c) return id(Biome::tropical_savanna);
  return id(temperature_c >= kBorealForest_c ? Biome::temperate_forest : Biome::boreal_forest);
}

/// The fields that tell what lives where, and those that say it.
struct LifeFields {
  explicit LifeFields(StageIo& io)
      : elevation(io.read(field::elevation)),
        temperature(io.read(field::temperature)),
        range(io.read(field::temperature_range)),
        rain(io.read(field::precipitation)),
        seasonality(io.read(field::precipitation_seasonality)),
        river(io.read_optional(field::river_intensity)),
        lake(io.read_optional(field::lake_depth)),
        coast(io.read_optional(field::distance_to_coast)),
        biome(io.write(field::biome)),
        koppen(io.write(field::koppen_class)),
        productivity(io.write(field::net_primary_productivity)),
        settlement(io.write(field::settlement_suitability)) {}

  std::span<const float> elevation, temperature, range, rain, seasonality;
  std::span<const float> river, lake, coast;  ///< may be empty
  std::span<std::int8_t> biome, koppen;
  std::span<float> productivity, settlement;
};

class BiomesStage final : public Stage {
 public:
  explicit BiomesStage(BiomesParameters parameters) : p_(std::move(parameters)) {}
  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return p_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    return {.per_cell_ns = 140.0, .cell_bytes = 105.0};
  }

  void run(StageIo& io, Context& context) const override {
    const Grid& grid = io.grid();
    const LifeFields fields(io);
    const Treeline treeline(p_, grid, context.seed);
    const std::vector<float> land_share =
        counts_exposure() ? land_of(fields.elevation) : std::vector<float>{};
    const DisplacedSampler land(grid, land_share);
#pragma omp parallel for schedule(dynamic, 8)
    for (int j = 0; j < grid.ny(); ++j) {
      for (int i = 0; i < grid.nx(); ++i) {
        const Index c = grid.cell(i, j);
        if (!grow(i, j, c, treeline, fields)) continue;
        fields.settlement[c] =
            static_cast<float>(std::clamp(suitability(grid, i, j, c, land, fields), 0.0, 1.0));
      }
    }
    context.advance(0.7);
    const auto line_rivers = [&] {
      if (fields.river.empty()) return;
      line_rivers_with_trees(grid, fields.river, fields.temperature, fields.biome);
    };
    if (p_.smooth_corridors) line_rivers();
    std::vector<std::int8_t> scratch(fields.biome.size());
    smooth_biomes(grid, p_.smoothing_km * 1000, fields.biome, scratch);
    context.advance(0.9);
    if (!p_.smooth_corridors) line_rivers();
    context.advance(1.0);
  }

 private:
  [[nodiscard]] bool counts_exposure() const {
    return p_.coast == "exposure" && p_.coast_weight > 0;
  }

  /// What grows in a cell; returns whether people may live there: not on water.
  bool grow(int i, int j, Index c, const Treeline& treeline, const LifeFields& f) const {
    const std::int8_t from_months = f.koppen[c];
    f.biome[c] = f.koppen[c] = 0;
    f.productivity[c] = f.settlement[c] = 0;
    if (f.elevation[c] < 0) return false;
    const KoppenIndices harmonics =
        harmonic_indices(f.temperature[c], f.range[c], f.rain[c], f.seasonality[c]);
    f.koppen[c] = from_months > 0 ? from_months : koppen_class(harmonics);
    const Climate climate{f.temperature[c], f.rain[c], seasons_of(f.koppen[c], harmonics)};
    f.biome[c] = id(treeline.biome(i, j, f.elevation[c], f.range[c], climate));
    if (!f.lake.empty() && f.lake[c] > 0) return false;
    f.productivity[c] = static_cast<float>(miami_productivity(f.temperature[c], f.rain[c]));
    return true;
  }
  /// Suitability for settlement, rivers and shores included.
  [[nodiscard]] double suitability(const Grid& grid, int i, int j, Index c,
                                   const DisplacedSampler& land, const LifeFields& f) const {
    double suitability =
        p_.settlement == "limits"
            ? limited(grid, f.elevation, i, j,
                      settlement_limits(harmonic_months(f.temperature[c], f.range[c], f.rain[c],
                                                        f.seasonality[c])),
                      f.river.empty() ? 0.0F : f.river[c])
            : miami_productivity(f.temperature[c], f.rain[c]) / kFullYield *
                  altitude_factor(f.elevation[c]);
    if (!f.river.empty()) suitability += p_.river_weight * f.river[c];
    if (p_.coast_weight > 0 && (!f.coast.empty() || counts_exposure())) {
      const double near = counts_exposure() ? sea_exposure(land, i, j, p_.coast_reach_km * 1000)
                                            : 1 - f.coast[c] / (p_.coast_reach_km * 1000);
      suitability += p_.coast_weight * std::max(near, 0.0);
    }
    return suitability;
  }
  /// Suitability where climate, slope and soil set limits. A river waters the fields along it.
  [[nodiscard]] double limited(const Grid& grid, std::span<const float> elevation, int i, int j,
                               SettlementLimits limits, double river) const {
    limits.water = std::max(limits.water, smooth_step(0.0, p_.riparian_threshold, river));
    double lowest_m = elevation[grid.cell(i, j)], highest_m = lowest_m;
    for (int k = 0; k < kDirections; ++k) {
      const Index n = grid.neighbour(i, j, k);
      if (n == kNoCell) continue;
      const double z = std::max(0.0F, elevation[n]);  // the sea's level, not its bed
      lowest_m = std::min(lowest_m, z);
      highest_m = std::max(highest_m, z);
    }
    const double across_m = 2.0 * std::sqrt(grid.area_m2(j));
    return limits.product() * slope_limit(field_slope(highest_m - lowest_m, across_m));
  }
  static std::vector<float> land_of(std::span<const float> elevation) {
    std::vector<float> land(elevation.size());
    std::transform(elevation.begin(), elevation.end(), land.begin(),
                   [](float z) { return z >= 0 ? 1.0F : 0.0F; });
    return land;
  }
  // After the smoothing unless asked otherwise: corridors are narrow by nature.
  void line_rivers_with_trees(const Grid& grid, std::span<const float> river,
                              std::span<const float> temperature,
                              std::span<std::int8_t> biome) const {
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
        if (river[c] > p_.riparian_threshold) biome[c] = riparian(biome[c], temperature[c]);
      }
    }
  }

  BiomesParameters p_;
  StageInfo info_{"biomes",
                  "biomes, Köppen-Geiger classes, net primary productivity and settlement",
                  {&field::elevation, &field::temperature, &field::temperature_range,
                   &field::precipitation, &field::precipitation_seasonality},
                  {&field::river_intensity, &field::lake_depth, &field::distance_to_coast,
                   &field::koppen_class},
                  {&field::biome, &field::koppen_class, &field::net_primary_productivity,
                   &field::settlement_suitability}};
};

}  // namespace

std::vector<Parameter> BiomesParameters::declarations() {
  return {
      flag("biomes.seasons", seasons,
           "only biomes whose seasons the climate has: tropical ones where no month is below 18 "
           "degC, rainforest wherever the dry season is short, boreal forest where at most three "
           "months reach 10 degC, Mediterranean scrub where summers are dry",
           "kottek2006"),
      choice("biomes.treeline", treeline, {"thermal", "fixed"},
             "where trees end: where the growing season is too cold or short, or at a fixed height",
             "paulsen2014"),
      real("biomes.treeline_m", treeline_m, "m", 0.0, 1e5, "height of the fixed treeline",
           "tectonica2026"),
      real("biomes.treeline_onset_m", treeline_onset_m, "m", 0.0, 1e5,
           "height from which forest thins out below the fixed treeline", "tectonica2026"),
      real("biomes.treeline_noise_m", treeline_noise_m, "m", 0.0, 2000.0,
           "amplitude by which treelines vary in height", "tectonica2026"),
      real("biomes.treeline_noise_km", treeline_noise_km, "km", 0.1, 1e4,
           "wavelength of that variation", "design"),
      real("biomes.lapse_rate_k_km", lapse_rate_k_km, "K km-1", 0.0, 20.0,
           "cooling with height, which tells alpine land from polar tundra", "holton2013"),
      real("biomes.mountain_m", mountain_m, "m", 0.0, 1e5,
           "height from which treeless land can be alpine; lower, it is tundra", "kapos2000"),
      real("biomes.riparian_threshold", riparian_threshold, "1", 0.0, 1.0,
           "river intensity above which trees line the river in dry land", "tectonica2026"),
      real("biomes.smoothing_km", smoothing_km, "km", 0.0, 1000.0,
           "patches of biome smaller than this merge into their surroundings", "tectonica2026"),
      flag("biomes.smooth_corridors", smooth_corridors,
           "whether that smoothing comes after the trees along rivers, as in the blueprint's 7.5, "
           "and takes those away that stand alone",
           "tectonica2026"),
      choice("biomes.settlement", settlement, {"limits", "productivity"},
             "what settlement follows: how far warmth, water, heat, slope and soil let people farm "
             "and work, or productivity alone, as in the blueprint's 8.5",
             "ramankutty2002"),
      real("biomes.river_weight", river_weight, "1", 0.0, 1.0,
           "what a navigable river adds to the suitability for settlement", "diamond1997"),
      real("biomes.coast_weight", coast_weight, "1", 0.0, 1.0,
           "what the sea shore adds to the suitability for settlement", "diamond1997"),
      choice(
          "biomes.coast", coast, {"distance", "exposure"},
          "what the shore's advantage follows: the distance to it, or the share of sea around, as "
          "in the blueprint's 8.5",
          "tectonica2026"),
      real(
          "biomes.coast_reach_km", coast_reach_km, "km", 0.01, 1000.0,
          "distance inland at which the shore's advantage ends, radius within which the sea counts",
          "design"),
  };
}

std::unique_ptr<Stage> make_biomes_stage(BiomesParameters parameters) {
  return std::make_unique<BiomesStage>(std::move(parameters));
}

}  // namespace geo
