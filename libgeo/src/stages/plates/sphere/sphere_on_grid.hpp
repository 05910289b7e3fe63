#pragma once

#include <optional>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "geo/stages/plates/plates.hpp"
#include "sphere_trenches.hpp"
#include "stages/plates/drifted_fields.hpp"

namespace geo {

/// Plates and crust of a lattice as the cells of a grid see them. The crust must have just been
/// resampled.
class SphereOnGrid {
 public:
  /// Crust stretched by a sixth: that at the edge of a shelf.
  static constexpr double kShelfEdge_m = 31e3;

  /// Crust is less of a continent the thinner it is below `whole_m`.
  SphereOnGrid(const PlatesParameters& parameters, const SphereTectonics& model, StageIo& io,
               const Context& context, double whole_m = kShelfEdge_m);
  void draw(StageIo& io) const;
  [[nodiscard]] std::span<const SphereBoundary> boundaries() const { return boundaries_; }

 private:
  class Bends;
  struct Cell {
    SphereMesh::Place place;
    std::int32_t nearest;
  };
  void find_polarity();
  void draw_crust(const Cell& at, Index cell, const Vector3& unit, const DriftedFields& out) const;
  [[nodiscard]] double age(const Cell& at, std::int16_t plate, bool land) const;
  void draw_boundary(const Cell& at, Index cell, const Vector3& bent,
                     const DriftedFields& out) const;
  [[nodiscard]] float heat(const Vector3& unit) const;

  const PlatesParameters& p_;
  const SphereTectonics& model_;
  const SphereMesh& mesh_;
  const Grid& grid_;
  double radius_km_, whole_m_, cell_km_;
  std::uint64_t seed_;
  std::vector<SphereBoundary> boundaries_;
  std::vector<std::int32_t> nearest_boundary_;  // of each sample, -1 far from any
  std::vector<std::uint8_t> overrides_;         // of each boundary: its plate stays up
  std::vector<std::uint8_t> is_edge_;           // samples beside another plate or crust type
  std::optional<SphereTrenches> trenches_;
};

}  // namespace geo
