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
void smooth(const Grid& grid, std::span<double> field, double length_m,
            std::span<const std::uint8_t> mask = {});

/// The same blur where the bell is many cells wide, at a cost that hardly depends on the cells:
/// worked out on cells of a fifth of the length, with the spread that averaging onto them and
/// cubic splines back add taken off, so that its variance is the same. Values stay within the
/// range of the field and within 2 % of the peak of the Gaussian answer; mass is kept within 0.3 %,
/// at the poles too.
void smooth_broadly(const Grid& grid, std::span<float> field, double length_m);
/// In double precision: `smooth` itself, at its own cost.
void smooth_broadly(const Grid& grid, std::span<double> field, double length_m);

}  // namespace geo
