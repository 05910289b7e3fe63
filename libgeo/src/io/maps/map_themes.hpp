#pragma once

#include <array>
#include <span>

#include "geo/core/state.hpp"
#include "geo/io/maps/maps.hpp"
#include "io/drawing/map_canvas.hpp"
#include "map_base.hpp"

namespace geo::io {

/// What every map is drawn from.
struct Scene {
  const State& state;
  const MapFrame& frame;
  const MapBase& base;
  std::span<const EventMark> marks;
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

/// Those of every run.
std::span<const FieldMap> field_maps();

/// A map of one field of categories.
struct CategoryMap {
  const Field<std::int8_t>* field;
  const char *file, *title, *units, *caption;
  float pale_sea;        ///< by how much the sea's own categories fade
  bool has_ice = false;  ///< ice, or land that is frozen all year, is white
};

/// Those of every run.
std::span<const CategoryMap> category_maps();

void draw_elevation(const Scene& scene, MapCanvas& canvas);
void draw_field(const FieldMap& map, const Scene& scene, MapCanvas& canvas);
void draw_categories(const CategoryMap& map, const Scene& scene, MapCanvas& canvas);
void draw_river_map(const Scene& scene, MapCanvas& canvas);
void draw_wind(const Scene& scene, MapCanvas& canvas);
/// Relief with contours, rivers and lakes over it.
void draw_island(const Scene& scene, MapCanvas& canvas);

/// Paper where a field says nothing: the sea, and land.
inline constexpr Rgb kPaleSea{0.85F, 0.90F, 0.925F};
inline constexpr Rgb kPaleLand{0.945F, 0.935F, 0.905F};
/// Land that is frozen all year, and its name in legends.
inline constexpr Rgb kIce{0.955F, 0.97F, 0.985F};

}  // namespace geo::io
