#include "geo/kernels/remapping/mesh_sampling.hpp"

#include <algorithm>

namespace geo {

MeshStencil stencil_at(const CubedSphere& mesh, const Vector3& unit) {
  return stencil_at(mesh, mesh.locate(unit), unit);
}

MeshStencil stencil_at(const CubedSphere& mesh, std::int32_t cell, const Vector3& unit) {
  // The weight falls to zero, with zero slope, before the next ring of cells begins.
  constexpr double kReach = 1.2;  // cells
  const double scale = 1.0 / (kReach * mesh.spacing());
  MeshStencil stencil;
  stencil.cell[0] = cell;
  const auto& around = mesh.neighbours(stencil.cell[0]);
  for (std::size_t k = 0; k < around.size(); ++k) stencil.cell[k + 1] = around[k];
  double sum = 0.0;
  for (std::size_t k = 0; k < stencil.cell.size(); ++k) {
    const Vector3 away = add(mesh.position(stencil.cell[k]), unit, -1.0);
    const double within = std::max(0.0, 1.0 - dot(away, away) * scale * scale);
    stencil.weight[k] = within * within;
    sum += stencil.weight[k];
  }
  for (double& weight : stencil.weight) weight /= sum;
  return stencil;
}

}  // namespace geo
