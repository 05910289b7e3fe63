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

// How steeply the ground rises away from the light, which falls from the upper left of the page,
// and the square of its slope.
struct Slope {
  double from_light, squared;
};

// Slopes are measured on the ground: towards the poles of an aligned page, where pixels narrow,
// over as many pixels as one is high.
class AlignedSlopes {
 public:
  AlignedSlopes(const MapFrame& frame, const Raster& height_m) : frame_(frame), height_(height_m) {}

  void start_row(int y) {
    y_ = y;
    east_m_ = std::max(frame_.pixel_east_m(y), 1e-3);
    const double north_m = frame_.pixel_north_m(y);
    reach_ = std::clamp(static_cast<int>(std::lround(north_m / east_m_)), 1,
                        std::max(1, height_.width / 8));
    above_ = std::max(y - 1, 0);
    below_ = std::min(y + 1, height_.height - 1);
    per_north_ = 1.0 / (north_m * std::max(below_ - above_, 1));
  }
  [[nodiscard]] Slope at(int x) const {
    int west = x - reach_, east = x + reach_;
    if (frame_.wraps_east()) {
      west = (west + height_.width) % height_.width;
      east %= height_.width;
    } else {
      west = std::max(west, 0);
      east = std::min(east, height_.width - 1);
    }
    const int columns = frame_.wraps_east() ? 2 * reach_ : east - west;
    const double rise_east =
        (height_.at(east, y_) - height_.at(west, y_)) / (east_m_ * std::max(columns, 1));
    const double rise_north = (height_.at(x, above_) - height_.at(x, below_)) * per_north_;
    return {(rise_east - rise_north) * std::sqrt(0.5),
            rise_east * rise_east + rise_north * rise_north};
  }

 private:
  const MapFrame& frame_;
  const Raster& height_;
  int y_ = 0, reach_ = 1, above_ = 0, below_ = 0;
  double east_m_ = 1.0, per_north_ = 1.0;
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
template <class Slopes>
Raster lambert(const MapFrame& frame, const Raster& height_m, double exaggeration) {
  Raster out(frame);
#pragma omp parallel
  {
    Slopes slopes(frame, height_m);
#pragma omp for schedule(static)
    for (int y = 0; y < out.height; ++y) {
      slopes.start_row(y);
      for (int x = 0; x < out.width; ++x) {
        const Slope slope = slopes.at(x);
        const double facing = (1.0 + exaggeration * slope.from_light) /
                              std::sqrt(1.0 + exaggeration * exaggeration * slope.squared);
        const double relative = facing - 1.0;  // -1 (and less, away from the light) to sqrt(2) - 1
        out.at(x, y) = static_cast<float>(
            std::clamp(relative > 0.0 ? relative / (std::sqrt(2.0) - 1.0) : relative, -1.0, 1.0));
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
  Raster shade = frame.is_aligned() ? lambert<AlignedSlopes>(frame, both, exaggeration)
                                    : lambert<ProjectedSlopes>(frame, both, exaggeration);
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

// Where pixels are finer than cells, the coast is the zero line of the interpolated relief, drawn
// half a pixel to either side. Land that is level with the sea has a coast only where it meets it.
void split_fine(const Raster& relief, MapBase& base) {
#pragma omp parallel for schedule(static)
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
#pragma omp parallel for schedule(static)
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
#pragma omp parallel for schedule(static)
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
#pragma omp parallel for schedule(static)
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
