#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exemplar_texture.hpp"
#include "geo/core/random.hpp"
#include "geo/core/vector3.hpp"

namespace geo {

/// How large primitives are and how far from each other: discs, or ellipses that are longer along
/// the folds.
struct PrimitiveSize {
  explicit PrimitiveSize(double longest_m, double elongation = 1.0)
      : radius_m(longest_m),
        narrow_m(longest_m / elongation),
        apart_m(longest_m / std::sqrt(elongation) / kOverlap) {}
  static constexpr double kOverlap = 1.5;
  double radius_m, narrow_m, apart_m;
};

/// The places of primitives: a Fibonacci lattice, each point shifted by chance.
class PrimitivePlaces {
 public:
  PrimitivePlaces(double planet_m, const PrimitiveSize& size);
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Unit vector of a point that stays on the lattice; they follow each other from north to south.
  [[nodiscard]] Vector3 lattice(std::int64_t number) const;
  [[nodiscard]] Vector3 shifted(std::int64_t number, const RandomStream& random) const;

 private:
  std::int64_t count_;
  double shift_;
};

/// A piece of relief in the plane that touches the sphere at its centre.
struct Primitive {
  Vector3 centre;         ///< unit vector
  Vector3 u_m, v_m;       ///< along and across its piece's rows, times the planet's radius
  Vector3 along, across;  ///< the folds, such that they are 1 long at its edge
  const Texture* texture;
  double origin_x_m, origin_y_m;  ///< of its centre in the exemplar
};

/// The one that chance gives a place with this terrain.
[[nodiscard]] Primitive draw_primitive(const RandomStream& random, std::int64_t number,
                                       const Vector3& centre, double planet_m,
                                       const LocalTerrain& local, std::span<const Texture> textures,
                                       const PrimitiveSize& size);

/// Blends primitives along a row of places.
class BlendedRow {
 public:
  explicit BlendedRow(int columns) : unit_(columns), sum_(columns), squares_(columns) {}
  /// Where each column is; what was blended before is forgotten.
  [[nodiscard]] std::span<Vector3> begin();
  /// Adds one to the columns from `first` up to, not including, `last`.
  void add(const Primitive& primitive, int first, int last);
  [[nodiscard]] float operator[](int column) const {
    return squares_[column] > 0.0 ? static_cast<float>(sum_[column] / std::sqrt(squares_[column]))
                                  : 0.0F;
  }

 private:
  std::vector<Vector3> unit_;
  std::vector<double> sum_, squares_;
};

}  // namespace geo
