#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// A volcano as a Gaussian cone: h exp(-r^2 / 2 s^2).
struct Volcano {
  std::array<double, 3> place;  ///< unit vector in the frame of the grid's axis
  double height_m, radius_km;   ///< h, s
};

/// Adds the mean height of volcanoes over each cell of a whole sphere, exact for cells that are
/// flat rectangles: the volume is the same on every grid. `height_m` has one value per cell (Bug
/// otherwise). The same bits for any number of threads. Cost: cells within four radii of a volcano.
void pile_volcanoes(const Grid& grid, std::span<const Volcano> volcanoes,
                    std::span<float> height_m);

/// Sizes of volcanoes: heights log-normal about a median, flanks as steep for all.
struct VolcanoSizes {
  double median_m, spread;  ///< deviation of the logarithm
  double most_m;            ///< none is higher
  double radius_km_per_km;  ///< s over h
};

/// Volcanoes about the points of a jittered Fibonacci lattice, one per `spacing_km` squared, where
/// `grows`, asked for the cell of `grid` that a point lies in, says so.
std::vector<Volcano> scatter_volcanoes(const Grid& grid, double spacing_km,
                                       const VolcanoSizes& sizes, std::uint64_t seed,
                                       std::string_view stream,
                                       const std::function<bool(Index)>& grows);

/// What trails of plumes follow, one value per cell of a whole sphere.
struct MovingPlates {
  std::span<const std::int16_t> plate;
  std::span<const float> east_mm_yr, north_mm_yr;
  std::span<const float> age_myr, continental_fraction, heat;
};

/// Chains of volcanoes that plates have carried away from plumes (Wilson 1963): beginning above
/// each place where `heat` stands out of its surroundings, and above 38 smaller hot spots, one
/// every 50 to 130 km of the way that the plate has gone, as far back as 80 Myr, to the edge of the
/// plate, to a continent, or to floor that was not there yet. Sizes vary from plume to plume and
/// along a trail; old ones have sunk and lost their tops, by exp(-t / 150 Myr). Cost: linear in
/// cells, and the steps of each trail.
std::vector<Volcano> plume_trails(const Grid& grid, const MovingPlates& plates,
                                  const VolcanoSizes& sizes, std::uint64_t seed);

}  // namespace geo
