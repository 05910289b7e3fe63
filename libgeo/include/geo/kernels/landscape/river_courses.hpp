#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/kernels/water/inflow.hpp"

namespace geo {

/// Courses of a planet's rivers over the surface of a part of it: trees of neighbouring fine cells.
struct RiverCourses {
  std::vector<Index> cell;         ///< downstream first
  std::vector<std::int32_t> next;  ///< place of the next cell downstream; kCourseEnds at the end
  std::vector<float> level_m;      ///< highest level of the water there
  std::vector<float> least_m;      ///< how far that may sink for the sake of hollows upstream
  /// How steep the sides of cuts are, one for each fine cell; empty: 0.15 everywhere.
  std::vector<float> side_slope;
  /// Cost of a metre through each fine cell, over that through mean ground; empty: 1 everywhere.
  std::vector<float> toughness;
  /// Steps along its course within which water may take a shorter way to a place downstream.
  int shortcut = 8;
};
inline constexpr std::int32_t kCourseEnds = -1;

/// Lays out the courses of a planet's rivers in a part of it.
///
/// The water of each planet cell gets a course from the lowest place near the centre of the cell to
/// that near the centre of the next, or to another course that goes there as well; at the edge,
/// from or to where it crosses. Brooks come last and end in the first course they meet. It is the
/// path of least
///   integral of exp(2 n) (1 + 6 s^2) (1 + max(0, z - b) / 20 m) ds,
/// b = level - min(level / 2, 100 m), level = the planet's, linear between, n = noise of unit
/// variance, s = 1 at the edge to 0 an eighth of a planet cell from it, over the fine surface. It
/// keeps clear of other courses, of the edge and of the sea where it can. Courses end at the sea,
/// at the edge or at the bottom of an endorheic basin. On lakes the level is that of their outlet,
/// and does not sink; elsewhere it may sink to the level of the sea: the ground of detail between
/// the planet's cells is as low in places. `elevation_m`: one value per fine cell.
/// Cost: n log n in the fine cells that each step passes. The same bits for any number of threads.
/// `water`: as for find_inflow. `elevation_m`: one value per fine cell; Bug otherwise.
RiverCourses trace_river_courses(const PlanetCells& cells, const PlanetWater& water,
                                 const Crossings& crossings, std::uint64_t seed,
                                 std::span<const float> elevation_m);

/// Opens courses in a surface, so that what flows in one of them stays in it.
///
/// A planet's valley is one cell wide and often runs diagonally: interpolation, and detail on top,
/// dam it, or let the river out over a lower place at its side. So the water's level on a course is
/// at most `level_m`, falls downstream, and stays below every pass over which the water that stands
/// there would run out of the grid (`outlets`), into the sea, into another course, or into its own
/// one more than `shortcut` steps downstream: rivers meet where they meet on the planet. It also
/// sinks to the ground of the course upstream, though not below `least_m`, so that hollows of the
/// detail become valleys instead of lakes. What rises above that level on the course is cut, with
/// sides of a slope of at most 0.15, uneven as all ground is: on even ones brooks would run side by
/// side. What lies below it stays. Nothing rises, nothing is cut below the level of the sea, and of
/// the edge only cells on a course sink. `level_m` of the courses becomes the level found. Cost: n
/// log n in the cells of courses and pools. Runs on one thread. Arrays have one value per cell
/// (`check_sizes`); Bug otherwise.
void open_river_courses(const Grid& fine, std::span<const std::uint8_t> outlets,
                        RiverCourses& courses, std::span<float> elevation_m);

}  // namespace geo
