#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

enum class DiffusionScheme : std::uint8_t {
  /// Second order in time and free of oscillations that persist: every wave of the grid is damped
  /// by (1 + √2) w² − √2 w with w = 1 / (1 + 0.293 κ k² dt), which is within −0.21 and 1 and goes
  /// to 0 for long steps. Waves of the grid change sign where one step carries further than a cell;
  /// four steps make a bell of a point (within 2 % of the Gaussian's peak, no undershoot).
  second_order,
  /// First order (backward Euler): on planes and tori no value leaves the range of the field.
  positive,
};

struct DiffusionOptions {
  /// One byte per cell, or empty: non-zero cells keep their value, whatever flows through them.
  std::span<const std::uint8_t> fixed = {};
  /// One byte per cell, or empty: nothing flows into or out of non-zero cells.
  std::span<const std::uint8_t> excluded = {};
  DiffusionScheme scheme = DiffusionScheme::second_order;
  /// Steps that dt is cut into; 0 chooses: 1 while √(2 κ dt) is less than a cell, up to 4 beyond,
  /// and up to 8 where meridians converge and cells are fixed or excluded.
  int substeps = 0;
};

/// Linear diffusion dz/dt = κ ∇²z over dt_yr, in place; one value per cell.
///
/// Finite volumes on the true metric of the grid: what leaves a cell through a face enters its
/// neighbour, flux = κ (difference / distance) · face length. Implicit, for steps of any length:
/// rows and columns are solved in turn, half a step of rows, one of columns, half of rows (Strang
/// 1968), each by the two-stage, second-order, L-stable Rosenbrock formula with γ = 1 − 1/√2,
/// which needs one matrix only. On the sphere columns end at the poles, where faces have no
/// length; polar rows exchange along themselves, and there so strongly that they stay mixed.
/// Without fixed or excluded cells the three longest zonal waves of a sphere, which cross the pole,
/// are solved unsplit.
///
/// Edges of a plane, open or closed, let nothing diffuse across; fix the edge cells to hold a base
/// level. Without fixed cells Σ z·area is kept to the round-off of float values. Sums are in
/// double. Cost: linear, threaded over blocks of rows and of columns, no temporary of the size of
/// the field. The result does not depend on the number of threads.
///
/// Throws InputError if shapes do not fit the grid or if κ or dt are negative or not finite.
void diffuse(const Grid& grid, std::span<float> field, double diffusivity_m2_yr, double dt_yr,
             const DiffusionOptions& options = {});
void diffuse(const Grid& grid, std::span<double> field, double diffusivity_m2_yr, double dt_yr,
             const DiffusionOptions& options = {});

}  // namespace geo
