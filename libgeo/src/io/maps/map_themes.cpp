#include "map_themes.hpp"

#include <algorithm>
#include <limits>

#include "map_contours.hpp"
#include "map_events.hpp"
#include "map_rivers.hpp"
#include "map_wind.hpp"

namespace geo::io {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr Rgb kRiver{0.16F, 0.39F, 0.62F};

constexpr std::array<FieldMap, 6> kFieldMaps{{
    {&field::temperature, "temperature", "Temperature", "annual mean near the surface, °C",
     "temperature", "Annual mean air temperature near the surface in classes, over shaded relief.",
     Extent::everywhere},
    {&field::precipitation, "precipitation", "Precipitation", "annual, mm per year",
     "precipitation", "Annual precipitation in classes, over shaded relief.", Extent::everywhere},
    {&field::net_primary_productivity, "productivity", "Net primary productivity",
     "dry matter, g per m² and year", "net_primary_productivity",
     "Dry matter that plants build up in a year (Miami model).", Extent::land},
    {&field::settlement_suitability, "settlement", "Suitability for settlement",
     "0 (none) to 1 (best)", "settlement_suitability",
     "Suitability for agriculture and settlement, from climate, slope and water.", Extent::land},
    {&field::crust_age, "crust_age", "Age of the ocean floor", "million years", "crust_age",
     "Age of oceanic crust in classes: the borders between colours are isochrons.",
     Extent::ocean_floor},
    {&field::crust_thickness, "crust_thickness", "Thickness of the crust", "km", "crust_thickness",
     "Thickness of the crystalline crust in classes, over shaded relief.", Extent::everywhere,
     1e-3F},
}};

constexpr std::array<CategoryMap, 3> kCategoryMaps{{
    {&field::biome, "biomes", "Biomes", "after Whittaker",
     "Biomes by temperature and moisture, and land that is frozen all year.", 0.0F, true},
    {&field::koppen_class, "koppen", "Climate classes", "after Köppen and Geiger",
     "Climate classes after Köppen and Geiger.", 0.0F},
    {&field::rock_type, "rock_type", "Rocks", "at the surface, paler under the sea",
     "Lithology at the surface, by which erodibility differs.", 0.6F},
}};

}  // namespace

std::span<const FieldMap> field_maps() { return kFieldMaps; }
std::span<const CategoryMap> category_maps() { return kCategoryMaps; }

namespace {

/// Between sea and land by the share of the pixel that is land.
template <class Sea, class Land>
Rgb by_cover(float cover, const Sea& sea, const Land& land) {
  if (cover == 0.0F) return sea();
  return cover == 1.0F ? land() : mix(sea(), land(), cover);
}

/// Share of each pixel that is under ice or frozen all year; empty where that is not known.
Raster sample_ice(const Scene& scene) {
  const FrozenGround frozen(scene.state);
  if (!frozen.is_known()) return {};
  return sample_mean(scene.frame, Filter::linear,
                     [&](Index c) { return frozen.at(c) ? 1.0F : 0.0F; });
}

// Hypsometric colours that break at the shore, under the light; ice, where it is known, white.
void paint_relief(const Scene& scene, MapCanvas& canvas, const ColourMap& sea,
                  const ColourMap& land) {
  const MapBase& base = scene.base;
  const Raster ice = FrozenGround(scene.state).knows_ice() ? sample_ice(scene) : Raster();
  canvas.paint_rows([&](int y, ColourRow& row) {
    for (int x = 0; x < base.shade.width; ++x) {
      const float cover = base.land_cover.at(x, y);
      const Rgb tint = by_cover(
          cover, [&] { return sea.smooth(base.sea_m.at(x, y)); },
          [&] {
            const Rgb ground = land.smooth(base.land_m.at(x, y));
            return ice.values.empty() ? ground : mix(ground, kIce, 0.85F * ice.at(x, y));
          });
      row.set(x, tint, 0.42F + 0.36F * cover);
    }
    shade(row, base, y);
    draw_coast(row, base, y, 0.25F);
    fill_lakes(row, base, y);
  });
}

/// The paper of the sea over what is no land.
void fade_sea(ColourRow& row, const MapBase& base, int y) {
  const float* const cover = base.land_cover.row(y);
  for (std::size_t x = 0; x < row.r.size(); ++x) {
    row.r[x] = kPaleSea.r + cover[x] * (row.r[x] - kPaleSea.r);
    row.g[x] = kPaleSea.g + cover[x] * (row.g[x] - kPaleSea.g);
    row.b[x] = kPaleSea.b + cover[x] * (row.b[x] - kPaleSea.b);
  }
}

/// Values of a field where its map shows it, NaN elsewhere.
Raster sample_extent(const FieldMap& map, const Scene& scene) {
  const auto values = scene.state.read(*map.field);
  const auto where = [&](const auto& shown) {
    return sample_mean(scene.frame, Filter::linear,
                       [&](Index i) { return shown(i) ? map.scale * values[i] : kNaN; });
  };
  if (map.extent == Extent::ocean_floor && scene.state.has(field::continental_fraction)) {
    const auto continent = scene.state.read(field::continental_fraction);
    // Older crust at sea is stretched continent: subduction leaves no older floor.
    constexpr float kOldestFloorMyr = 250.0F;
    return where([=](Index i) { return continent[i] < 0.5F && values[i] <= kOldestFloorMyr; });
  }
  if (map.extent != Extent::everywhere && scene.state.has(field::elevation)) {
    const auto elevation = scene.state.read(field::elevation);
    const bool land = map.extent == Extent::land;
    return where([=](Index i) { return (elevation[i] >= 0.0F) == land; });
  }
  return where([](Index) { return true; });
}

/// Whether any land on a map is mostly ice.
bool shows_ice(const MapBase& base, const Raster& ice) {
  for (std::size_t k = 0; k < ice.values.size(); ++k) {
    if (base.land_cover.values[k] > 0.5F && ice.values[k] > 0.5F) return true;
  }
  return false;
}

}  // namespace

void draw_elevation(const Scene& scene, MapCanvas& canvas) {
  const ColourMap land("land_elevation"), sea("sea_depth");
  paint_relief(scene, canvas, sea, land);
  draw_events(canvas, scene.frame, scene.marks);
  canvas.frame();
  const std::array<const ColourMap*, 2> maps{&sea, &land};
  canvas.colour_bar(maps, false);
}

void draw_field(const FieldMap& map, const Scene& scene, MapCanvas& canvas) {
  const ColourMap colours(map.colours);
  const MapBase& base = scene.base;
  Raster position = sample_extent(map, scene);
  for (float& value : position.values) {
    if (value == value) value = colours.position(value);
  }
  std::vector<float> change;
  canvas.paint_rows([&](int y, ColourRow& row) {
    change_per_pixel(position, y, change);
    for (int x = 0; x < position.width; ++x) {
      const float at = position.at(x, y), cover = base.land_cover.at(x, y);
      if (at == at) {
        row.set(x, colours.classed(at, change[x]), 0.06F + 0.36F * cover);
      } else if (map.extent == Extent::ocean_floor) {
        row.set(x, kPaleLand, 0.12F + 0.4F * cover);
      } else {
        row.set(x, kPaleSea);
      }
    }
    shade(row, base, y);
    if (map.extent == Extent::land) fade_sea(row, base, y);
    draw_coast(row, base, y, 0.6F);
  });
  canvas.frame();
  const std::array<const ColourMap*, 1> maps{&colours};
  canvas.colour_bar(maps, true);
}

void draw_categories(const CategoryMap& map, const Scene& scene, MapCanvas& canvas) {
  const ColourMap colours(map.field->name);
  std::array<Rgb, 256> of_bytes{};
  for (int byte = 0; byte < 256; ++byte) {
    const auto* stop = colours.category(byte - 128);
    of_bytes[byte] = stop != nullptr ? stop->colour : kFaintInk;
  }
  const auto colour_of = [&](int value) { return of_bytes[value + 128]; };
  const Raster category = sample_majority(scene.frame, scene.state.read(*map.field));
  const Raster ice = map.has_ice ? sample_ice(scene) : Raster();
  const MapBase& base = scene.base;
  canvas.paint_rows([&](int y, ColourRow& row) {
    for (int x = 0; x < category.width; ++x) {
      if (!scene.frame.shows(x, y)) continue;
      const float cover = base.land_cover.at(x, y);
      const Rgb colour = colour_of(static_cast<int>(category.at(x, y)));
      const Rgb faded = mix(colour, kPaleSea, map.pale_sea * (1.0F - cover));
      row.set(x, ice.values.empty() ? faded : mix(faded, kIce, cover * ice.at(x, y)),
              0.34F * cover);
    }
    shade(row, base, y);
    draw_coast(row, base, y, 0.4F);
  });
  canvas.frame();
  std::vector<std::pair<Rgb, std::string>> items;
  for (const Flag& flag : map.field->flags) {
    std::string name(flag.meaning);
    std::replace(name.begin(), name.end(), '_', ' ');
    items.emplace_back(colour_of(flag.value), name);
  }
  if (shows_ice(base, ice)) items.emplace_back(kIce, FrozenGround(scene.state).name());
  canvas.category_legend(items);
}

void draw_river_map(const Scene& scene, MapCanvas& canvas) {
  const ColourMap sea("sea_depth"), heights("land_elevation");
  const MapBase& base = scene.base;
  const Raster ice = sample_ice(scene);
  canvas.paint_rows([&](int y, ColourRow& row) {
    for (int x = 0; x < base.shade.width; ++x) {
      const float cover = base.land_cover.at(x, y);
      const Rgb tint = by_cover(
          cover,
          [&] {
            return mix(sea.smooth(base.sea_m.at(x, y)), {1, 1, 1}, 0.6F);
          },
          [&] {
            const Rgb ground = mix(kPaleLand, heights.smooth(base.land_m.at(x, y)), 0.28F);
            return ice.values.empty() ? ground : mix(ground, kIce, 0.85F * ice.at(x, y));
          });
      row.set(x, tint, 0.12F + 0.5F * cover);
    }
    shade(row, base, y);
    draw_coast(row, base, y, 0.6F);
    fill_lakes(row, base, y);
  });
  const RiverNetwork rivers = trace_rivers(scene.frame, scene.state);
  draw_rivers(canvas, rivers, kRiver);
  canvas.frame();
  std::vector<std::pair<Rgb, std::string>> areas{{kLake, "lakes"}};
  if (shows_ice(base, ice)) areas.emplace_back(kIce, FrozenGround(scene.state).name());
  canvas.line_legend(kRiver, river_key(rivers, scene.state), areas);
}

void draw_wind(const Scene& scene, MapCanvas& canvas) {
  const ColourMap colours("wind_speed");
  const WindRasters wind = sample_wind(scene.frame, scene.state);
  const MapBase& base = scene.base;
  canvas.paint_rows([&](int y, ColourRow& row) {
    for (int x = 0; x < base.shade.width; ++x) {
      row.set(x, colours.smooth(wind.speed.at(x, y)), 0.25F * base.land_cover.at(x, y));
    }
    shade(row, base, y);
    draw_coast(row, base, y, 0.6F);
  });
  draw_wind_arrows(canvas, wind, scene.frame.wraps_east());
  canvas.frame();
  const std::array<const ColourMap*, 1> maps{&colours};
  canvas.colour_bar(maps, false);
}

void draw_island(const Scene& scene, MapCanvas& canvas) {
  const ColourMap land("land_elevation"), sea("sea_depth");
  paint_relief(scene, canvas, sea, land);
  const auto heights = draw_contours(canvas, scene.frame, scene.state.read(field::elevation));
  if (has_rivers(scene.state)) draw_rivers(canvas, trace_rivers(scene.frame, scene.state), kRiver);
  draw_contour_labels(canvas, heights);
  canvas.frame();
  const std::array<const ColourMap*, 2> maps{&sea, &land};
  canvas.colour_bar(maps, false);
}

}  // namespace geo::io
