#pragma once

#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Multiplies every spherical harmonic degree l of a field by gain[l], in place; degrees beyond the
/// gains are dropped. Any linear operator that treats all directions alike is of this kind:
/// flexure, Gaussian smoothing, a Laplacian.
///
/// Sphere grids only, whose parallels are the Chebyshev nodes of Fejér's first rule: the transform
/// is exact where a field's degree plus the highest gain is below ny. Fourier sums along rows
/// (Eigen's, for any nx), then Legendre sums by the recursion over degree of fully normalised
/// functions (Holmes & Featherstone 2002), both ways, a thread to each order. Cost ny L^2 / 2; L =
/// 340 on 1024 x 512 takes a quarter of a second. The latitude of an ellipsoid is taken for that of
/// a sphere. Throws InputError unless the grid is a sphere, field fits it and there are at most ny
/// and nx / 2 gains.
void filter_degrees(const Grid& grid, std::span<float> field, std::span<const double> gain);
void filter_degrees(const Grid& grid, std::span<double> field, std::span<const double> gain);

}  // namespace geo
