#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Power of a field on the whole planet per spherical harmonic degree l = 0 .. max_degree,
///   S_l = sum_m a_lm^2, with harmonics whose mean square over the sphere is 1,
/// so that the S_l of a band-limited field add up to its mean square. Rows are transformed by FFT,
/// columns integrated by true area: exact to about (l / ny)^2. Cost: max_degree per cell;
/// coarse-grain the field to a few times max_degree rows before. Throws InputError when the grid is
/// no sphere or has fewer than 2 * max_degree rows or the field does not fit.
std::vector<double> harmonic_power(const Grid& grid, std::span<const float> field, int max_degree);

/// Exponent b of the power law S_l ~ l^b between two degrees, by least squares in logarithms over
/// the means of octaves of degrees. NaN when a power is not positive.
double spectral_slope(std::span<const double> power, int first_degree, int last_degree);

}  // namespace geo
