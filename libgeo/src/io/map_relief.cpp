#include "map_relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geo::io {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Slopes flatten as the pixels of a relief grow, about as L^-0.4. The exaggeration makes up for
// it: 1 at 30 m, near 20 on a map of the world.
double vertical_exaggeration(double pixel_m) {
  return std::max(1.0, std::pow(pixel_m / 30.0, 0.45));
}

// Lambert shading under a light from the north-west, 45 degrees high. Slopes are measured on the
// ground: towards the poles, where pixels narrow, over as many pixels as one is high.
Raster lambert(const MapFrame& frame, const Raster& height_m, double exaggeration) {
  Raster out(frame);
  const int width = frame.width(), height = frame.height();
#pragma omp parallel for schedule(static)
  for (int y = 0; y < height; ++y) {
    const double east_m = std::max(frame.pixel_east_m(y), 1e-3);
    const double north_m = frame.pixel_north_m(y);
    const int reach =
        std::clamp(static_cast<int>(std::lround(north_m / east_m)), 1, std::max(1, width / 8));
    const int above = std::max(y - 1, 0), below = std::min(y + 1, height - 1);
    const double per_north = exaggeration / (north_m * std::max(below - above, 1));
    for (int x = 0; x < width; ++x) {
      int west = x - reach, east = x + reach;
      if (frame.wraps_east()) {
        west = (west + width) % width;
        east %= width;
      } else {
        west = std::max(west, 0);
        east = std::min(east, width - 1);
      }
      const int columns = frame.wraps_east() ? 2 * reach : east - west;
      const double per_east = exaggeration / (east_m * std::max(columns, 1));
      const double rise_east = (height_m.at(east, y) - height_m.at(west, y)) * per_east;
      const double rise_north = (height_m.at(x, above) - height_m.at(x, below)) * per_north;
      const double facing = (1.0 + (rise_east - rise_north) * std::sqrt(0.5)) /
                            std::sqrt(1.0 + rise_east * rise_east + rise_north * rise_north);
      const double relative = facing - 1.0;  // -1 (and less, away from the light) to sqrt(2) - 1
      out.at(x, y) = static_cast<float>(
          std::clamp(relative > 0.0 ? relative / (std::sqrt(2.0) - 1.0) : relative, -1.0, 1.0));
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
  for (std::size_t i = 0; i < both.values.size(); ++i) both.values[i] += 0.7F * broad.values[i];
  const double pixel_m = frame.pixel_north_m(frame.height() / 2);
  const double exaggeration = vertical_exaggeration(pixel_m);
  Raster shade = lambert(frame, both, exaggeration);
  const auto scale = static_cast<float>(exaggeration / (kBroadPx * pixel_m));
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

// Where pixels are finer than cells, the coast is the zero line of the interpolated relief, drawn
// half a pixel to either side. Land that is level with the sea has a coast only where it meets it.
void split_fine(const Raster& relief, MapBase& base) {
  for (int y = 0; y < relief.height; ++y) {
    for (int x = 0; x < relief.width; ++x) {
      const float elevation = relief.at(x, y);
      const float width = std::max(change_per_pixel(relief, x, y), 1e-3F);
      const bool all_land = lowest_around(relief, x, y) >= 0.0F;
      base.land_cover.at(x, y) = all_land ? 1.0F : std::clamp(0.5F + elevation / width, 0.0F, 1.0F);
      base.land_m.at(x, y) = std::max(elevation, 0.0F);
      base.sea_m.at(x, y) = std::min(elevation, 0.0F);
    }
  }
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
  for (std::size_t i = 0; i < relief.values.size(); ++i) {
    const float cover = base.land_cover.values[i];
    base.shade.values[i] = cover * land_shade.values[i] + (1.0F - cover) * sea_shade.values[i];
  }
}

Raster lakes(const MapFrame& frame, std::span<const float> depth_m) {
  const auto filter = frame.is_coarser() ? Filter::linear : Filter::smooth;
  auto wet = sample(frame, filter, [&](Index i) { return depth_m[i] > 0.0F ? 1.0F : 0.0F; }).mean;
  if (frame.is_coarser()) return wet;
  Raster cover = wet;
  for (int y = 0; y < wet.height; ++y) {
    for (int x = 0; x < wet.width; ++x) {
      const float width = std::max(change_per_pixel(wet, x, y), 1e-3F);
      cover.at(x, y) = std::clamp(0.5F + (wet.at(x, y) - 0.5F) / width, 0.0F, 1.0F);
    }
  }
  return cover;
}

}  // namespace

MapBase make_base(const MapFrame& frame, const State& state) {
  const int width = frame.width(), height = frame.height();
  MapBase base{Raster(frame, 1.0F), Raster(frame), Raster(frame),
               Raster(frame),       Raster(frame), Raster()};
  if (state.has(field::lake_depth)) base.lake_cover = lakes(frame, state.read(field::lake_depth));
  if (!state.has(field::elevation)) return base;

  const auto elevation = state.read(field::elevation);
  const Raster relief = sample(frame, Filter::smooth, [&](Index i) { return elevation[i]; }).mean;
  if (frame.is_coarser()) {
    split_coarse(frame, elevation, base);
  } else {
    split_fine(relief, base);
  }
  shade_land_and_sea(frame, relief, base);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      base.coast.at(x, y) = std::min(1.0F, 1.6F * change_per_pixel(base.land_cover, x, y));
    }
  }
  return base;
}

Rgb lit(Rgb colour, float shade, float strength) {
  constexpr Rgb kDark{0.09F, 0.11F, 0.20F};
  constexpr Rgb kLight{1.0F, 0.99F, 0.95F};
  return shade < 0.0F ? mix(colour, kDark, -0.85F * shade * strength)
                      : mix(colour, kLight, 0.75F * shade * strength);
}

}  // namespace geo::io
