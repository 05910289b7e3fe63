#include "geo/io/maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <numbers>

#include "map_canvas.hpp"
#include "map_events.hpp"
#include "map_plates.hpp"
#include "map_relief.hpp"
#include "map_rivers.hpp"
#include "map_wind.hpp"

namespace geo::io {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr Rgb kPaleSea{0.85F, 0.90F, 0.925F};
constexpr Rgb kPaleLand{0.945F, 0.935F, 0.905F};
constexpr Rgb kRiver{0.16F, 0.39F, 0.62F};
constexpr Rgb kLake{0.49F, 0.68F, 0.82F};

/// What every map is drawn from.
struct Scene {
  const State& state;
  const MapFrame& frame;
  const MapBase& base;
  std::span<const EventMark> marks;
};

/// A map that can be drawn: its words and how.
struct Plan {
  std::string file, title, units, caption;
  std::function<void(const Scene&, MapCanvas&)> draw;
};

/// Where a field says something worth a colour.
enum class Extent { everywhere, land, ocean_floor };

/// A map of one field in the colours of one colour map.
struct FieldMap {
  const Field<float>* field;
  const char *file, *title, *units, *colours, *caption;
  Extent extent;
  float scale = 1.0F;  ///< from the field's unit to that of the colours
};

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

struct CategoryMap {
  const Field<std::int8_t>* field;
  const char *file, *title, *units, *caption;
  float pale_sea;  ///< by how much the sea's own categories fade
};

constexpr std::array<CategoryMap, 3> kCategoryMaps{{
    {&field::biome, "biomes", "Biomes", "after Whittaker", "Biomes by temperature and moisture.",
     0.0F},
    {&field::koppen_class, "koppen", "Climate classes", "after Köppen and Geiger",
     "Climate classes after Köppen and Geiger.", 0.0F},
    {&field::rock_type, "rock_type", "Rocks", "at the surface, paler under the sea",
     "Rock at the surface, as rivers feel it.", 0.6F},
}};

Rgb with_coast(const MapBase& base, int x, int y, Rgb colour) {
  return mix(colour, kInk, 0.6F * base.coast.at(x, y));
}

Rgb with_lakes(const MapBase& base, int x, int y, Rgb colour) {
  return base.lake_cover.values.empty() ? colour : mix(colour, kLake, base.lake_cover.at(x, y));
}

void draw_elevation(const Scene& scene, MapCanvas& canvas) {
  const ColourMap land("land_elevation"), sea("sea_depth");
  const MapBase& base = scene.base;
  canvas.paint([&](int x, int y) {
    const float cover = base.land_cover.at(x, y);
    const Rgb tint = mix(sea.smooth(base.sea_m.at(x, y)), land.smooth(base.land_m.at(x, y)), cover);
    const Rgb shaded = lit(tint, base.shade.at(x, y), 0.42F + 0.36F * cover);
    return with_lakes(base, x, y, mix(shaded, kInk, 0.25F * base.coast.at(x, y)));
  });
  draw_events(canvas, scene.state.grid(), scene.marks);
  canvas.frame();
  const std::array<const ColourMap*, 2> maps{&sea, &land};
  canvas.colour_bar(maps, false);
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

/// Relief with rivers and lakes over it, in the full colours of the height.
void draw_island(const Scene& scene, MapCanvas& canvas) {
  const ColourMap land("land_elevation"), sea("sea_depth");
  const MapBase& base = scene.base;
  canvas.paint([&](int x, int y) {
    const float cover = base.land_cover.at(x, y);
    const Rgb tint = mix(sea.smooth(base.sea_m.at(x, y)), land.smooth(base.land_m.at(x, y)), cover);
    const Rgb shaded = lit(tint, base.shade.at(x, y), 0.42F + 0.36F * cover);
    return with_lakes(base, x, y, mix(shaded, kInk, 0.25F * base.coast.at(x, y)));
  });
  if (has_rivers(scene.state)) draw_rivers(canvas, trace_rivers(scene.frame, scene.state), kRiver);
  canvas.frame();
  const std::array<const ColourMap*, 2> maps{&sea, &land};
  canvas.colour_bar(maps, false);
}

std::vector<Plan> plan_island(const State& state, const std::string& name) {
  std::vector<Plan> plans;
  if (state.has(field::elevation)) {
    plans.push_back({name, "Island", "metres above and below sea level",
                     "A part of the planet in detail: shaded relief, rivers and lakes.",
                     draw_island});
  }
  for (const auto& map : kCategoryMaps) {
    if (!state.has(*map.field)) continue;
    plans.push_back(
        {name + "-" + map.file, std::string(map.title) + " of the island", map.units, map.caption,
         [&map](const Scene& scene, MapCanvas& canvas) { draw_categories(map, scene, canvas); }});
  }
  return plans;
}

std::vector<Plan> plan_maps(const State& state) {
  std::vector<Plan> plans;
  if (state.has(field::elevation)) {
    plans.push_back({"elevation", "Elevation", "metres above and below sea level",
                     "Elevation in colours over relief shaded from the north-west.",
                     draw_elevation});
  }
  if (state.has(field::plate_id)) {
    plans.push_back({"plates", "Plates", "boundaries and velocities",
                     "Plates in colours, their boundaries by what happens there, and velocities.",
                     [](const Scene& scene, MapCanvas& canvas) {
                       draw_plates(canvas, scene.frame, scene.state, scene.base);
                     }});
  }
  const auto add_field = [&](const FieldMap& map) {
    if (!state.has(*map.field)) return;
    plans.push_back(
        {map.file, map.title, map.units, map.caption,
         [&map](const Scene& scene, MapCanvas& canvas) { draw_field(map, scene, canvas); }});
  };
  const auto add_categories = [&](const CategoryMap& map) {
    if (!state.has(*map.field)) return;
    plans.push_back(
        {map.file, map.title, map.units, map.caption,
         [&map](const Scene& scene, MapCanvas& canvas) { draw_categories(map, scene, canvas); }});
  };
  add_field(kFieldMaps[4]);
  add_field(kFieldMaps[5]);
  add_categories(kCategoryMaps[2]);
  add_field(kFieldMaps[0]);
  add_field(kFieldMaps[1]);
  if (state.has(field::wind_east) && state.has(field::wind_north)) {
    plans.push_back({"wind", "Wind", "annual mean near the surface, m per s",
                     "Speed in colours; arrows show where the air goes.", draw_wind});
  }
  if (has_rivers(state)) {
    plans.push_back({"rivers", "Rivers and lakes", "line width grows with discharge",
                     "The larger rivers and lakes; lines widen with the square root of the flow.",
                     draw_river_map});
  }
  add_categories(kCategoryMaps[0]);
  add_categories(kCategoryMaps[1]);
  add_field(kFieldMaps[2]);
  add_field(kFieldMaps[3]);
  return plans;
}

double height_over_width(const Grid& grid) {
  if (!grid.is_latitude_longitude()) {
    return grid.ny() * grid.spacing_north_m(0) / (grid.nx() * grid.spacing_east_m(0));
  }
  const Window& window = grid.window();
  const double degrees =
      (window.north_deg - window.south_deg) / (window.east_deg - window.west_deg);
  if (grid.topology() == Topology::sphere) return degrees;
  const double middle = 0.5 * (window.south_deg + window.north_deg) * std::numbers::pi / 180.0;
  return degrees / std::max(std::cos(middle), 0.05);
}

}  // namespace

MapLayout map_layout(const Grid& grid, int width_px) {
  if (width_px < 300 || width_px > 20000) {
    throw ConfigurationError(
        fmt::format("map width {} px: must be between 300 and 20000", width_px));
  }
  const double aspect = height_over_width(grid);
  MapLayout layout{};
  layout.map_width = aspect > 1.0 ? static_cast<int>(std::lround(width_px / aspect)) : width_px;
  layout.map_width = std::max(layout.map_width, 100);
  layout.map_height = std::max(static_cast<int>(std::lround(layout.map_width * aspect)), 100);
  const double unit = map_unit(layout.map_width);
  const auto scaled = [&](double pixels) { return static_cast<int>(std::lround(pixels * unit)); };
  layout.map_left = scaled(84);
  layout.map_top = scaled(84);
  layout.width_px = layout.map_left + layout.map_width + scaled(50);
  layout.height_px = layout.map_top + layout.map_height + scaled(126);
  return layout;
}

std::vector<const FieldSpec*> map_fields() {
  std::vector<const FieldSpec*> fields{&field::elevation,
                                       &field::lake_depth,
                                       &field::plate_id,
                                       &field::boundary_type,
                                       &field::plate_velocity_east,
                                       &field::plate_velocity_north,
                                       &field::continental_fraction,
                                       &field::wind_east,
                                       &field::wind_north,
                                       &field::flow_receiver,
                                       &field::drainage_area,
                                       &field::discharge};
  for (const auto& map : kFieldMaps) fields.push_back(map.field);
  for (const auto& map : kCategoryMaps) fields.push_back(map.field);
  return fields;
}

namespace {

/// The pictures that would be drawn.
std::vector<MapFile> files_of(const std::vector<Plan>& plans, const MapLayout& layout,
                              const std::filesystem::path& folder) {
  std::vector<MapFile> files;
  for (const Plan& plan : plans) {
    files.push_back({folder / (plan.file + ".png"), plan.title, plan.caption, layout.width_px,
                     layout.height_px});
  }
  return files;
}

std::vector<MapFile> draw_plans(const std::vector<Plan>& plans, const State& state,
                                const std::filesystem::path& folder, int width_px,
                                std::string_view note, std::span<const EventMark> marks = {}) {
  const MapLayout layout = map_layout(state.grid(), width_px);
  make_folder(folder);
  const MapFrame frame(state.grid(), layout.map_width, layout.map_height);
  const MapBase base = make_base(frame, state);
  const Scene scene{state, frame, base, marks};
  auto files = files_of(plans, layout, folder);
  std::vector<std::exception_ptr> failures(plans.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < plans.size(); ++i) {
    try {
      MapCanvas canvas(state.grid(), layout);
      canvas.title(plans[i].title, plans[i].units, note);
      plans[i].draw(scene, canvas);
      canvas.save(files[i].path);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  }
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  return files;
}

}  // namespace

std::vector<MapFile> draw_map_files(const State& state, const std::filesystem::path& folder,
                                    int width_px, std::string_view note,
                                    std::span<const EventMark> marks) {
  return draw_plans(plan_maps(state), state, folder, width_px, note, marks);
}

std::vector<MapFile> list_map_files(const State& state, const std::filesystem::path& folder,
                                    int width_px) {
  return files_of(plan_maps(state), map_layout(state.grid(), width_px), folder);
}

std::vector<MapFile> draw_island_files(const State& state, const std::filesystem::path& folder,
                                       const std::string& name, int width_px,
                                       std::string_view note) {
  return draw_plans(plan_island(state, name), state, folder, width_px, note);
}

std::vector<MapFile> list_island_files(const State& state, const std::filesystem::path& folder,
                                       const std::string& name, int width_px) {
  return files_of(plan_island(state, name), map_layout(state.grid(), width_px), folder);
}

std::vector<std::filesystem::path> draw_maps(const State& state,
                                             const std::filesystem::path& folder, int width_px,
                                             std::string_view note) {
  std::vector<std::filesystem::path> paths;
  for (auto& file : draw_map_files(state, folder, width_px, note)) {
    paths.push_back(std::move(file.path));
  }
  return paths;
}

}  // namespace geo::io
