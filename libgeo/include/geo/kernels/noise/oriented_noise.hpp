#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Directions without sign, one for each cell, as (cos, sin) of twice the angle from east; shorter
/// than 1 where they are uncertain, 0 where there is none.
struct Orientation {
  std::vector<float> cosine, sine;
};

/// Turned by a right angle.
[[nodiscard]] Orientation across(Orientation orientation);
/// From vectors, towards east and north; as (nearly) zero as `least` they have no direction.
[[nodiscard]] Orientation orientation_of(const Grid& grid, std::span<const float> east,
                                         std::span<const float> north, double least);
/// Along which a field is level: across its gradient.
[[nodiscard]] Orientation level_lines(const Grid& grid, std::span<const float> field);
/// The mean over a length: uncertain where directions disagree.
void smooth(const Grid& grid, Orientation& orientation, double length_m);

/// A band of noise whose crests run along given directions.
struct OrientedBand {
  double wavelength_km = 50.0;  ///< from crest to crest
  double width_km = 60.0;       ///< half the extent of a group of crests, across them
  double length_km = 150.0;     ///< and along them
  double overlap = 8.0;         ///< mean number of groups at a place
};

/// Sparse Gabor convolution noise (Lagae et al. 2009) on a sphere: groups of crests about the
/// points of a jittered Fibonacci lattice, each along the direction at its centre,
///   g = (1 - (u / width)^2 - (v / length)^2)^2 cos(2 pi u / wavelength + phase) inside the
///   ellipse,
/// u across and v along. The paper's kernel is round and Gaussian; an ellipse makes longer crests.
/// Adds noise of unit deviation times `factor`, zero where there is no direction; groups from where
/// crests run otherwise fade. `on` is the grid of the orientation, `values` belong to `grid`; both
/// are whole spheres. Waves that `grid` cannot show, shorter than about two and a half cells, are
/// left out, so that a coarse grid has what a fine one has, but for its fine detail. The same bits
/// for any number of threads. Cost: about overlap * 4 products per cell. Throws Bug where sizes
/// differ.
void add_oriented_noise(const Grid& grid, const Grid& on, const Orientation& crests,
                        const OrientedBand& band, double factor, std::uint64_t seed,
                        std::string_view stream, std::span<float> values);

}  // namespace geo
