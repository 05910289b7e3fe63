#pragma once

#include <span>

#include "geo/kernels/fine_relief.hpp"
#include "geo/kernels/inflow.hpp"

namespace geo {

/// Opens the courses of a planet's rivers in the relief of a part of it.
///
/// A planet's valley is one cell wide and often runs diagonally: interpolation, and detail on top,
/// dam it, and a river that entered would find the edge again before it found its valley. So each
/// step of a river of at least `kRiverCells` planet cells gets a course from the lowest place near
/// the centre of its cell to that of the next (at the edge: to where it crosses), the path of least
///   integral of (1 + max(0, z - level) / 20 m) ds,   level = the planet's heights, linear between,
/// over the fine relief, and what stands above the level there is cut, with sides of a slope of at
/// most 0.15. Heights at or above the level of the sea stay so; nothing rises. Edge cells keep
/// their heights. `elevation_m`: one value per fine cell, in and out. Cost: n log n in the fine
/// cells that each step passes. The same bits for any number of threads (runs on one).
void open_river_courses(const PlanetCells& cells, const PlanetWater& water,
                        std::span<const RiverCrossing> crossings, std::span<float> elevation_m);

}  // namespace geo
