#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// Blurs a field in place: each value spreads over a bell of standard deviation `length_m` along
/// every direction, the same at every latitude and resolution. Mass Σ value·area is kept.
///
/// Implicit diffusion (see diffusion.hpp) with 2 κ t = length², in four second-order steps (eight
/// with a mask on a latitude-longitude grid): the kernel has this variance and is within 2 % of the
/// Gaussian's peak everywhere. Cost: linear, whatever the length.
///
/// `mask`, one byte per cell or empty: only cells with a non-zero byte take part; the others keep
/// their values and nothing crosses between the two, as if a coast were a wall. Throws InputError
/// if shapes do not fit the grid or if length_m is negative or not finite.
void smooth(const Grid& grid, std::span<float> field, double length_m,
            std::span<const std::uint8_t> mask = {});

}  // namespace geo
