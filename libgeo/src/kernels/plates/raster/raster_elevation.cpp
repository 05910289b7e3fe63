#include "geo/kernels/plates/raster/raster_elevation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/kernels/crust/ocean_depth.hpp"

namespace geo {
namespace {

/// Of the rise of land with its crust: plains flatter, belts higher.
constexpr double kSteepening = 1.5;

double filling(double height, double ocean_crust, double sea_height) {
  return std::clamp((height - ocean_crust) / (sea_height - ocean_crust), 0.0, 1.0);
}

/// Unit vectors across the gradient of a field, after smoothing over some cells.
void along_contours(const RasterWorld& world, const std::vector<float>& field,
                    const std::vector<std::uint8_t>& wanted, std::vector<float>& x,
                    std::vector<float>& y) {
  constexpr int kReach = 3;
  x.assign(field.size(), 0.0F);
  y.assign(field.size(), 0.0F);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < world.rows; ++j) {
    for (int i = 0; i < world.columns; ++i) {
      const std::size_t cell = static_cast<std::size_t>(j) * world.columns + i;
      if (wanted[cell] == 0) continue;
      double gx = 0.0, gy = 0.0;
      for (int dy = -kReach; dy <= kReach; ++dy) {
        const std::size_t row = static_cast<std::size_t>(world.row(j + dy)) * world.columns;
        for (int dx = -kReach; dx <= kReach; ++dx) {
          const double value = field[row + world.column(i + dx)];
          gx += dx * value;
          gy += dy * value;
        }
      }
      const double size = std::hypot(gx, gy);
      if (!(size > 0.0)) continue;
      x[cell] = static_cast<float>(-gy / size);
      y[cell] = static_cast<float>(gx / size);
    }
  }
}

std::array<double, 4> spline_weights(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
          (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0};
}

}  // namespace

void fit_scale(std::vector<float> heights, double ocean_share, double median_land_m,
               RasterScale& scale) {
  constexpr double kLeast = 0.2;  // above bare floor, which has no shore
  std::sort(heights.begin(), heights.end());
  const auto size = static_cast<double>(heights.size());
  if (heights.empty()) return;
  if (ocean_share < 1.0) {
    const auto place = static_cast<std::size_t>(std::clamp(ocean_share, 0.0, 1.0) * size);
    scale.sea_height = std::max<double>(kLeast, heights[std::min(place, heights.size() - 1)]);
  }
  const auto shore =
      std::upper_bound(heights.begin(), heights.end(), static_cast<float>(scale.sea_height));
  if (shore == heights.end()) return;
  const double median = *(shore + (heights.end() - shore) / 2) - scale.sea_height;
  scale.half_height = std::max(
      1e-3, median * std::pow(1e3 * scale.summit_km / median_land_m - 1.0, 1.0 / kSteepening));
}

double raster_age_myr(double steps, const RasterScale& scale) {
  const double age = std::max(0.0, steps * scale.step_myr);
  return scale.oldest_floor_myr * std::tanh(age / scale.oldest_floor_myr);
}

double raster_elevation_m(double height, double age_myr, double ocean_crust,
                          const RasterScale& scale) {
  if (height >= scale.sea_height) {
    const double x = std::pow((height - scale.sea_height) / scale.half_height, kSteepening);
    return 1e3 * scale.summit_km * x / (1.0 + x);
  }
  return -ocean_depth_m(age_myr) * (1.0 - filling(height, ocean_crust, scale.sea_height));
}

double raster_thickness_m(double height, double ocean_crust, const RasterScale& scale) {
  const double t = filling(height, ocean_crust, scale.sea_height);
  const double shore_m = 1e3 * (scale.oceanic_km + t * (scale.shore_km - scale.oceanic_km));
  if (height < scale.sea_height) return shore_m;
  return shore_m + scale.rebound * raster_elevation_m(height, 0.0, ocean_crust, scale);
}

RasterOrogeny raster_orogeny(const RasterCrust& crust, double now, const RasterScale& scale) {
  constexpr double kShield_myr = 1000.0;
  if (crust.height < scale.sea_height) return {};
  if (crust.folded == 0) return {OrogenyType::none, now * scale.step_myr + kShield_myr};
  return {crust.folded % 2 == 1 ? OrogenyType::himalayan : OrogenyType::andean,
          (now - crust.folded / 2) * scale.step_myr};
}

RasterElevation raster_elevation(const RasterTectonics& model, const RasterScale& scale) {
  const RasterWorld& world = model.settings().world;
  const double ocean_crust = model.settings().ocean_crust;
  const RasterMap map = model.map();
  const auto now = static_cast<double>(model.steps());
  RasterElevation surface;
  surface.world = world;
  surface.plate = map.plate;
  const std::size_t n = map.crust.size();
  for (auto* field : {&surface.height, &surface.elevation_m, &surface.thickness_m, &surface.age_myr,
                      &surface.orogeny_age_myr}) {
    field->resize(n);
  }
  surface.orogeny.resize(n);
  std::vector<std::uint8_t> folded(n), floor(n);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < n; ++k) {
    const RasterCrust& crust = map.crust[k];
    const double age = raster_age_myr(now - crust.born, scale);
    surface.height[k] = crust.height;
    surface.age_myr[k] = static_cast<float>(age);
    surface.elevation_m[k] =
        static_cast<float>(raster_elevation_m(crust.height, age, ocean_crust, scale));
    surface.thickness_m[k] =
        static_cast<float>(raster_thickness_m(crust.height, ocean_crust, scale));
    const bool land = crust.height >= scale.sea_height;
    const RasterOrogeny orogeny = raster_orogeny(crust, now, scale);
    surface.orogeny_age_myr[k] = static_cast<float>(orogeny.age_myr);
    surface.orogeny[k] = static_cast<std::int8_t>(orogeny.type);
    folded[k] = orogeny.type == OrogenyType::none ? 0 : 1;
    floor[k] = land ? 0 : 1;
  }
  along_contours(world, surface.elevation_m, folded, surface.fold_x, surface.fold_y);
  along_contours(world, surface.age_myr, floor, surface.ridge_x, surface.ridge_y);
  return surface;
}

RasterVelocity raster_velocity(const RasterPlate& plate, const RasterWorld& world, double column,
                               double row) {
  const auto nearest = [](double d, double side) { return d - side * std::round(d / side); };
  const double dx = nearest(column - plate.x - plate.centre_x, world.columns);
  const double dy = nearest(row - plate.y - plate.centre_y, world.rows);
  return {plate.east - plate.spin * dy, plate.north + plate.spin * dx};
}

double smooth_value(const RasterWorld& world, const std::vector<float>& values, double column,
                    double row) {
  const double u = column - 0.5, v = row - 0.5;
  const double i = std::floor(u), j = std::floor(v);
  const auto wx = spline_weights(u - i), wy = spline_weights(v - j);
  double sum = 0.0;
  for (int b = 0; b < 4; ++b) {
    const std::size_t line =
        static_cast<std::size_t>(world.row(static_cast<int>(j) - 1 + b)) * world.columns;
    double along = 0.0;
    for (int a = 0; a < 4; ++a) {
      along += wx[a] * values[line + world.column(static_cast<int>(i) - 1 + a)];
    }
    sum += wy[b] * along;
  }
  return sum;
}

}  // namespace geo
