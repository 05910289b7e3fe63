#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Area-weighted means over `bands` bands of equal width in latitude, from the south. A row belongs
/// to the band of its centre. Cells with NaN, and those where a mask that is not empty holds 0, do
/// not take part; a band without any has NaN. Throws InputError on wrong shapes. Cost: linear.
std::vector<double> zonal_means(const Grid& grid, std::span<const float> field, int bands,
                                std::span<const std::uint8_t> mask = {});

/// Root mean square difference of two sets of zonal means, bands weighted by their true area on a
/// sphere. Bands that are NaN in either do not count.
double zonal_rms(std::span<const double> a, std::span<const double> b);

}  // namespace geo
