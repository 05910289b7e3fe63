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
constexpr Rgb kLake{0.49F, 0.68F, 0.82F};

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
    {&field::biome, "biomes", "Biomes", "after Whittaker", "Biomes by temperature and moisture.",
     0.0F},
    {&field::koppen_class, "koppen", "Climate classes", "after Köppen and Geiger",
     "Climate classes after Köppen and Geiger.", 0.0F},
    {&field::rock_type, "rock_type", "Rocks", "at the surface, paler under the sea",
     "Rock at the surface, as rivers feel it.", 0.6F},
}};

}  // namespace

std::span<const FieldMap> field_maps() { return kFieldMaps; }
std::span<const CategoryMap> category_maps() { return kCategoryMaps; }

Rgb with_coast(const MapBase& base, int x, int y, Rgb colour) {
  return mix(colour, kInk, 0.6F * base.coast.at(x, y));
}

namespace {

Rgb with_lakes(const MapBase& base, int x, int y, Rgb colour) {
  return base.lake_cover.values.empty() ? colour : mix(colour, kLake, base.lake_cover.at(x, y));
}

// Hypsometric colours that break at the shore, under the light.
void paint_relief(const Scene& scene, MapCanvas& canvas, const ColourMap& sea,
                  const ColourMap& land) {
  const MapBase& base = scene.base;
  canvas.paint([&](int x, int y) {
    const float cover = base.land_cover.at(x, y);
    const Rgb tint = mix(sea.smooth(base.sea_m.at(x, y)), land.smooth(base.land_m.at(x, y)), cover);
    const Rgb shaded = lit(tint, base.shade.at(x, y), 0.42F + 0.36F * cover);
    return with_lakes(base, x, y, mix(shaded, kInk, 0.25F * base.coast.at(x, y)));
  });
}

/// Values of a field where its map shows it, NaN elsewhere.
Raster sample_extent(const FieldMap& map, const Scene& scene) {
  const auto values = scene.state.read(*map.field);
  const auto where = [&](const auto& shown) {
    return sample(scene.frame, Filter::linear,
                  [&](Index i) { return shown(i) ? map.scale * values[i] : kNaN; })
        .mean;
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
  canvas.paint([&](int x, int y) {
    const float at = position.at(x, y), cover = base.land_cover.at(x, y);
    const float shade = base.shade.at(x, y);
    Rgb colour =
        map.extent == Extent::ocean_floor ? lit(kPaleLand, shade, 0.12F + 0.4F * cover) : kPaleSea;
    if (at == at) {
      colour = colours.classed(at, change_per_pixel(position, x, y));
      colour = lit(colour, shade, 0.06F + 0.36F * cover);
      if (map.extent == Extent::land) colour = mix(kPaleSea, colour, cover);
    }
    return with_coast(base, x, y, colour);
  });
  canvas.frame();
  const std::array<const ColourMap*, 1> maps{&colours};
  canvas.colour_bar(maps, true);
}

void draw_categories(const CategoryMap& map, const Scene& scene, MapCanvas& canvas) {
  const ColourMap colours(map.field->name);
  const auto colour_of = [&](int value) {
    const auto* stop = colours.category(value);
    return stop != nullptr ? stop->colour : kFaintInk;
  };
  const Raster category = sample_majority(scene.frame, scene.state.read(*map.field));
  const MapBase& base = scene.base;
  canvas.paint([&](int x, int y) {
    const float faded = map.pale_sea * (1.0F - base.land_cover.at(x, y));
    const Rgb colour = mix(colour_of(static_cast<int>(category.at(x, y))), kPaleSea, faded);
    const Rgb shaded = lit(colour, base.shade.at(x, y), 0.34F * base.land_cover.at(x, y));
    return mix(shaded, kInk, 0.4F * base.coast.at(x, y));
  });
  canvas.frame();
  std::vector<std::pair<Rgb, std::string>> items;
  for (const Flag& flag : map.field->flags) {
    std::string name(flag.meaning);
    std::replace(name.begin(), name.end(), '_', ' ');
    items.emplace_back(colour_of(flag.value), name);
  }
  canvas.category_legend(items);
}

void draw_river_map(const Scene& scene, MapCanvas& canvas) {
  const ColourMap sea("sea_depth"), heights("land_elevation");
  const MapBase& base = scene.base;
  canvas.paint([&](int x, int y) {
    const float cover = base.land_cover.at(x, y), shade = base.shade.at(x, y);
    const Rgb water = lit(mix(sea.smooth(base.sea_m.at(x, y)), {1, 1, 1}, 0.6F), shade, 0.12F);
    const Rgb tint = mix(kPaleLand, heights.smooth(base.land_m.at(x, y)), 0.28F);
    const Rgb land = lit(tint, shade, 0.62F);
    return with_lakes(base, x, y, with_coast(base, x, y, mix(water, land, cover)));
  });
  const RiverNetwork rivers = trace_rivers(scene.frame, scene.state);
  draw_rivers(canvas, rivers, kRiver);
  canvas.frame();
  canvas.line_legend(kRiver, river_key(rivers, scene.state), kLake, "lakes");
}

void draw_wind(const Scene& scene, MapCanvas& canvas) {
  const ColourMap colours("wind_speed");
  const WindRasters wind = sample_wind(scene.frame, scene.state);
  const MapBase& base = scene.base;
  canvas.paint([&](int x, int y) {
    const Rgb colour = colours.smooth(wind.speed.at(x, y));
    return with_coast(base, x, y,
                      lit(colour, base.shade.at(x, y), 0.25F * base.land_cover.at(x, y)));
  });
  draw_wind_arrows(canvas, wind, scene.frame.wraps_east());
  canvas.frame();
  const std::array<const ColourMap*, 1> maps{&colours};
  canvas.colour_bar(maps, false);
}

void draw_island(const Scene& scene, MapCanvas& canvas) {
  const ColourMap land("land_elevation"), sea("sea_depth");
  paint_relief(scene, canvas, sea, land);
  draw_contours(canvas, scene.frame, scene.state.read(field::elevation));
  if (has_rivers(scene.state)) draw_rivers(canvas, trace_rivers(scene.frame, scene.state), kRiver);
  canvas.frame();
  const std::array<const ColourMap*, 2> maps{&sea, &land};
  canvas.colour_bar(maps, false);
}

}  // namespace geo::io
