#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Area-weighted order statistics of a field on a grid.
///
/// All functions take one float per cell and, where `mask` is not empty, one byte per cell: only
/// cells with a non-zero byte take part. NaN stands for "no value" and never takes part. Areas are
/// summed as integer shares of the grid (2^-62 of its total), so that results are exact, the same
/// for any number of threads, and free of histogram error. Cost: linear, two passes over the
/// field. Shapes that do not fit the grid, fractions outside [0, 1] and fields without any value
/// throw InputError.

/// Smallest value v of the field such that cells with a value <= v cover at least `fraction` of
/// the area: 0 gives the minimum, 1 the maximum.
float quantile(const Grid& grid, std::span<const float> field, double fraction,
               std::span<const std::uint8_t> mask = {});

/// The same for several fractions (any order) at the price of one.
std::vector<float> quantiles(const Grid& grid, std::span<const float> field,
                             std::span<const double> fractions,
                             std::span<const std::uint8_t> mask = {});

/// Share of the area whose value is strictly below `level`, in [0, 1].
double fraction_below(const Grid& grid, std::span<const float> field, float level,
                      std::span<const std::uint8_t> mask = {});

/// Level that has, as nearly as the cells allow, `fraction` of the area strictly below it: the sea
/// level of a wanted share of ocean. Of two equally near levels the lower one.
float level_for_fraction(const Grid& grid, std::span<const float> field, double fraction,
                         std::span<const std::uint8_t> mask = {});

/// Mean weighted by area.
double area_mean(const Grid& grid, std::span<const float> field,
                 std::span<const std::uint8_t> mask = {});

}  // namespace geo
