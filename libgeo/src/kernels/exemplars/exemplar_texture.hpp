#pragma once

#include <span>
#include <vector>

#include "geo/kernels/exemplars/exemplar.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"

namespace geo {

/// An exemplar ready for use: high-passed, evened out, on cells no finer than they are looked at.
struct Texture {
  Terrain terrain;
  int nx, ny;
  double cell_m;
  bool periodic;
  double cosine, sine;  ///< of its fold direction
  double roughness_m;   ///< its own, before it was evened out
  std::vector<float> values;

  [[nodiscard]] float at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * nx + column];
  }
  /// Catmull-Rom at a place in m from the south-western corner.
  [[nodiscard]] double sample(double x_m, double y_m) const;
};

/// Radius of the discs over the shorter side of an exemplar: the rest is room for chance.
inline constexpr double kDiscShare = 0.3;

/// Radius of the discs that pieces of a library have: what fits into each with room for chance.
[[nodiscard]] double disc_radius_m(const ExemplarLibrary& library);

/// How often a cell of an exemplar goes into one of those it is looked at with, as long as some of
/// these still go into the exemplar.
[[nodiscard]] int times_coarser(const Exemplar& exemplar, double cell_m);

/// On cells up to `cell_m`.
[[nodiscard]] Texture texture_of(const Exemplar& exemplar, const ExemplarBand& band, double cell_m);

/// Takes out what cells of `cell_m` would show falsely, waves of up to about two and a half.
void blur_for(double cell_m, Texture& texture);

/// Gives it unit variance within the waves that cells of `cell_m` show.
void rescale(double cell_m, Texture& texture);

/// Of the textures, one for a place: terrain by share, exemplar by likeness of roughness. Both
/// numbers are chances in 0..1.
[[nodiscard]] const Texture& choose(std::span<const Texture> textures, const LocalTerrain& local,
                                    double by_terrain, double by_likeness);

}  // namespace geo
