#include "map_base.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geo/core/parallel_errors.hpp"

namespace geo::io {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Slopes flatten as the pixels of a relief grow, about as L^-0.4. The exaggeration makes up for
// it: 1 at 30 m, near 20 on a map of the world.
double vertical_exaggeration(double pixel_m) {
  return std::max(1.0, std::pow(pixel_m / 30.0, 0.45));
}

// Shade of ground by how it rises away from the light, which is 45 degrees high, and by the square
// of its slope, both exaggerated: from -1 to 1, 0 where flat.
float facing_light(float from_light, float squared) {
  constexpr float kMost = 0.41421356F;  // sqrt(2) - 1
  const float relative = (1.0F + from_light) / std::sqrt(1.0F + squared) - 1.0F;
  return std::clamp(relative > 0.0F ? relative / kMost : relative, -1.0F, 1.0F);
}

// On aligned pages slopes are measured on the ground: towards the poles, where pixels narrow, over
// as many pixels as one is high.
void shade_aligned_row(const MapFrame& frame, const Raster& height_m, double exaggeration, int y,
                       float* shade) {
  const int width = height_m.width, above = std::max(y - 1, 0),
            below = std::min(y + 1, height_m.height - 1);
  const double east_m = std::max(frame.pixel_east_m(y), 1e-3), north_m = frame.pixel_north_m(y);
  const int reach =
      std::clamp(static_cast<int>(std::lround(north_m / east_m)), 1, std::max(1, width / 8));
  const float *const here = height_m.row(y), *const up = height_m.row(above),
                     *const down = height_m.row(below);
  const auto per_row = static_cast<float>(exaggeration / (north_m * std::max(below - above, 1)));
  const auto lit = [&](int x, int west, int east, float per_column) {
    const float rise_east = (here[east] - here[west]) * per_column;
    const float rise_north = (up[x] - down[x]) * per_row;
    shade[x] = facing_light((rise_east - rise_north) * 0.70710678F,
                            rise_east * rise_east + rise_north * rise_north);
  };
  const auto over = [&](int columns) {
    return static_cast<float>(exaggeration / (east_m * std::max(columns, 1)));
  };
  const float inside = over(2 * reach);
#pragma omp simd
  for (int x = reach; x < width - reach; ++x) lit(x, x - reach, x + reach, inside);
  const auto at_edge = [&](int x) {
    if (frame.wraps_east()) {
      lit(x, (x - reach + width) % width, (x + reach) % width, inside);
    } else {
      const int west = std::max(x - reach, 0), east = std::min(x + reach, width - 1);
      lit(x, west, east, over(east - west));
    }
  };
  for (int x = 0; x < reach; ++x) at_edge(x);
  for (int x = std::max(reach, width - reach); x < width; ++x) at_edge(x);
}

// How steeply the ground rises away from the light, which falls from the upper left of the page,
// and the square of its slope.
struct Slope {
  double from_light, squared;
};

// On projected pages: the slope on the ground from the rise along the page's two axes and the
// metric (E F; F G) of the ground there. The light comes from where the upper left of the page lies
// on the ground, so that it turns with the map and no pole is in its way.
class ProjectedSlopes {
 public:
  ProjectedSlopes(const MapFrame& frame, const Raster& height_m)
      : frame_(frame), height_(height_m) {}

  void start_row(int y) { y_ = y; }
  [[nodiscard]] Slope at(int x) const {
    if (!frame_.shows(x, y_)) return {0.0, 0.0};
    const double rise_x = rise(x, 1, 0), rise_y = rise(x, 0, 1);
    const PixelGround& g = frame_.ground(x, y_);
    const double e = squared(g.across_east, g.across_north), f = product(g);
    const double gg = squared(g.down_east, g.down_north), area = e * gg - f * f;
    if (!(area > 1e-12 * e * gg)) return {0.0, 0.0};
    const double along_x = (gg * rise_x - f * rise_y) / area;
    const double along_y = (e * rise_y - f * rise_x) / area;
    const double both = std::sqrt(2.0 + 2.0 * f / std::sqrt(e * gg));
    const double from_light = (rise_x / std::sqrt(e) + rise_y / std::sqrt(gg)) / both;
    return {from_light, std::max(along_x * rise_x + along_y * rise_y, from_light * from_light)};
  }

 private:
  [[nodiscard]] static double squared(double a, double b) { return a * a + b * b; }
  [[nodiscard]] static double product(const PixelGround& g) {
    return double(g.across_east) * g.down_east + double(g.across_north) * g.down_north;
  }
  [[nodiscard]] double rise(int x, int dx, int dy) const {
    const int x0 = std::max(x - dx, 0), x1 = std::min(x + dx, height_.width - 1);
    const int y0 = std::max(y_ - dy, 0), y1 = std::min(y_ + dy, height_.height - 1);
    const float here = height_.at(x, y_);
    float before = height_.at(x0, y0), after = height_.at(x1, y1);
    int steps = x1 - x0 + y1 - y0;
    if (before != before) before = here, --steps;
    if (after != after) after = here, --steps;
    return steps > 0 ? double(after - before) / steps : 0.0;
  }
  const MapFrame& frame_;
  const Raster& height_;
  int y_ = 0;
};

// Lambert shading under a light from the upper left of the page, 45 degrees high.
Raster lambert(const MapFrame& frame, const Raster& height_m, double exaggeration) {
  Raster out(frame);
#pragma omp parallel
  {
    ProjectedSlopes slopes(frame, height_m);
#pragma omp for schedule(static)
    for (int y = 0; y < out.height; ++y) {
      if (frame.is_aligned()) {
        shade_aligned_row(frame, height_m, exaggeration, y, &out.at(0, y));
        continue;
      }
      slopes.start_row(y);
      for (int x = 0; x < out.width; ++x) {
        const Slope slope = slopes.at(x);
        out.at(x, y) =
            facing_light(static_cast<float>(exaggeration * slope.from_light),
                         static_cast<float>(exaggeration * exaggeration * slope.squared));
      }
    }
  }
  return out;
}

// Relief at two scales in one: ranges stay visible behind their own ridges, and ridges stand
// lighter than the valleys between them, as under an overcast sky.
Raster shade_of(const MapFrame& frame, const Raster& height_m) {
  constexpr double kBroadPx = 4.0;
  constexpr float kAmbient = 0.35F;
  const Raster broad = blur(frame, height_m, kBroadPx * frame.width() / 1800.0 + 0.5);
  Raster both = height_m;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < both.values.size(); ++i) both.values[i] += 0.7F * broad.values[i];
  const double pixel_m = frame.pixel_m();
  const double exaggeration = vertical_exaggeration(pixel_m);
  Raster shade = lambert(frame, both, exaggeration);
  const auto scale = static_cast<float>(exaggeration / (kBroadPx * pixel_m));
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < shade.values.size(); ++i) {
    const float stands_out = (height_m.values[i] - broad.values[i]) * scale;
    const float ambient = kAmbient * stands_out / (1.0F + std::abs(stands_out));
    shade.values[i] = std::clamp(shade.values[i] + ambient, -1.0F, 1.0F);
  }
  return shade;
}

float lowest_around(const Raster& raster, int x, int y) {
  return std::min({raster.at(x, y), raster.at(raster.west_of(x), y),
                   raster.at(raster.east_of(x), y), raster.at(x, std::max(y - 1, 0)),
                   raster.at(x, std::min(y + 1, raster.height - 1))});
}

/// Calls `visit(y, change per pixel along that row)` for all rows, at the same time.
template <class Visit>
void for_rows_with_change(const Raster& raster, const Visit& visit) {
  ParallelErrors errors;
#pragma omp parallel
  {
    std::vector<float> change;
#pragma omp for schedule(static)
    for (int y = 0; y < raster.height; ++y) {
      errors.guard([&] {
        change_per_pixel(raster, y, change);
        visit(y, change);
      });
    }
  }
  errors.rethrow();
}

// Where pixels are finer than cells, the coast is the zero line of the interpolated relief, drawn
// half a pixel to either side. Land that is level with the sea has a coast only where it meets it.
void split_fine(const Raster& relief, MapBase& base) {
  for_rows_with_change(relief, [&](int y, const std::vector<float>& change) {
    for (int x = 0; x < relief.width; ++x) {
      const float elevation = relief.at(x, y);
      const float width = std::max(change[x], 1e-3F);
      const bool all_land = lowest_around(relief, x, y) >= 0.0F;
      base.land_cover.at(x, y) = all_land ? 1.0F : std::clamp(0.5F + elevation / width, 0.0F, 1.0F);
      base.land_m.at(x, y) = std::max(elevation, 0.0F);
      base.sea_m.at(x, y) = std::min(elevation, 0.0F);
    }
  });
}

void split_coarse(const MapFrame& frame, std::span<const float> elevation, MapBase& base) {
  auto land = sample(frame, Filter::linear,
                     [&](Index i) { return elevation[i] >= 0.0F ? elevation[i] : kNaN; });
  auto sea = sample(frame, Filter::linear,
                    [&](Index i) { return elevation[i] < 0.0F ? elevation[i] : kNaN; });
  const auto zero_where_none = [](Raster& raster) {
    for (float& value : raster.values) value = value == value ? value : 0.0F;
  };
  zero_where_none(land.mean);
  zero_where_none(sea.mean);
  base.land_cover = std::move(land.cover);
  base.land_m = std::move(land.mean);
  base.sea_m = std::move(sea.mean);
}

void shade_land_and_sea(const MapFrame& frame, const Raster& relief, MapBase& base) {
  // Each in its own light: a shelf edge must not darken the beach above it.
  Raster land = relief, sea = relief;
  for (float& value : land.values) value = std::max(value, 0.0F);
  for (float& value : sea.values) value = std::min(value, 0.0F);
  const Raster land_shade = shade_of(frame, land), sea_shade = shade_of(frame, sea);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < relief.values.size(); ++i) {
    const float cover = base.land_cover.values[i];
    base.shade.values[i] = cover * land_shade.values[i] + (1.0F - cover) * sea_shade.values[i];
  }
}

Raster lakes(const MapFrame& frame, std::span<const float> depth_m) {
  const auto filter = frame.is_coarser() ? Filter::linear : Filter::smooth;
  auto wet = sample_mean(frame, filter, [&](Index i) { return depth_m[i] > 0.0F ? 1.0F : 0.0F; });
  if (frame.is_coarser()) return wet;
  Raster cover = wet;
  for_rows_with_change(wet, [&](int y, const std::vector<float>& change) {
    for (int x = 0; x < wet.width; ++x) {
      const float width = std::max(change[x], 1e-3F);
      cover.at(x, y) = std::clamp(0.5F + (wet.at(x, y) - 0.5F) / width, 0.0F, 1.0F);
    }
  });
  return cover;
}

}  // namespace

MapBase make_base(const MapFrame& frame, const State& state) {
  MapBase base{Raster(frame, 1.0F), Raster(frame), Raster(frame),
               Raster(frame),       Raster(frame), Raster()};
  if (state.has(field::lake_depth)) base.lake_cover = lakes(frame, state.read(field::lake_depth));
  if (!state.has(field::elevation)) return base;

  const auto elevation = state.read(field::elevation);
  const Raster relief = sample_mean(frame, Filter::smooth, [&](Index i) { return elevation[i]; });
  if (frame.is_coarser()) {
    split_coarse(frame, elevation, base);
  } else {
    split_fine(relief, base);
  }
  shade_land_and_sea(frame, relief, base);
  for_rows_with_change(base.land_cover, [&](int y, const std::vector<float>& change) {
    for (int x = 0; x < base.coast.width; ++x) {
      base.coast.at(x, y) = std::min(1.0F, 1.6F * change[x]);
    }
  });
  return base;
}

void shade(ColourRow& row, const MapBase& base, int y) {
  constexpr Rgb kDark{0.09F, 0.11F, 0.20F};
  constexpr Rgb kLight{1.0F, 0.99F, 0.95F};
  const float* const shade = base.shade.row(y);
  const float* const strength = row.light.data();
  float *const r = row.r.data(), *const g = row.g.data(), *const b = row.b.data();
#pragma omp simd
  for (std::size_t x = 0; x < row.r.size(); ++x) {
    const bool dark = shade[x] < 0.0F;
    const float t = (dark ? -0.85F : 0.75F) * shade[x] * strength[x];
    r[x] += t * ((dark ? kDark.r : kLight.r) - r[x]);
    g[x] += t * ((dark ? kDark.g : kLight.g) - g[x]);
    b[x] += t * ((dark ? kDark.b : kLight.b) - b[x]);
  }
}

void draw_coast(ColourRow& row, const MapBase& base, int y, float strength) {
  mix_in(row, kInk, base.coast.row(y), strength);
}

void fill_lakes(ColourRow& row, const MapBase& base, int y) {
  if (!base.lake_cover.values.empty()) mix_in(row, kLake, base.lake_cover.row(y), 1.0F);
}

}  // namespace geo::io
