#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

enum class DiffusionScheme : std::uint8_t {
  /// Second order in time and L-stable: a step multiplies a Fourier mode of wave number k by
  /// (1 + √2) w² − √2 w with w = 1 / (1 + 0.293 κ k² dt), which lies between −0.21 and 1 and tends
  /// to 0 for long steps. Modes near the grid scale change sign once where √(κ dt) exceeds a cell.
  /// Four steps turn a point into a bell within 2 % of the Gaussian's peak, without undershoot.
  second_order,
  /// First order (backward Euler): on planes and tori no value leaves the range of the field.
  positive,
};

struct DiffusionOptions {
  /// One byte per cell, or empty: non-zero cells keep their value (Dirichlet).
  std::span<const std::uint8_t> fixed = {};
  /// One byte per cell, or empty: no flux enters or leaves non-zero cells (Neumann).
  std::span<const std::uint8_t> excluded = {};
  DiffusionScheme scheme = DiffusionScheme::second_order;
  /// Steps that dt is cut into; 0 chooses: 1 while √(2 κ dt) is less than a cell, up to 4 beyond,
  /// and up to 8 where meridians converge and cells are fixed or excluded.
  int substeps = 0;
};

/// Linear diffusion dz/dt = κ ∇²z over dt_yr, in place; one value per cell.
///
/// Hillslope creep, heat, or smoothing of any field. Finite volumes on the true metric of the grid:
/// the flux through a face, κ (difference / distance) · face length, leaves one cell and enters its
/// neighbour. The scheme is implicit and takes steps of any length. It splits directions after
/// Strang (1968): half a step along rows, one along columns, half along rows. Each part uses the
/// two-stage, second-order, L-stable Rosenbrock formula with γ = 1 − 1/√2, which needs one matrix.
/// On the sphere columns end at the poles, where faces have no length; along the short polar rows
/// exchange is so strong that they stay well mixed. Without fixed or excluded cells the three
/// longest zonal waves of a sphere, which cross the pole, are solved unsplit.
///
/// No flux crosses the edges of a plane, open or closed; fix the edge cells to hold a base level.
/// Without fixed cells Σ z·area is conserved to the round-off of float values; sums are in double.
/// The cost is linear, threaded over blocks of rows and of columns, without a temporary of the size
/// of the field. The result does not depend on the number of threads.
///
/// Throws InputError if shapes do not fit the grid or if κ or dt are negative or not finite.
void diffuse(const Grid& grid, std::span<float> field, double diffusivity_m2_yr, double dt_yr,
             const DiffusionOptions& options = {});
void diffuse(const Grid& grid, std::span<double> field, double diffusivity_m2_yr, double dt_yr,
             const DiffusionOptions& options = {});

}  // namespace geo
