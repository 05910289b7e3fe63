#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// What rivers build at their mouths while the sea stands still.
struct DeltaLaw {
  double front_m = 0.5;     ///< height of their plains at the shore, where tides lay mud
  double slope = 7e-5;      ///< of their plains, down from the mouth (Syvitski & Saito 2007)
  double deepest_m = 60.0;  ///< water that they do not advance into
};

/// Builds deltas: from each river mouth, the one that brings most first, the sea is filled to the
/// height of the plain, cell by cell, the nearest and shallowest first (distance times 1 + depth /
/// 10 m), as long as there is enough for a whole cell and the next is no deeper than `deepest_m`.
/// The plain falls from the mouth to the shore,
///
///   h(d) = front_m + min(slope · (R − d), h0 − front_m),
///
/// d the way from the mouth, R the longest, h0 the height of the lowest land beside the mouth: no
/// river has to climb onto its own delta. R is found by filling four times.
/// No delta grows through that of another river. The sea spreads what is left (lay_at_sea).
///
/// `volume_m3` in: what each river brings to its cell of the sea, 0 elsewhere; out: what is left of
/// it. `sea`: one byte per cell. `laid_m`: by how much each cell rises, added to; `elevation_m` is
/// that before. Volumes laid and left add up to what was brought. Cost: m log m in the cells
/// filled, and a sort of the mouths. The same bits always.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void build_deltas(const Grid& grid, const DeltaLaw& law, std::span<const std::uint8_t> sea,
                  std::span<const float> elevation_m, std::span<double> volume_m3,
                  std::span<float> laid_m);

}  // namespace geo
