#include "geo/kernels/landscape/sea_level.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

struct Basin {
  double volume_m3 = 0.0, area_m2 = 0.0;
};

Basin below(const Grid& grid, std::span<const float> elevation_m, double level_m) {
  std::vector<double> depth_m(grid.ny(), 0.0), wet(grid.ny(), 0.0);
#pragma omp parallel for schedule(static) if (grid.size() > 16384)
  for (int j = 0; j < grid.ny(); ++j) {
    double depth = 0.0, count = 0.0;
    for (const float z : elevation_m.subspan(std::size_t(j) * grid.nx(), grid.nx())) {
      if (z < level_m) depth += level_m - z, count += 1.0;
    }
    depth_m[j] = depth, wet[j] = count;
  }
  Basin basin;
  for (int j = 0; j < grid.ny(); ++j) {
    basin.volume_m3 += depth_m[j] * grid.area_m2(j);
    basin.area_m2 += wet[j] * grid.area_m2(j);
  }
  return basin;
}

double mean_m(const Grid& grid, std::span<const float> elevation_m) {
  double sum = 0.0, area = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double row = 0.0;
    for (const float z : elevation_m.subspan(std::size_t(j) * grid.nx(), grid.nx())) row += z;
    sum += row * grid.area_m2(j);
    area += grid.nx() * grid.area_m2(j);
  }
  return sum / area;
}

}  // namespace

double sea_level_for_volume(const Grid& grid, std::span<const float> elevation_m,
                            double volume_m3) {
  if (elevation_m.size() != static_cast<std::size_t>(grid.size())) {
    throw InputError("sea level: field of " + std::to_string(elevation_m.size()) +
                     " values on a grid of " + std::to_string(grid.size()) + " cells");
  }
  if (!(volume_m3 > 0.0 && std::isfinite(volume_m3))) {
    throw InputError("sea level: a water volume of " + std::to_string(volume_m3) +
                     " m3 is not positive and finite");
  }
  // Water over a surface that is nowhere dry would stand here; over any other it stands lower.
  double level_m = mean_m(grid, elevation_m) + volume_m3 / grid.total_area_m2();
  if (!std::isfinite(level_m)) throw InputError("sea level: an elevation is not finite");
  for (int step = 0; step < 200; ++step) {
    const Basin basin = below(grid, elevation_m, level_m);
    const double next_m = level_m - (basin.volume_m3 - volume_m3) / basin.area_m2;
    if (std::abs(next_m - level_m) < 1e-9) return next_m;
    level_m = next_m;
  }
  return level_m;
}

}  // namespace geo
