#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/water/depressions.hpp"

namespace geo::detail {

/// Elevation as an unsigned integer of the same order.
inline std::uint32_t ordered_bits(float value) {
  const auto bits = __builtin_bit_cast(std::uint32_t, value + 0.0F);  // -0 becomes +0
  return (bits & 0x8000'0000U) != 0 ? ~bits : bits | 0x8000'0000U;
}
inline float from_ordered_bits(std::uint32_t ordered) {
  return __builtin_bit_cast(float,
                            (ordered & 0x8000'0000U) != 0 ? ordered & 0x7fff'ffffU : ~ordered);
}

/// Where two catchments meet: elevation of the higher cell (ordered bits) in the high half, that
/// cell and the direction from it in the low half. An order without ties, so that every spanning
/// forest of passes is unique.
using PassKey = std::uint64_t;

struct Pass {
  Index a, b;                   ///< the two cells
  std::int32_t leaf_a, leaf_b;  ///< their catchments, kSea for the sea's
  float elevation_m;
};

/// The catchments of all pits: which they are and which cells they hold.
struct Catchments {
  std::vector<Index> pits;                 ///< in raster order; position = leaf number
  std::vector<std::int32_t> leaf_of_cell;  ///< kSea for cells that reach an outlet
};
Catchments find_catchments(const Grid& grid, std::span<const std::uint8_t> outlets,
                           std::span<const Index> receiver);

/// The lowest passes that join all catchments and the sea into one tree, in rising order
/// (Kruskal). Each one is the first to join its two sides: water levels rising everywhere at the
/// same pace would meet there.
std::vector<Pass> spanning_passes(const Grid& grid, std::span<const float> elevation_m,
                                  std::span<const std::uint8_t> outlets,
                                  const Catchments& catchments);

/// Way of each catchment to the sea along the spanning passes.
struct Spill {
  Index inside = kNoCell, outside = kNoCell;  ///< cells on both sides of the pass it spills over
  float level_m = 0.0F;                       ///< level at which its water can reach an outlet
};
std::vector<Spill> spill_seaward(std::int32_t leaves, std::span<const Pass> passes);

/// Reverses the receivers from `inside` down to the pit and sends `inside` to `outside`.
void reverse_path(Index inside, Index outside, std::span<Index> receiver);

}  // namespace geo::detail
