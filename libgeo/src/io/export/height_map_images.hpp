#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "grid_sampler.hpp"

namespace geo::io {

/// One image: what its name has behind that of the layer, its size, and where its samples lie.
struct SampledImage {
  std::string face, tile;
  int tile_x = 0, tile_y = 0;
  int width, height;
  std::function<GridPlace(int x, int y)> place;  ///< y from the top
};

/// The samples of a whole grid or of its tiles, rows from the north. Tiles have `tile_samples` on a
/// side and share their edges; 0: the whole grid, a sample for each cell.
[[nodiscard]] std::vector<SampledImage> images_of_grid(const Grid& grid, int tile_samples);

/// The samples of six faces of a cube round a planet, or of their tiles, with shared edges. Throws
/// ConfigurationError where the grid is no whole planet.
[[nodiscard]] std::vector<SampledImage> images_of_cube(const Grid& grid, int tile_samples);

}  // namespace geo::io
