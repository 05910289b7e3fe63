#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/water/depressions.hpp"

namespace geo {

/// A lake in steady state.
struct Lake {
  std::int32_t depression;   ///< the node of the hierarchy that it stands in
  Index bottom;              ///< its lowest cell
  Index outlet = kNoCell;    ///< cell over which it overflows; kNoCell: endorheic
  float level_m = 0.0F;      ///< elevation of the water
  double inflow_m3_s = 0.0;  ///< runoff of its catchment and what other lakes spill into it
  double loss_m3_s = 0.0;    ///< extra evaporation from its surface; all of the inflow if endorheic
  double area_m2 = 0.0;
};

/// Which depressions hold water, and where it goes.
struct Lakes {
  std::vector<Lake> lakes;
  std::vector<std::int32_t> lake_of_leaf;  ///< position in `lakes`, or -1
  /// Cells on both sides of the pass over which the water of each leaf leaves it; kNoCell where it
  /// ends in the leaf's own pit.
  struct Exit {
    Index inside = kNoCell, outside = kNoCell;
  };
  std::vector<Exit> exit_of_leaf;
};

/// Steady-state water balance of all depressions. A flooded cell loses `flooding_loss_m3_s` beside
/// what the land yields; a depression whose inflow exceeds the loss of its full surface overflows
/// over its sill into its neighbour, and unites with it when that is full too; otherwise its water
/// stands at the level where the loss equals the inflow (its highest cell flooded in part, so that
/// the balance closes). Since water only moves inside a union until the union is full, a depression
/// is full exactly when the inflow to all of it exceeds its loss; so one sweep up the hierarchy
/// adds inflows, and one sweep down finds where the water of the unions that are not full stands.
/// Trees of the hierarchy that spill into other trees come before those. Without loss every
/// depression with inflow overflows. Cost: n log n in the depressions, linear in cells but for a
/// sort of those beneath endorheic sills.
///
/// Idea: Fill-Spill-Merge (Barnes, Callaghan & Wickert 2021), with evaporation in place of volume.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
Lakes balance_lakes(const Grid& grid, std::span<const float> elevation_m,
                    const DepressionHierarchy& hierarchy, std::span<const double> runoff_m3_s,
                    std::span<const float> flooding_loss_m3_s);

/// Turns the flow of each pit the way its water goes: through the lake to its outlet or to the
/// bottom of the endorheic one, by reversing the path from the exit of each leaf to its pit.
/// `receiver` must be the one the hierarchy was built from.
void connect_lakes(const Lakes& lakes, std::span<Index> receiver);

/// Depth of water and number of the lake, 1 the largest, in each cell; 0 where there is none.
/// Lakes flagged in `hidden` (one byte per lake; empty: none) stay out.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void map_lakes(const Grid& grid, std::span<const float> elevation_m,
               const DepressionHierarchy& hierarchy, const Lakes& lakes,
               std::span<const std::uint8_t> hidden, std::span<float> depth_m,
               std::span<std::int32_t> lake_id);

}  // namespace geo
