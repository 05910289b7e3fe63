#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Least-squares slope of y over x. NaN with fewer than two different x.
double regression_slope(std::span<const double> x, std::span<const double> y);

/// The same over the cells of a grid, weighted by true area; cells with NaN, and those where a mask
/// that is not empty holds 0, do not take part. Throws InputError on wrong shapes.
double area_regression_slope(const Grid& grid, std::span<const float> x, std::span<const float> y,
                             std::span<const std::uint8_t> mask = {});

}  // namespace geo
