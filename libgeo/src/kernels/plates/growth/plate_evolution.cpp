#include "geo/kernels/plates/growth/plate_evolution.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace geo {
namespace {

/// A set of up to 128 plates.
struct PlateSet {
  std::array<std::uint64_t, 2> bits{};
  void add(int plate) { bits[plate >> 6] |= std::uint64_t{1} << (plate & 63); }
  [[nodiscard]] bool has(int plate) const { return (bits[plate >> 6] >> (plate & 63) & 1) != 0; }
  void add(const PlateSet& other) {
    bits[0] |= other.bits[0];
    bits[1] |= other.bits[1];
  }
  [[nodiscard]] bool has_several() const {
    return std::popcount(bits[0]) + std::popcount(bits[1]) > 1;
  }
};

/// Plates as near to each cell as they may come from in one step.
std::vector<PlateSet> plates_around(const CubedSphere& mesh, const std::vector<std::int16_t>& plate,
                                    double reach_rad) {
  if (reach_rad >= std::numbers::pi) {
    PlateSet all;
    for (const std::int16_t own : plate) all.add(own);
    return std::vector<PlateSet>(mesh.size(), all);
  }
  std::vector<PlateSet> around(mesh.size()), grown(mesh.size());
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) around[cell].add(plate[cell]);
  const int rings = 2 + static_cast<int>(reach_rad / (0.7 * mesh.spacing()));
  for (int ring = 0; ring < rings; ++ring) {
#pragma omp parallel for schedule(static)
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      grown[cell] = around[cell];
      for (const std::int32_t next : mesh.neighbours(cell)) grown[cell].add(around[next]);
    }
    around.swap(grown);
  }
  return around;
}

/// A rotation, ready to be applied to many places.
struct Turn {
  Vector3 axis;
  double cosine, sine;
  explicit Turn(const Vector3& rotation)
      : axis(normalised(rotation)),
        cosine(std::cos(length(rotation))),
        sine(std::sin(length(rotation))) {}
  [[nodiscard]] Vector3 of(const Vector3& r) const {
    return add(add(scaled(r, cosine), cross(axis, r), sine), axis, dot(axis, r) * (1.0 - cosine));
  }
};

}  // namespace

void move_plates(const CubedSphere& mesh, const std::vector<Plate>& plates, double time_myr,
                 std::vector<std::int16_t>& plate) {
  double farthest = 0.0;
  for (const Plate& p : plates) {
    farthest = std::max(farthest, length(p.rotation_rad_myr) * time_myr);
  }
  const auto around = plates_around(mesh, plate, farthest);
  std::vector<Turn> back;
  for (const Plate& p : plates) back.emplace_back(scaled(p.rotation_rad_myr, -time_myr));
  std::vector<std::int16_t> moved(plate);
#pragma omp parallel for schedule(dynamic, 4096)
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    if (!around[cell].has_several()) continue;
    const Vector3& here = mesh.position(cell);
    int winner = -1;
    for (std::size_t k = 0; k < plates.size(); ++k) {
      if (!around[cell].has(static_cast<int>(k))) continue;
      if (plate[mesh.locate(back[k].of(here))] != static_cast<std::int16_t>(k)) continue;
      if (winner < 0 || plates[k].buoyancy > plates[winner].buoyancy) winner = static_cast<int>(k);
    }
    if (winner >= 0) moved[cell] = static_cast<std::int16_t>(winner);
  }
  plate = moved;
#pragma omp parallel for schedule(dynamic, 4096)
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    if (!around[cell].has_several()) continue;
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
