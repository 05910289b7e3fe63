// An island against the planet that it is a part of: its surface and its edge.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "stages/island/island_of_planet.hpp"

namespace geo {
namespace {

TEST(Island, MeansOverThePlanetsCellsAreThePlanetsWithinTheDetail) {
  const State& island = example().island;
  const Grid& fine = island.grid();
  const Grid& coarse = planet().grid();
  const PlanetCells cells(coarse, fine);
  std::vector<std::uint8_t> there(coarse.size()), cut(coarse.size());
  for (Index c = 0; c < fine.size(); ++c) {
    there[cells.cell_of()[c]] = 1;
    if (on_edge(fine, c)) cut[cells.cell_of()[c]] = 1;
  }
  const auto planets_m = planet().read(field::elevation);
  std::vector<float> roughness_m(cells.size());  // the standard deviation of detail
  local_roughness(cells, planets_m, roughness_m);
  const auto mean_m = cells.means(island.read(field::elevation), {}, 0.0F);
  IslandParameters even = around(place_of(great_rivers(1).front()));
  even.detail_amplitude = even.least_roughness_m = 0.0;
  const State ground = make(even).island;
  const auto ground_m = cells.means(ground.read(field::elevation), {}, 0.0F);
  int whole = 0;
  double bias_m = 0.0, detail_m = 0.0;
  for (Index c = 0; c < coarse.size(); ++c) {
    if (there[c] == 0 || cut[c] != 0) continue;
    const auto k = cells.at(coarse.column(c), coarse.row(c));
    // A spit between deep water is lower than its cell: the surface is smooth.
    EXPECT_NEAR(ground_m[k], planets_m[c], roughness_m[k]) << "planet cell " << c;
    EXPECT_NEAR(mean_m[k], ground_m[k], roughness_m[k]) << "planet cell " << c;
    bias_m += mean_m[k] - planets_m[c];
    detail_m += roughness_m[k];
    ++whole;
  }
  ASSERT_GT(whole, 20);
  EXPECT_LT(std::abs(bias_m), 0.15 * detail_m);
}

TEST(Island, CoastsWindAboutThePlanetsAndTakeAsMuchAsTheyGive) {
  double shore_m = 0.0, gained_m2 = 0.0, lost_m2 = 0.0, fray = 0.0;
  for (const Index river : great_rivers(4)) {
    IslandParameters p = around(place_of(mouth_of(river)));
    p.detail_amplitude = p.least_roughness_m = 0.0;
    p.erosion_steps = 0;
    fray = p.coast_fray;
    const State wound = make(p).island;
    p.coast_fray = 0.0;
    const State smooth = make(p).island;
    const Grid& grid = smooth.grid();
    const auto z = smooth.read(field::elevation), wound_z = wound.read(field::elevation);
    for (Index c = 0; c < grid.size(); ++c) {
      for (const int k : {0, 2}) {  // a shore of any direction has 4 / pi times its length in faces
        const Index next = grid.neighbour(c, k);
        const bool on_shore = next != kNoCell && (z[c] >= 0.0F) != (z[next] >= 0.0F);
        if (on_shore) shore_m += 0.25 * std::numbers::pi * p.cell_m;
      }
      if (z[c] < 0.0F && wound_z[c] >= 0.0F) gained_m2 += grid.area_m2(0);
      if (z[c] >= 0.0F && wound_z[c] < 0.0F) lost_m2 += grid.area_m2(0);
    }
  }
  ASSERT_GT(shore_m, 2000e3);
  // Of a normal displacement the mean is 0.8 deviations; some of it is taken out with the mean over
  // each planet cell.
  const double displaced_m = (gained_m2 + lost_m2) / shore_m;
  const double spacing_m = planet().grid().face_east_m(planet().grid().ny() / 2);
  EXPECT_GT(displaced_m, 0.2 * fray * spacing_m);
  EXPECT_LT(displaced_m, 1.5 * fray * spacing_m);
  EXPECT_LT(std::abs(gained_m2 - lost_m2), 0.3 * (gained_m2 + lost_m2));
}

/// Corners of the planet's cells where the cubic swings furthest above four cells of sea, and
/// furthest below four of land.
std::array<Centre, 2> greatest_swings() {
  const Grid& grid = planet().grid();
  const auto z = planet().read(field::elevation);
  std::array<Centre, 2> places{};
  double highest_m = 0.0, lowest_m = 0.0;
  for (int j = grid.ny() / 6; j < grid.ny() * 5 / 6; ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Centre corner{0.5 * (grid.latitude_deg(j) + grid.latitude_deg(j + 1)),
                          grid.longitude_deg(i) + 180.0 / grid.nx()};
      const CatmullRom cubic(grid, corner);
      const auto [least_m, most_m] = cubic.range(z);
      const double height_m = cubic.of(z);
      if (most_m < 0.0F && height_m > highest_m) {
        highest_m = height_m;
        places[0] = corner;
      }
      if (least_m > 0.0F && height_m < lowest_m) {
        lowest_m = height_m;
        places[1] = corner;
      }
    }
  }
  EXPECT_GT(highest_m, 0.0);
  EXPECT_LT(lowest_m, 0.0);
  return places;
}

// Cubics swing beyond what they pass through: that would make ponds behind the shore of a basin,
// and a row of islets before mountains at a coast.
TEST(Island, HasNoLandBetweenThePlanetsCellsOfSeaAndNoSeaBetweenThoseOfLand) {
  const auto planets_m = planet().read(field::elevation);
  for (const Centre& place : greatest_swings()) {
    SCOPED_TRACE(text(place));
    IslandParameters p = around(place);
    p.detail = "height";
    p.height_amplitude = 0.0;
    p.erosion_steps = 0;
    const State island = make(p).island;
    const Grid& fine = island.grid();
    const auto z = island.read(field::elevation);
    int sea = 0, land = 0, swings = 0;
    for (Index c = 0; c < fine.size(); ++c) {
      const CatmullRom cubic(planet().grid(), fine.position(fine.column(c), fine.row(c)));
      const auto [least_m, most_m] = cubic.range(planets_m);
      const double swung_m = cubic.of(planets_m);
      if (most_m < 0.0F) {
        ASSERT_LT(z[c], 0.0F) << "cell " << c;
        ++sea;
        if (swung_m >= 0.0) ++swings;
      } else if (least_m > 0.0F) {
        ASSERT_GE(z[c], 0.0F) << "cell " << c;
        ++land;
        if (swung_m < 0.0) ++swings;
      }
    }
    EXPECT_GT(sea + land, 100);
    EXPECT_GT(swings, 10) << "the cubic by itself had held";
  }
}

TEST(Island, EdgeKeepsThePlanetsHeightsExceptInRiverGaps) {
  const State island = make_smooth(around(place_of(great_rivers(1).front()))).island;
  const Grid& fine = island.grid();
  const auto planets_m = planet().read(field::elevation);
  const auto z = island.read(field::elevation);
  int edge = 0, same = 0;
  for (Index c = 0; c < fine.size(); ++c) {
    if (!on_edge(fine, c)) continue;
    const CatmullRom stencil(planet().grid(), fine.position(fine.column(c), fine.row(c)));
    const double there_m = stencil.of(planets_m);
    // Where the interpolation dips below the sea inland, a plain fills the dip.
    EXPECT_LT(z[c], std::max(there_m, 0.0) + 1.0);
    ++edge;
    if (z[c] > there_m - 1.0) ++same;
  }
  EXPECT_GT(same, 0.8 * edge);
}

/// Root mean square and mean of the height of an island's land above the planet's surface, at the
/// edge and well inside.
struct OnThePlanet {
  double rms_m[2] = {}, mean_m[2] = {};
};
OnThePlanet detail_of(const std::vector<State>& islands) {
  constexpr int kInside_cells = 25;
  OnThePlanet found;
  double count[2] = {};
  const auto planets_m = planet().read(field::elevation);
  for (const State& island : islands) {
    const Grid& fine = island.grid();
    const auto z = island.read(field::elevation);
    for (Index c = 0; c < fine.size(); ++c) {
      const int i = fine.column(c), j = fine.row(c);
      const int from_edge = std::min({i, fine.nx() - 1 - i, j, fine.ny() - 1 - j});
      if (z[c] < 0.0F || (from_edge > 0 && from_edge < kInside_cells)) continue;
      const double above_m = z[c] - CatmullRom(planet().grid(), fine.position(i, j)).of(planets_m);
      const int inside = from_edge > 0 ? 1 : 0;
      found.rms_m[inside] += above_m * above_m;
      found.mean_m[inside] += above_m;
      count[inside] += 1.0;
    }
  }
  for (const int k : {0, 1}) {
    found.rms_m[k] = std::sqrt(found.rms_m[k] / count[k]);
    found.mean_m[k] /= count[k];
  }
  return found;
}

// An even rim would be a frame round the map, and rivers would run along it.
TEST(Island, EdgeIsAsRoughAsTheInside) {
  std::vector<State> islands;
  for (const Index river : great_rivers(16)) {
    islands.push_back(make(around(place_of(river))).island);
  }
  const OnThePlanet found = detail_of(islands);
  const auto& [edge_m, inside_m] = found.rms_m;
  EXPECT_GT(edge_m, 0.75 * inside_m);
  EXPECT_LT(edge_m, 1.33 * inside_m);
  EXPECT_LT(std::abs(found.mean_m[0]), 0.25 * inside_m);
}

TEST(Island, FadingEdgeSinksBelowTheSea) {
  IslandParameters p = coarse_look();
  p.edge_fade = true;
  const State island = make(p).island;
  const Grid& fine = island.grid();
  const auto z = island.read(field::elevation);
  const auto inflow = island.read(field::inflow_discharge);
  float highest = -1e9F;
  for (Index c = 0; c < fine.size(); ++c) {
    highest = std::max(highest, z[c]);
    if (!on_edge(fine, c)) continue;
    EXPECT_LT(z[c], -400.0F);
    EXPECT_EQ(inflow[c], 0.0F);
  }
  EXPECT_GT(highest, 0.0F);
}

/// Rivers end at the level of the sea, however deep it is beside the coast: land that were cut
/// towards its floor would be a plain at sea level. What the planet has as lowland may be one.
TEST(Island, CoastsBesideDeepWaterAreNoPlainAtSeaLevel) {
  constexpr double kLowland_m = 30.0;
  IslandParameters p = coarse_look();
  p.edge_fade = true;
  p.keep_means = false;
  const State island = make(p).island;
  const Grid& fine = island.grid();
  const auto z = island.read(field::elevation), planets_m = planet().read(field::elevation);
  const auto area_m2 = island.read(field::drainage_area);
  const double river_m2 = 100.0 * fine.area_m2(0);  // whose bed is at sea level at its mouth
  int land = 0, planed = 0;
  for (Index c = 0; c < fine.size(); ++c) {
    if (z[c] < 0.0F) continue;
    const CatmullRom stencil(planet().grid(), fine.position(fine.column(c), fine.row(c)));
    if (stencil.of(planets_m) < kLowland_m) continue;
    ++land;
    if (z[c] < 0.01F && area_m2[c] < river_m2) ++planed;
  }
  ASSERT_GT(land, 1000);
  EXPECT_LT(planed, land / 500);
}

TEST(Island, IsTheSameOnAnyNumberOfThreads) {
  const int usual = omp_get_max_threads();
  omp_set_num_threads(1);
  const State one = make(coarse_look()).island;
  for (const int threads : {2, 4}) {
    omp_set_num_threads(threads);
    const State more = make(coarse_look()).island;
    for (const FieldSpec* spec : one.present()) {
      EXPECT_TRUE(*one.values(*spec) == *more.values(*spec)) << spec->name << " " << threads;
    }
  }
  omp_set_num_threads(usual);
}

TEST(Island, BadCentresAreRefused) {
  for (const char* centre : {"91,0", "0,361", "north", "10", "10,20,30", "nan,0", ""}) {
    IslandParameters p = coarse_look();
    p.center = centre;
    EXPECT_THROW(make(p), ConfigurationError) << centre;
  }
}

}  // namespace
}  // namespace geo
