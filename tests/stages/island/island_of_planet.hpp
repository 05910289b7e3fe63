#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geo/stages/island/island.hpp"
#include "geo/stages/stages.hpp"

namespace geo {

/// A small planet with everything that an island reads.
State make_planet(std::uint64_t seed);
/// One of them; made once.
const State& planet();

struct Made {
  State island;
  Budget budget;
};
Made make(IslandParameters p, State state = planet(), std::uint64_t seed = 3);

std::string text(Centre place);
/// Ten planet cells wide at the equator, six high.
IslandParameters around(Centre place);
/// The planet's surface alone, but for the ways of its rivers: no detail, bays, erosion or valleys.
Made make_smooth(IslandParameters p);
Centre place_of(Index planet_cell, const Grid& grid = planet().grid());

/// Cells that the largest rivers of different basins pass through half-way, away from the poles and
/// from lakes: rivers of the fine surface may cut through a sill, and then what its lake evaporated
/// flows on.
std::vector<Index> great_rivers(std::size_t count, const State& whole = planet());
/// Where a river reaches the sea: there is land and sea around.
Index mouth_of(Index river, const State& whole = planet());

bool on_edge(const Grid& grid, Index c);
/// All land drains to the sea, off the edge or into a lake.
void expect_drained(const State& island);

/// Land of which an island has plenty.
const Made& example();
/// The same ground in fewer cells.
IslandParameters coarse_look();

}  // namespace geo
