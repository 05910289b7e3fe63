#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "island_surface.hpp"

namespace geo {

/// Cells next to an edge over which their water leaves are outlets as well: base levels of rivers
/// are then as uneven as the ground. Behind the even slope of the edge alone they would cut a gorge
/// that follows it.
void add_ways_out(const Grid& fine, std::span<const float> z, std::span<std::uint8_t> outlets);

/// Erodibility of each fine cell, or one for all: by boundary as given, else the planet's resolved
/// for the fine cells by the law of its own erosion.
std::vector<float> island_erodibility(const PlanetCells& cells, const PlanetTerrain& planet,
                                      const IslandParameters& p, const ErosionParameters& law);

/// What the fine steps start from and what holds them.
struct IslandGround {
  std::span<const std::uint8_t> outlets;  ///< sea, open edges, bottoms of endorheic basins
  std::span<const std::uint8_t> held;     ///< cells that keep their height: outlets and inflow
  std::span<const double> inflow_area_m2;
  std::span<const float> erodibility;
};

/// What the fine steps did, m over their whole time.
struct IslandErosion {
  std::vector<float> lowered_m, raised_m;
};

/// Some steps of the planet's landscape (wear_down), each with a routing of its own: D8 receivers,
/// drainage area with what enters at the edge, implicit incision, the planet's deposition on land,
/// and creep; then, with `keep_means`, land is raised in proportion to its height so that its mean
/// over every planet cell stays what it was. `planets`: the law of the planet's own erosion.
IslandErosion wear_island(const PlanetCells& cells, const IslandParameters& p,
                          const ErosionParameters& planets, const IslandGround& ground,
                          const std::function<void(double)>& advance, std::span<float> elevation_m);

}  // namespace geo
