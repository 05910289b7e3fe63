#include "report_globe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "geo/io/files/embedded_data.hpp"
#include "globe_layers.hpp"
#include "globe_overlays.hpp"
#include "io/drawing/map_page.hpp"
#include "io/drawing/map_raster.hpp"
#include "io/maps/map_field.hpp"
#include "io/maps/map_plates.hpp"
#include "io/maps/map_rivers.hpp"
#include "io/maps/map_themes.hpp"

namespace geo::io {
namespace {

ordered_json entry_of(const std::string& title, std::string_view units, const char* kind) {
  return {{"title", title},
          {"units", units},
          {"kind", kind},
          {"factor", 1.0},
          {"paper", hex(kPaleLand)}};
}

void put_stops(ordered_json& entry, const std::vector<ColourMap::Stop>& stops, double factor) {
  for (const auto& stop : stops) {
    entry["stops"].push_back(stop.value / factor);
    entry["colours"].push_back(hex(stop.colour));
  }
}

/// Colours of the sea's floor up to the shore, then those of land.
ordered_json relief_entry() {
  auto entry = entry_of("Elevation", "m", "smooth");
  const ColourMap sea("sea_depth"), land("land_elevation");
  put_stops(entry, sea.stops(), 1.0);
  // The coast is a step: both stops at the shore are wanted, one a hair below the other.
  constexpr double kBelow_m = 1e-3;
  entry["stops"].back() = entry["stops"].back().get<double>() - kBelow_m;
  put_stops(entry, land.stops(), 1.0);
  entry["shown_units"] = "m";
  return entry;
}

/// Classes between stops, as the map of the field has them.
ordered_json classes_entry(const FieldMap& map) {
  auto entry = entry_of(map.title, map.field->units, "classes");
  const ColourMap colours(map.colours);
  const auto& stops = colours.stops();
  for (std::size_t k = 0; k < stops.size(); ++k) {
    entry["stops"].push_back(stops[k].value / map.scale);
    if (k + 1 < stops.size())
      entry["colours"].push_back(hex(colours.class_colour(static_cast<int>(k))));
  }
  entry["factor"] = map.scale;
  entry["shown_units"] = map.units;
  return entry;
}

ordered_json categories_entry(const FieldSpec& spec, const std::string& title) {
  auto entry = entry_of(title, "", "categories");
  for (const auto& [colour, flag] : category_colours(spec)) {
    entry["stops"].push_back(flag->value);
    entry["colours"].push_back(hex(colour));
    entry["names"].push_back(flag->meaning);
  }
  return entry;
}

ordered_json plates_entry(const State& state, const MapFrame& frame) {
  auto entry = entry_of("Plates", "", "areas");
  for (const auto& [plate, colour] : plate_colours(frame, state)) {
    entry["stops"].push_back(plate);
    entry["colours"].push_back(hex(colour));
  }
  return entry;
}

/// Where the map of a field shows it: 1 a cell, empty where everywhere.
std::vector<std::uint8_t> shown_cells(const FieldMap& map, const State& state,
                                      const Thinning& thinning) {
  if (map.extent == Extent::everywhere) return {};
  const auto elevation = shown_values(state, field::elevation, thinning);
  std::vector<std::uint8_t> shown(elevation.size());
  if (map.extent == Extent::land) {
    for (std::size_t k = 0; k < shown.size(); ++k) shown[k] = elevation[k] >= 0.0 ? 1 : 0;
    return shown;
  }
  const bool knows = state.has(field::continental_fraction);
  const auto continent =
      knows ? shown_values(state, field::continental_fraction, thinning) : std::vector<double>();
  const auto age = shown_values(state, *map.field, thinning);
  constexpr double kOldestFloor_myr = 250.0;  // older crust at sea is stretched continent
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const bool floor = knows ? continent[k] < 0.5 : elevation[k] < 0.0;
    shown[k] = floor && age[k] <= kOldestFloor_myr ? 1 : 0;
  }
  return shown;
}

/// 2 where land is under ice or frozen all year, 1 elsewhere; empty where none is.
std::vector<std::uint8_t> frozen_cells(const State& state, const Thinning& thinning) {
  const FrozenGround frozen(state);
  const Grid& grid = state.grid();
  const auto elevation = state.read(field::elevation);
  std::vector<std::uint8_t> cells;
  cells.reserve(static_cast<std::size_t>(thinning.nx) * thinning.ny);
  for (int j = 0; j < thinning.ny; ++j) {
    for (int i = 0; i < thinning.nx; ++i) {
      const Index cell = grid.cell(thinning.column(i), thinning.row(j));
      cells.push_back(elevation[cell] >= 0.0F && frozen.at(cell) ? 2 : 1);
    }
  }
  if (std::find(cells.begin(), cells.end(), 2) == cells.end()) cells.clear();
  return cells;
}

void add_categories(const CategoryMap& map, const State& state, const Thinning& thinning,
                    GlobeLayers& layers) {
  auto entry = categories_entry(*map.field, map.title);
  const auto cells = map.has_ice ? frozen_cells(state, thinning) : std::vector<std::uint8_t>();
  if (!cells.empty()) entry["over"] = {{"colour", hex(kIce)}, {"name", FrozenGround(state).name()}};
  layers.add(*map.field, std::move(entry), cells);
}

void add_layers(const State& state, const Thinning& thinning, const MapFrame& frame,
                GlobeLayers& layers) {
  layers.add(field::elevation, relief_entry());
  for (const FieldMap& map : field_maps()) {
    if (!state.has(*map.field)) continue;
    layers.add(*map.field, classes_entry(map), shown_cells(map, state, thinning));
  }
  for (const CategoryMap& map : category_maps()) {
    if (state.has(*map.field)) add_categories(map, state, thinning, layers);
  }
  if (state.has(field::plate_id)) layers.add(field::plate_id, plates_entry(state, frame));
  if (state.has(field::wind_east) && state.has(field::wind_north)) {
    auto speed = shown_values(state, field::wind_east, thinning);
    const auto north = shown_values(state, field::wind_north, thinning);
    for (std::size_t k = 0; k < speed.size(); ++k) speed[k] = std::hypot(speed[k], north[k]);
    auto entry = entry_of("Wind", "m s-1", "smooth");
    put_stops(entry, ColourMap("wind_speed").stops(), 1.0);
    entry["shown_units"] = "m/s";
    layers.add_values("wind_speed", speed, false, std::move(entry));
  }
}

/// Frames on the cells of the page, where they have as many.
ordered_json add_frames(const std::vector<GlobeFrame>& frames, const Thinning& thinning,
                        GlobeLayers& layers) {
  auto index = ordered_json::array();
  for (const GlobeFrame& frame : frames) {
    const Thinning own(frame.state.grid(), kMostColumns);
    const FieldSpec& relief =
        frame.state.has(field::elevation) ? field::elevation : field::crust_elevation;
    if (own.nx != thinning.nx || own.ny != thinning.ny || !frame.state.has(relief)) continue;
    auto entry = entry_of("Elevation", "m", "smooth");
    entry["time_myr"] = frame.time_myr;
    index.push_back(layers.described(fmt::format("globe-frame-{}", index.size()),
                                     shown_values(frame.state, relief, own), false,
                                     std::move(entry)));
  }
  return index;
}

/// Months of what has them, each a layer of its own: in steps fine enough for an eye and small
/// enough for a page.
ordered_json add_months(const PlanetMonths& months, const State& state, const Thinning& thinning,
                        GlobeLayers& layers) {
  constexpr int kLevels = 1000;
  auto index = ordered_json::object();
  for (const FieldMap& map : field_maps()) {
    const bool is_warmth = map.field == &field::temperature;
    if ((!is_warmth && map.field != &field::precipitation) || !state.has(*map.field)) continue;
    for (int m = 0; m < Climatology::kMonths; ++m) {
      const auto& values = is_warmth ? months.temperature_c[m] : months.precipitation_mm[m];
      auto entry = classes_entry(map);
      entry["name"] = map.field->name;
      entry["title"] = fmt::format("{} in {}", map.title, kMonthNames[m]);
      if (!is_warmth) {
        for (auto& stop : entry["stops"]) stop = stop.get<double>() / kRainOfAYear;
        entry["units"] = "mm month-1";
        entry["shown_units"] = "mm per month";
      }
      index[std::string(map.field->name)].push_back(
          layers.described(fmt::format("globe-{}-{}", map.field->name, m + 1),
                           std::vector<double>(values.begin(), values.end()), false,
                           std::move(entry), shown_cells(map, state, thinning), kLevels));
    }
  }
  return index;
}

std::string without_tags(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) {
    json.replace(at, 1, "\\u003c");
  }
  return json;
}

constexpr const char* kSection = R"(<section id="globe" hidden>
<canvas tabindex="0" aria-label="The planet as a globe: drag or use the arrow keys to turn it, the wheel or + and - to come nearer"></canvas>
<p class="globe-value" data-part="value" aria-live="polite"></p>
<div class="globe-hands">
<label>Layer <select data-part="layer"></select></label>
<label>Exaggeration <input data-part="exaggeration" type="range" min="0" max="60" value="15"></label>
<label><input data-part="floor" type="checkbox"> sea floor</label>
<label><input data-part="rivers" type="checkbox" checked> rivers</label>
<label><input data-part="plates" type="checkbox"> plates</label>
<label><input data-part="wind" type="checkbox"> winds</label>
<label><input data-part="graticule" type="checkbox"> graticule</label>
<label>Month <input data-part="month" type="range" min="0" max="12" value="0"> <output data-part="month-name">year</output></label>
<label>Time <input data-part="frame" type="range" min="0" value="0"> <output data-part="time">today</output></label>
</div>
<div class="globe-legend" data-part="legend"></div>
</section>
)";

}  // namespace

std::string globe_markup(const State& state, const std::vector<GlobeFrame>& frames,
                         const std::optional<PlanetMonths>& months) {
  const Grid& grid = state.grid();
  if (grid.topology() != Topology::sphere || !state.has(field::elevation)) return {};
  const Thinning thinning(grid, kMostColumns);
  GlobeLayers layers(state, thinning);
  const MapPage page(grid, MapView());
  const MapFrame frame(page);
  add_layers(state, thinning, frame, layers);
  ordered_json index{
      {"nx", thinning.nx},          {"ny", thinning.ny},    {"radius_m", grid.figure().radius_m},
      {"centre", centre_of(state)}, {"sea", hex(kPaleSea)}, {"land", hex(kPaleLand)}};
  for (int j = 0; j < thinning.ny; ++j) {
    index["latitude"].push_back(grid.latitude_deg(thinning.row(j)));
  }
  for (int i = 0; i < thinning.nx; ++i) {
    index["longitude"].push_back(grid.longitude_deg(thinning.column(i)));
  }
  index["rivers"] = rivers_of(state, frame);
  index["wind"] = winds_of(state);
  index["boundaries"] = boundaries_of(state, frame);
  index["frames"] = add_frames(frames, thinning, layers);
  index["months"] = months && months->cells.size() == thinning.size()
                        ? add_months(*months, state, thinning, layers)
                        : ordered_json::object();
  index["month_names"] = kMonthNames;
  index["layers"] = layers.index;
  return fmt::format(
      "{}{}<script type=\"application/json\" "
      "id=\"globe-index\">{}</script>\n<script>\n{}</script>\n",
      kSection, layers.elements, without_tags(index.dump()), embedded_file("report/globe.js"));
}

}  // namespace geo::io
