#include "height_map_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// How many tiles of `samples` cover `steps` steps between samples, never coarser.
int tiles_over(int steps, int samples) {
  return std::max(1, (steps + samples - 2) / (samples - 1));
}

/// A place on a cube round the planet in whole steps, x to longitude 0, z to the north: faces that
/// share an edge give its places the same numbers, and so the same bits in all that follows.
struct CubePlace {
  int x, y, z;
};

struct CubeFace {
  const char* name;
  /// `right` and `up` run from -m to m over the face.
  CubePlace (*place)(int right, int up, int m);
};

// Each is seen from outside. The four round the equator stand north up, the top lies above the
// front and the bottom below it, as in an unfolded cross.
constexpr std::array<CubeFace, 6> kFaces{{{"front",
                                           [](int a, int b, int m) {
                                             return CubePlace{m, a, b};
                                           }},
                                          {"right",
                                           [](int a, int b, int m) {
                                             return CubePlace{-a, m, b};
                                           }},
                                          {"back",
                                           [](int a, int b, int m) {
                                             return CubePlace{-m, -a, b};
                                           }},
                                          {"left",
                                           [](int a, int b, int m) {
                                             return CubePlace{a, -m, b};
                                           }},
                                          {"top",
                                           [](int a, int b, int m) {
                                             return CubePlace{-b, a, m};
                                           }},
                                          {"bottom", [](int a, int b, int m) {
                                             return CubePlace{b, a, -m};
                                           }}}};

Centre position_of(const CubePlace& at) {
  const double x = at.x, y = at.y, z = at.z;
  if (at.x == 0 && at.y == 0) return {at.z > 0 ? 90.0 : -90.0, 0.0};
  return {std::atan2(z, std::sqrt(x * x + y * y)) * kDegrees, std::atan2(y, x) * kDegrees};
}

}  // namespace

std::vector<SampledImage> images_of_grid(const Grid& grid, int tile_samples) {
  const int nx = grid.nx(), ny = grid.ny();
  if (tile_samples == 0) {
    const auto place = [ny](int x, int y) {
      return GridPlace{static_cast<double>(x), static_cast<double>(ny - 1 - y)};
    };
    return {{"", "", 0, 0, nx, ny, place}};
  }
  // Round a planet and a torus samples lie on the edges of cells, the last ones on the first; on a
  // plane from the first centre to the last.
  const bool round = grid.topology() != Topology::plane;
  const int steps_x = round ? nx : nx - 1, steps_y = round ? ny : ny - 1;
  const int across = tiles_over(steps_x, tile_samples), down = tiles_over(steps_y, tile_samples);
  const double last_x = across * (tile_samples - 1.0), last_y = down * (tile_samples - 1.0);
  const bool torus = grid.topology() == Topology::torus;
  std::vector<SampledImage> images;
  for (int ty = 0; ty < down; ++ty) {
    for (int tx = 0; tx < across; ++tx) {
      const int left = tx * (tile_samples - 1), top = ty * (tile_samples - 1);
      const auto place = [=](int x, int y) {
        double column = left + x, row = last_y - (top + y);
        if (round && column == last_x) column = 0.0;
        if (torus && row == last_y) row = 0.0;
        const double offset = round ? -0.5 : 0.0;
        return GridPlace{column * steps_x / last_x + offset, row * steps_y / last_y + offset};
      };
      images.push_back(
          {"", fmt::format("_x{}_y{}", tx, ty), tx, ty, tile_samples, tile_samples, place});
    }
  }
  return images;
}

std::vector<SampledImage> images_of_cube(const Grid& grid, int tile_samples) {
  if (grid.topology() != Topology::sphere) {
    throw ConfigurationError("--layout cube: takes a whole planet, this grid is a part of one");
  }
  // Steps as long as cells at the equator.
  const int steps = std::max(2, grid.nx() / 4);
  const int tiles = tile_samples == 0 ? 1 : tiles_over(steps, tile_samples);
  const int samples = tile_samples == 0 ? steps + 1 : tile_samples;
  const int m = tiles * (samples - 1);
  std::vector<SampledImage> images;
  for (const CubeFace& face : kFaces) {
    for (int ty = 0; ty < tiles; ++ty) {
      for (int tx = 0; tx < tiles; ++tx) {
        const int left = tx * (samples - 1), top = ty * (samples - 1);
        const auto place = [&grid, &face, left, top, m](int x, int y) {
          const Centre at = position_of(face.place(2 * (left + x) - m, m - 2 * (top + y), m));
          return GridSampler::place_of(grid, at.latitude_deg, at.longitude_deg);
        };
        images.push_back({face.name, tile_samples == 0 ? "" : fmt::format("_x{}_y{}", tx, ty), tx,
                          ty, samples, samples, place});
      }
    }
  }
  return images;
}

}  // namespace geo::io
