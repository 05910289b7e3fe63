#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo {

/// Pieces are connected cells of one plate. A piece that is handed over joins the neighbour with
/// which it has the longest common border, the smallest piece first; the largest piece of each
/// plate stays. Linear cost but for sorting the pieces.

/// Hands over the pieces smaller than `smallest_sr`, whose cells are connected by sides or corners.
void merge_small_pieces(const CubedSphere& mesh, double smallest_sr,
                        std::vector<std::int16_t>& plate);

/// Hands over all pieces until the cells of each plate are connected by their sides, so that finer
/// grids than the mesh see them do so too.
void connect_plates(const CubedSphere& mesh, std::vector<std::int16_t>& plate);

/// The same on a sphere grid, by sides or corners, also over the poles: what bent outlines and the
/// size of its cells cut off. Returns the cells that were handed over, ascending. Throws InputError
/// for grids of another topology and for fields of another size.
std::vector<Index> connect_plates(const Grid& grid, std::span<std::int16_t> plate);

}  // namespace geo
