// An island's rivers and lakes against those of the planet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>
#include <span>

#include "geo/core/projection.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "stages/island/island_of_planet.hpp"

namespace geo {
namespace {

TEST(Island, LandDrainsToTheSeaOffTheEdgeOrIntoALake) { expect_drained(example().island); }

TEST(Island, RiversThatEnterAreThereAndNoWaterIsLost) {
  const auto& [island, budget] = example();
  const auto inflow = island.read(field::inflow_discharge);
  const auto inflow_area = island.read(field::inflow_area);
  const auto discharge = island.read(field::discharge);
  const auto area = island.read(field::drainage_area);
  const auto lake = island.read(field::lake_id);
  double entering = 0.0;
  for (Index c = 0; c < island.grid().size(); ++c) {
    entering += inflow[c];
    if (inflow[c] == 0.0F) continue;
    EXPECT_TRUE(on_edge(island.grid(), c));
    EXPECT_GE(area[c], inflow_area[c]);
    if (lake[c] == 0) {
      EXPECT_GE(discharge[c], inflow[c] * (1.0F - 1e-5F));
    }
  }
  EXPECT_GT(entering, 100.0);
  EXPECT_NEAR(budget.at("river_inflow_m3_s"), entering, 1e-4 * entering);
  EXPECT_LT(std::abs(budget.at("water_closing_error")), 1e-6);
}

/// A planet's river, and an island around a cell that it passes through.
struct IslandOnRiver {
  const State& whole;
  Index river;
  const State& island;
  std::span<const Index> cell_of;  ///< of the planet, for each of the island's
};

/// Calls with islands on the four greatest rivers of planets of some seeds.
template <class Action>
void on_great_rivers(std::initializer_list<std::uint64_t> seeds, Action&& action) {
  for (const std::uint64_t seed : seeds) {
    const State whole = make_planet(seed);
    for (const Index river : great_rivers(4, whole)) {
      const Centre place = place_of(river, whole.grid());
      SCOPED_TRACE("seed " + std::to_string(seed) + ", river at " + text(place));
      const State island = make(around(place), whole, seed).island;
      const PlanetCells cells(whole.grid(), island.grid());
      action(IslandOnRiver{whole, river, island, cells.cell_of()});
    }
  }
}

/// What the planet's lakes about an island lose to the air beyond what land in their place would,
/// m3/s: where the island's own are smaller, its rivers carry that on.
double lost_in_lakes_m3_s(const IslandOnRiver& at) {
  const auto lake = at.whole.read(field::lake_id);
  const auto receiver = at.whole.read(field::flow_receiver);
  const auto discharge = at.whole.read(field::discharge);
  const auto rain_mm_yr = at.whole.read(field::precipitation);
  const auto potential_mm_yr = at.whole.read(field::potential_evapotranspiration);
  const Grid& grid = at.whole.grid();
  constexpr double kMillimetresAYear = 1e-3 / (365.25 * 86400.0);  // m s-1
  std::set<std::int32_t> lakes;
  for (const Index cell : at.cell_of) {
    if (lake[cell] > 0) lakes.insert(lake[cell]);
  }
  double lost = 0.0;
  for (const std::int32_t one : lakes) {
    double in = 0.0, out = 0.0;
    std::set<Index> sills;  // what comes in there counts as the lake's outflow, too
    for (Index c = 0; c < at.whole.grid().size(); ++c) {
      if (lake[c] != one) continue;
      out = discharge[c];
      in += kMillimetresAYear * grid.area_m2(grid.row(c)) *
            (rain_mm_yr[c] - land_evaporation(rain_mm_yr[c], potential_mm_yr[c]));
      if (lake[receiver[c]] != one) sills.insert(receiver[c]);
    }
    for (Index c = 0; c < at.whole.grid().size(); ++c) {
      if (lake[c] == one || receiver[c] == c) continue;
      if (lake[receiver[c]] == one || sills.contains(receiver[c])) in += discharge[c];
    }
    lost += std::max(0.0, in - out);
  }
  return lost;
}

/// What leaves beside the river of a planet's cell, through the next cell at the edge: of a river
/// the planet knows the cell alone, and two that leave side by side may meet before they do.
double leaves_beside_m3_s(const IslandOnRiver& at, Index cell) {
  const auto receiver = at.whole.read(field::flow_receiver);
  const auto discharge = at.whole.read(field::discharge);
  const std::set<Index> inside(at.cell_of.begin(), at.cell_of.end());
  while (receiver[cell] != cell && inside.contains(receiver[cell])) cell = receiver[cell];
  double beside = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const Index next = at.whole.grid().neighbour(cell, k);
    if (next == kNoCell || !inside.contains(next) || inside.contains(receiver[next])) continue;
    beside = std::max<double>(beside, discharge[next]);
  }
  return beside;
}

// Interpolation dams a valley that is one cell wide: rivers must not leave by the edge that they
// came in over.
TEST(Island, RiversCarryWhatTheyCarryOnThePlanet) {
  double carried = 0.0;
  int rivers = 0, poor = 0;
  on_great_rivers({1, 2, 3, 4, 5, 6, 7, 8}, [&](const IslandOnRiver& at) {
    const auto receiver = at.whole.read(field::flow_receiver);
    const auto planets = at.whole.read(field::discharge);
    const auto discharge = at.island.read(field::discharge);
    const Index c = at.river;
    const auto carried_in = [&](Index cell) {
      float most = 0.0F;
      for (Index k = 0; k < at.island.grid().size(); ++k) {
        if (at.cell_of[k] == cell) most = std::max(most, discharge[k]);
      }
      return most;
    };
    const float most = carried_in(c);
    // Where rivers meet may move by a cell or two, and a brook may join the river beside: of many
    // rivers one may lose a branch, which meets it in the next cell then.
    EXPECT_TRUE(most > 0.8 * planets[c] || carried_in(receiver[c]) > 0.95 * planets[receiver[c]])
        << most << " of " << planets[c];
    poor += most < 0.9 * planets[c] ? 1 : 0;
    EXPECT_LT(most, 1.1 * planets[receiver[receiver[c]]] + lost_in_lakes_m3_s(at) +
                        leaves_beside_m3_s(at, c));
    carried += std::min(1.0, static_cast<double>(most) / planets[c]);
    ++rivers;
  });
  EXPECT_GT(carried, 0.97 * rivers);
  EXPECT_LE(poor, rivers / 16);
}

/// Whether a planet's cell has a river of its own, whose centre is well inside an island.
bool has_river(const State& whole, const Grid& fine, Index cell) {
  const Grid& grid = whole.grid();
  const auto [x, y] =
      EqualAreaProjection(*fine.centre(), fine.figure()).project(place_of(cell, grid));
  const bool inside = std::abs(x) < 0.5 * fine.nx() * fine.spacing_east_m(0) &&
                      std::abs(y) < 0.5 * fine.ny() * fine.step_north_m();
  return inside && whole.read(field::elevation)[cell] >= 0.0F &&
         whole.read(field::lake_id)[cell] == 0 &&
         whole.read(field::drainage_area)[cell] > 10.0 * grid.area_m2(grid.row(cell));
}

// They must not meet beyond the edge, leave over a lower place, or end in lakes of the detail.
TEST(Island, RiversKeepTheirWaterAllTheWay) {
  double all_there = 0.0, all_kept = 0.0;
  int rivers = 0, poor = 0;
  on_great_rivers({1, 2, 3, 4, 5, 6}, [&](const IslandOnRiver& at) {
    const Grid& fine = at.island.grid();
    const auto planets = at.whole.read(field::discharge);
    const auto receiver = at.whole.read(field::flow_receiver);
    const auto discharge = at.island.read(field::discharge);
    const auto z = at.island.read(field::elevation);
    const auto lake = at.island.read(field::lake_id);
    std::map<Index, double> most, in_rivers;  // a lake shows its outflow everywhere
    std::set<Index> shore;
    for (Index k = 0; k < fine.size(); ++k) {
      const Index cell = at.cell_of[k];
      if (z[k] < 0.0F) shore.insert(cell);
      const double here = discharge[k];
      most[cell] = std::max(most[cell], here);
      if (lake[k] == 0) in_rivers[cell] = std::max(in_rivers[cell], here);
    }
    const double lost_m3_s = lost_in_lakes_m3_s(at);
    double there = 0.0, kept = 0.0, too_much = 0.0;
    for (const auto& [cell, here] : most) {
      if (!has_river(at.whole, fine, cell) || shore.contains(cell)) continue;
      // A river may cross a corner of the next cell.
      double beside = planets[receiver[receiver[cell]]];
      for (int k = 0; k < kDirections; ++k) {
        const Index next = at.whole.grid().neighbour(cell, k);
        if (next != kNoCell) beside = std::max<double>(beside, planets[next]);
      }
      const double below = std::max<double>(beside, planets[cell]);
      there += planets[cell];
      kept += std::min<double>(here, planets[cell]);
      too_much +=
          std::max(0.0, in_rivers[cell] - 1.1 * below - lost_m3_s - leaves_beside_m3_s(at, cell));
    }
    EXPECT_GT(kept, 0.8 * there);
    ++rivers;
    poor += kept < 0.9 * there ? 1 : 0;
    EXPECT_LT(too_much, 0.05 * there);
    all_there += there;
    all_kept += kept;
  });
  EXPECT_GT(all_kept, 0.95 * all_there);
  EXPECT_LE(poor, rivers / 8);
}

// Detail must not dip plains to the level of the sea, nor let rivers leave flats over its edge.
TEST(Island, PlainsHaveNoLakesThatThePlanetLacks) {
  double land = 0.0, lakes = 0.0;
  on_great_rivers({3, 6}, [&](const IslandOnRiver& at) {
    const auto planets_m = at.whole.read(field::elevation);
    const auto planets_lake = at.whole.read(field::lake_id);
    const auto lake = at.island.read(field::lake_id);
    for (Index k = 0; k < at.island.grid().size(); ++k) {
      const Index cell = at.cell_of[k];
      if (planets_m[cell] < 20.0F || planets_m[cell] > 200.0F || planets_lake[cell] > 0) continue;
      land += 1.0;
      lakes += lake[k] > 0 ? 1.0 : 0.0;
    }
  });
  EXPECT_LT(lakes, 0.01 * land);
}

// Without what they lay down, rivers would cut to the level of the sea far inland, below the
// planet's.
TEST(Island, RiversOfLowlandsStayAboveTheLevelOfTheSea) {
  constexpr double kRiver_m2 = 1e9;
  double rivers = 0.0, at_sea_level = 0.0;
  const auto sixteen = {1UL, 2UL,  3UL,  4UL,  5UL,  6UL,  7UL,  8UL,
                        9UL, 10UL, 11UL, 12UL, 13UL, 14UL, 15UL, 16UL};
  on_great_rivers(sixteen, [&](const IslandOnRiver& at) {
    const auto planets_m = at.whole.read(field::elevation);
    const auto receiver = at.whole.read(field::flow_receiver);
    const auto z = at.island.read(field::elevation);
    const auto lake = at.island.read(field::lake_id);
    const auto area_m2 = at.island.read(field::drainage_area);
    for (Index k = 0; k < at.island.grid().size(); ++k) {
      const Index cell = at.cell_of[k];
      if (planets_m[cell] < 20.0F || planets_m[cell] > 100.0F || planets_m[receiver[cell]] < 20.0F)
        continue;
      if (area_m2[k] < kRiver_m2 || lake[k] > 0) continue;
      rivers += 1.0;
      at_sea_level += z[k] < 2.0F ? 1.0 : 0.0;
    }
  });
  EXPECT_GT(rivers, 1000.0);
  EXPECT_LT(at_sea_level, 0.05 * rivers) << "of " << rivers;
}

/// Of the river cells near the edge of a plane and of those farther in, which share lies in
/// straight runs of eight steps or more.
struct Straight {
  double near_edge = 0.0, inside = 0.0;
  int longest = 0;  ///< steps
};
Straight straight_rivers(const std::vector<State>& islands) {
  constexpr int kLong = 8, kEdge_cells = 25;
  constexpr double kRiver_m2 = 20e6;
  Straight found;
  double straight[2] = {}, all[2] = {};
  for (const State& island : islands) {
    const Grid& fine = island.grid();
    const auto z = island.read(field::elevation);
    const auto lake = island.read(field::lake_id);
    const auto area = island.read(field::drainage_area);
    const auto receiver = island.read(field::flow_receiver);
    const auto direction = island.read(field::flow_direction);
    const auto is_river = [&](Index c) {
      return z[c] >= 0.0F && lake[c] == 0 && area[c] > kRiver_m2;
    };
    const auto goes_on = [&](Index c) {
      return receiver[c] != c && is_river(receiver[c]) && direction[receiver[c]] == direction[c];
    };
    std::vector<std::uint8_t> begins(fine.size(), 1);
    for (Index c = 0; c < fine.size(); ++c) {
      if (is_river(c) && goes_on(c)) begins[receiver[c]] = 0;
    }
    std::vector<Index> run;
    for (Index c = 0; c < fine.size(); ++c) {
      if (!is_river(c) || begins[c] == 0) continue;
      run.assign(1, c);
      while (goes_on(run.back())) run.push_back(receiver[run.back()]);
      const bool is_long = std::ssize(run) >= kLong;
      found.longest = std::max(found.longest, static_cast<int>(run.size()));
      for (const Index at : run) {
        const int i = fine.column(at), j = fine.row(at);
        const bool inside = std::min({i, fine.nx() - 1 - i, j, fine.ny() - 1 - j}) >= kEdge_cells;
        all[inside] += 1.0;
        straight[inside] += is_long ? 1.0 : 0.0;
      }
    }
  }
  found.near_edge = straight[0] / std::max(1.0, all[0]);
  found.inside = straight[1] / std::max(1.0, all[1]);
  return found;
}

/// Islands on the great rivers of some planets and on their mouths.
std::vector<State> islands_in_one_cell(std::initializer_list<std::uint64_t> seeds) {
  std::vector<State> islands;
  for (const std::uint64_t seed : seeds) {
    const State whole = make_planet(seed);
    for (const Index river : great_rivers(3, whole)) {
      for (const Index cell : {river, mouth_of(river, whole)}) {
        IslandParameters p;
        p.nx = 512;
        p.ny = 256;
        p.center = text(place_of(cell, whole.grid()));
        islands.push_back(make(p, whole).island);
      }
    }
  }
  return islands;
}

// A planet's cells are as large as these windows: what lies between them is the island's own. Among
// the mouths are plains that are all but even.
TEST(Island, RiversBetweenThePlanetsCellsDoNotFollowTheGrid) {
  for (const std::uint64_t seed : {1U, 3U, 5U, 7U, 9U}) {
    SCOPED_TRACE("planets " + std::to_string(seed) + " and " + std::to_string(seed + 1));
    const Straight found = straight_rivers(islands_in_one_cell({seed, seed + 1}));
    // Valleys of mountains run straight for three kilometres now and then: 0.03 of their length.
    EXPECT_LT(found.inside, 0.045);
    EXPECT_LT(found.near_edge, 0.045);
    EXPECT_LT(found.longest, 28);
  }
}

}  // namespace
}  // namespace geo
