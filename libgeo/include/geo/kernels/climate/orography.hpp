#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// How far each cell stands above the ground that the air crossed before it, m:
///   lift = h - weighted mean of h upwind, weights exp(-d / reach) at distances up to 3 reaches.
/// Positive on windward slopes and crests, negative in the lee, zero on plains and plateaux.
/// Heights are sampled bilinearly; beyond the edge of a plane they continue.
/// Arrays have one value per cell (`check_sizes`); Bug otherwise.
void upwind_lift(const Grid& grid, std::span<const float> height_m,
                 std::span<const float> wind_east, std::span<const float> wind_north,
                 double reach_m, std::span<float> lift_m);

/// Bilinear sampler of a raster by displacement in metres from a cell, over wrapping edges and
/// poles.
class DisplacedSampler {
 public:
  DisplacedSampler(const Grid& grid, std::span<const float> values)
      : grid_(grid), values_(values) {}
  /// Value `east_m`, `north_m` away from the centre of (column, row).
  [[nodiscard]] float operator()(int column, int row, double east_m, double north_m) const;

 private:
  [[nodiscard]] float at(int column, int row) const;
  const Grid& grid_;
  std::span<const float> values_;
};

}  // namespace geo
