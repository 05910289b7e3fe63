// Figures of climate classes and biomes.
#include <array>
#include <string_view>
#include <vector>

#include "score_figures.hpp"

namespace geo::io {
namespace {

constexpr int kCategories = 128;

/// Shares of the land (all categories but 0, which is the sea), in per cent.
template <class Counts>
std::array<double, kCategories> land_shares(const Grid& grid, const Counts& category) {
  std::array<double, kCategories> area{};
  std::array<std::int32_t, kCategories> cells{};
  double land_m2 = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    cells.fill(0);
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      const int value = category(c);
      if (value > 0) ++cells[value];
    }
    for (int k = 1; k < kCategories; ++k) {
      area[k] += cells[k] * grid.area_m2(j);
      land_m2 += cells[k] * grid.area_m2(j);
    }
  }
  for (double& share : area) share *= land_m2 > 0.0 ? 100.0 / land_m2 : 0.0;
  return area;
}

int koppen_value(std::string_view name) {
  for (const Flag& flag : field::koppen_class.flags) {
    if (flag.meaning == name) return flag.value;
  }
  return 0;
}

void measure_koppen(const State& state, Figures& figures) {
  const auto classes = state.read(field::koppen_class);
  const auto shares = land_shares(state.grid(), [&](Index c) { return int(classes[c]); });
  constexpr std::array<std::pair<char, const char*>, 5> kLetters{{{'A', "koppen_a"},
                                                                  {'B', "koppen_b"},
                                                                  {'C', "koppen_c"},
                                                                  {'D', "koppen_d"},
                                                                  {'E', "koppen_e"}}};
  for (const auto& [letter, name] : kLetters) {
    double sum = 0.0;
    for (const Flag& flag : field::koppen_class.flags) {
      if (flag.value > 0 && flag.meaning.front() == letter) sum += shares[flag.value];
    }
    figures[name] = sum;
  }
  figures["koppen_bwh"] = shares[koppen_value("BWh")];
  figures["koppen_aw"] = shares[koppen_value("Aw")];
  figures["ice"] = shares[koppen_value("EF")];
}

void measure_biomes(const State& state, Figures& figures) {
  const auto biome = state.read(field::biome);
  const auto shares = land_shares(state.grid(), [&](Index c) { return int(biome[c]); });
  const auto share = [&](Biome b) { return shares[static_cast<int>(b)]; };
  figures["biome_desert"] = share(Biome::hot_desert);
  // Moist forests of the tropics and the subtropics are one biome of Olson's.
  figures["biome_rainforest"] =
      share(Biome::tropical_rainforest) + share(Biome::subtropical_forest);
  figures["biome_savanna"] = share(Biome::tropical_savanna);
  figures["biome_boreal"] = share(Biome::boreal_forest);
  figures["biome_temperate"] = share(Biome::temperate_forest);
  if (!state.has(field::koppen_class)) return;
  // The biomes know no ice: there the cold that has no summer counts as tundra.
  const auto classes = state.read(field::koppen_class);
  const int ice = koppen_value("EF");
  const auto without_ice = land_shares(state.grid(), [&](Index c) {
    return biome[c] == static_cast<int>(Biome::tundra) && classes[c] == ice ? kCategories - 1
                                                                            : int(biome[c]);
  });
  figures["biome_tundra"] = without_ice[static_cast<int>(Biome::tundra)];
}

void measure_glaciers(const State& state, Figures& figures) {
  constexpr float kLeastM = 10.0F;
  const auto elevation = state.read(field::elevation), ice = state.read(field::ice_thickness);
  double land = 0.0, covered = 0.0;
  for (Index c = 0; c < state.grid().size(); ++c) {
    if (elevation[c] < 0.0F) continue;
    const double area = state.grid().area_m2(state.grid().row(c));
    land += area;
    if (ice[c] >= kLeastM) covered += area;
  }
  if (land > 0.0) figures["glaciers"] = 100.0 * covered / land;
}

}  // namespace

void measure_life(const State& state, Figures& figures) {
  if (state.has(field::koppen_class)) measure_koppen(state, figures);
  if (state.has(field::biome)) measure_biomes(state, figures);
  if (state.has(field::ice_thickness) && state.has(field::elevation)) {
    measure_glaciers(state, figures);
  }
}

}  // namespace geo::io
