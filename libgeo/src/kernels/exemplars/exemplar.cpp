#include "geo/kernels/exemplars/exemplar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// Mean over squares of about 10 km, or the whole where it is smaller, of the range of heights.
double local_relief_m(const Exemplar& e) {
  constexpr double kSquare_m = 10e3;
  const auto squares = [&](int cells) {
    return std::max(1, static_cast<int>(cells * e.cell_m / kSquare_m));
  };
  const int across = squares(e.nx), up = squares(e.ny);
  double sum = 0.0;
  for (int b = 0; b < up; ++b) {
    for (int a = 0; a < across; ++a) {
      float low = e.highest_m, high = e.lowest_m;
      for (int j = b * e.ny / up; j < (b + 1) * e.ny / up; ++j) {
        for (int i = a * e.nx / across; i < (a + 1) * e.nx / across; ++i) {
          const float z = e.elevation_m[static_cast<std::size_t>(j) * e.nx + i];
          low = std::min(low, z);
          high = std::max(high, z);
        }
      }
      sum += high - low;
    }
  }
  return sum / (across * up);
}

Terrain terrain_of(double local_relief_m) {
  if (local_relief_m >= 1500.0) return Terrain::himalayan;
  if (local_relief_m >= 600.0) return Terrain::andean;
  if (local_relief_m >= 150.0) return Terrain::old_mountains;
  return Terrain::plain;
}

}  // namespace

std::string_view name_of(Terrain terrain) {
  constexpr std::array<std::string_view, kTerrains> kNames{"andean", "himalayan", "old_mountains",
                                                           "plain"};
  return kNames[static_cast<std::size_t>(terrain)];
}

Grid Exemplar::grid() const {
  return periodic ? Grid::torus(nx, ny, cell_m, cell_m)
                  : Grid::plane(nx, ny, cell_m, cell_m, Edges::closed);
}

std::array<double, 2> ridge_direction(const Grid& grid, std::span<const float> elevation_m) {
  check_sizes("ridge_direction", grid.size(), {{"elevation_m", elevation_m.size()}});
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index east = grid.neighbour(i, j, kEast), west = grid.neighbour(i, j, kWest);
      const Index north = grid.neighbour(i, j, kNorth), south = grid.neighbour(i, j, kSouth);
      if (east == kNoCell || west == kNoCell || north == kNoCell || south == kNoCell) continue;
      const double x = (elevation_m[east] - elevation_m[west]) / grid.spacing_east_m(j);
      const double y = (elevation_m[north] - elevation_m[south]) / grid.step_north_m();
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
  }
  if (xx + yy == 0.0) return {0.0, 0.0};
  const double across = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const double along = across < 0.5 * kPi ? across + 0.5 * kPi : across - 0.5 * kPi;
  return {along < 0.0 ? along + kPi : along, std::hypot(xx - yy, 2.0 * xy) / (xx + yy)};
}

void measure_exemplar(Exemplar& e, std::optional<Terrain> terrain) {
  constexpr int kLeast = 32;
  if (e.nx < kLeast || e.ny < kLeast) {
    throw InputError(
        fmt::format("{} x {} cells: an exemplar needs {} a side at least", e.nx, e.ny, kLeast));
  }
  if (!(e.cell_m > 0.0) || !std::isfinite(e.cell_m)) {
    throw InputError(fmt::format("cells of {:g} m: must be more than 0", e.cell_m));
  }
  constexpr double kMost_m = 2000e3;
  if (std::max(e.nx, e.ny) * e.cell_m > kMost_m) {
    throw InputError(fmt::format("reaches over {:.0f} km: an exemplar reaches {:.0f} km at most",
                                 1e-3 * std::max(e.nx, e.ny) * e.cell_m, 1e-3 * kMost_m));
  }
  for (std::size_t c = 0; c < e.elevation_m.size(); ++c) {
    if (std::isfinite(e.elevation_m[c])) continue;
    throw InputError(fmt::format("row {}, column {} holds no elevation", c / e.nx, c % e.nx));
  }
  const auto [low, high] = std::minmax_element(e.elevation_m.begin(), e.elevation_m.end());
  e.lowest_m = *low;
  e.highest_m = *high;
  if (e.lowest_m == e.highest_m) throw InputError("has no local relief: all cells are level");
  e.local_relief_m = local_relief_m(e);
  e.terrain = terrain.value_or(terrain_of(e.local_relief_m));

  constexpr double kSmoothing = 0.03;
  const Grid grid = e.grid();
  std::vector<float> smoothed = e.elevation_m;
  smooth(grid, std::span<float>(smoothed), kSmoothing * std::min(e.nx, e.ny) * e.cell_m);
  const auto [angle, strength] = ridge_direction(grid, smoothed);
  e.fold_rad = angle;
  e.fold_strength = strength;
}

}  // namespace geo
