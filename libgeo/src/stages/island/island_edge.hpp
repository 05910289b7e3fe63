#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/remapping/planet_cells.hpp"
#include "island_window.hpp"

namespace geo {

/// Fills hollows that lie on both sides of the island's edge with what rivers bring: they rise
/// along their drainage from the sill by 1e-5, as gentle as large rivers get. Cut by the edge, a
/// hollow would lose its water over it below its sill. Lakes of the planet, cells with a
/// `planets_lake_id` (may be empty), keep theirs: in the margin the surface becomes that of their
/// water. Returns where, one byte per wide cell. `elevation_m`: one value per wide cell.
std::vector<std::uint8_t> fill_hollows_across_edge(const IslandWindow& window,
                                                   const PlanetCells& cells,
                                                   std::span<const std::uint8_t> outlets,
                                                   std::span<const std::int32_t> planets_lake_id,
                                                   std::span<float> elevation_m);

/// The finished surface of an island's window and what comes into it, one value per wide cell.
struct WideWater {
  std::span<const float> elevation_m;
  std::span<const std::uint8_t> outlets;  ///< sea, open edges, bottoms of endorheic basins
  std::span<const double> inflow_area_m2;
  std::span<const float> inflow_m3_s;
  std::span<const std::uint8_t> lake;  ///< 1 where the surface is that of a lake's water
};

/// How water passes the edge of an island, one value per cell of the island.
struct IslandEdge {
  std::vector<double> inflow_area_m2;
  std::vector<float> inflow_m3_s;
  std::vector<std::uint8_t> shut;  ///< 1 where the edge's own water flows inward
};

/// How water passes the edge of an island, which the margin of its window goes on beyond: along the
/// steepest descent over the sills of all depressions. Each edge cell on land takes what drains
/// into it from the margin, unless it passes it straight out again; water leaves where it goes on
/// in the margin. Where it comes back within two margins' length, and there is as low a way inside,
/// it stays; round a longer bend it comes back as inflow. The margin's ground yields what the
/// planet's cells do (land_evaporation) from `precipitation_mm_yr` P and `potential_mm_yr` E, one
/// value per cell of the planet, its lakes P - E. `cells`: of the wide grid.
IslandEdge find_island_edge(const IslandWindow& window, const PlanetCells& cells,
                            const WideWater& water, std::span<const float> precipitation_mm_yr,
                            std::span<const float> potential_mm_yr);

}  // namespace geo
