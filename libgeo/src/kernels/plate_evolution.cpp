#include "geo/kernels/plate_evolution.hpp"

#include <algorithm>
#include <array>

namespace geo {
namespace {

/// Plates that may arrive at each cell: those within the reach of one step.
std::vector<std::uint8_t> near_boundary(const CubedSphere& mesh,
                                        const std::vector<std::int16_t>& plate, int rings) {
  std::vector<std::uint8_t> near(mesh.size(), 0), grown;
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    for (const std::int32_t next : mesh.neighbours(cell)) near[cell] |= plate[next] != plate[cell];
  }
  for (int ring = 1; ring < rings; ++ring) {
    grown = near;
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      if (near[cell] == 0) continue;
      for (const std::int32_t next : mesh.neighbours(cell)) grown[next] = 1;
    }
    near.swap(grown);
  }
  return near;
}

}  // namespace

void move_plates(const CubedSphere& mesh, const std::vector<Plate>& plates, double time_myr,
                 std::vector<std::int16_t>& plate) {
  double farthest = 0.0;
  for (const Plate& p : plates) {
    farthest = std::max(farthest, length(p.rotation_rad_myr) * time_myr);
  }
  const int rings = 2 + static_cast<int>(farthest / (0.7 * mesh.spacing()));
  const auto near = near_boundary(mesh, plate, rings);
  std::vector<std::int16_t> moved(plate);
#pragma omp parallel for schedule(dynamic, 4096)
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    if (near[cell] == 0) continue;
    const Vector3& here = mesh.position(cell);
    int winner = -1;
    for (std::size_t k = 0; k < plates.size(); ++k) {
      const Vector3 back = scaled(plates[k].rotation_rad_myr, -time_myr);
      if (plate[mesh.locate(rotated(here, back))] != static_cast<std::int16_t>(k)) continue;
      if (winner < 0 || plates[k].buoyancy > plates[winner].buoyancy) winner = static_cast<int>(k);
    }
    if (winner >= 0) moved[cell] = static_cast<std::int16_t>(winner);
  }
  plate = moved;
#pragma omp parallel for schedule(dynamic, 4096)
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    if (near[cell] == 0) continue;
    std::int16_t most = moved[cell];
    const auto votes = [&](std::int16_t candidate) {
      int count = moved[cell] == candidate ? 1 : 0;
      for (const std::int32_t next : mesh.neighbours(cell)) count += moved[next] == candidate;
      return count;
    };
    int best = votes(most);
    for (const std::int32_t next : mesh.neighbours(cell)) {
      if (moved[next] == most) continue;
      const int count = votes(moved[next]);
      if (count > best || (count == best && moved[next] < most && most != moved[cell])) {
        best = count;
        most = moved[next];
      }
    }
    plate[cell] = most;
  }
}

}  // namespace geo
