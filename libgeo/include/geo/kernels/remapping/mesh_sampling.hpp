#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// The nine cells of a mesh around a position with weights that fall as a Gaussian of the true
/// distance, so that what is read between cells is smooth, on every part of the mesh alike.
struct MeshStencil {
  std::array<std::int32_t, CubedSphere::kNeighbours + 1> cell;
  std::array<double, CubedSphere::kNeighbours + 1> weight;  ///< sum 1
};
[[nodiscard]] MeshStencil stencil_at(const CubedSphere& mesh, const Vector3& unit);
/// The same where the cell that holds the position is known.
[[nodiscard]] MeshStencil stencil_at(const CubedSphere& mesh, std::int32_t cell,
                                     const Vector3& unit);

/// Weighted mean of a field of the mesh.
[[nodiscard]] inline double read(const MeshStencil& stencil, std::span<const float> values) {
  double sum = 0.0;
  for (std::size_t k = 0; k < stencil.cell.size(); ++k) {
    sum += stencil.weight[k] * values[stencil.cell[k]];
  }
  return sum;
}

}  // namespace geo
