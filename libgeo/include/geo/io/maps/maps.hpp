#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/state.hpp"
#include "geo/io/drawing/map_view.hpp"

namespace geo::io {

/// One picture that was drawn, as a report shows it.
struct MapFile {
  std::filesystem::path path;
  std::string title;    ///< "Annual precipitation"
  std::string caption;  ///< one sentence on what the picture shows and how
  int width_px = 0, height_px = 0;
};

/// What a map shows of an event: a crater's rim about a place, or the line of a rift.
struct EventMark {
  Centre place{};
  double radius_km = 0.0;
  std::vector<Centre> path{};  ///< empty for craters
  std::string name;
};

/// Size of a picture and where the map itself lies in it, pixels from the upper left corner.
struct MapLayout {
  int width_px, height_px;
  int map_left, map_top, map_width, map_height;
};

/// Layout of every map of that grid in that view. By default the whole planet is drawn as plate
/// carrée, 2:1; windows of it as an equirectangular map true to scale along their middle parallel;
/// planes and tori to scale. Maps higher than wide are narrowed so that their height equals the
/// width asked for, which must be 300 to 20000; throws ConfigurationError.
MapLayout map_layout(const Grid& grid, const MapView& view = {});

/// Where a place lies on a map, pixels from the map's upper left corner; nothing where the map does
/// not show it.
std::optional<std::array<double, 2>> position_on_map(const Grid& grid, const MapView& view,
                                                     Centre place);

/// The fields that maps are drawn from, and those of islands.
std::vector<const FieldSpec*> map_fields();
std::vector<const FieldSpec*> island_map_fields();

/// Draws the PNG maps that the fields of a state allow into a folder (created when absent), with
/// title, units, legend and graticule: elevation, plates, crust_age, crust_thickness, rock_type,
/// temperature, precipitation, wind, rivers, biomes, koppen, productivity, settlement. `note` is a
/// short remark for the upper right corner (seed, version). The map of elevation bears the `marks`.
/// Maps are drawn at the same time on as many threads as OpenMP has; the pictures do not depend on
/// how many. Each appears under its name only when it is whole. Throws IoError.
std::vector<MapFile> draw_map_files(const State& state, const std::filesystem::path& folder,
                                    const MapView& view = {}, std::string_view note = {},
                                    std::span<const EventMark> marks = {});

/// Draws an island: `name`.png (shaded relief with contours and rivers), `name`-biomes.png,
/// `name`-koppen.png.
std::vector<MapFile> draw_island_files(const State& state, const std::filesystem::path& folder,
                                       const std::string& name, const MapView& view = {},
                                       std::string_view note = {});

/// The same as `draw_map_files`; returns the paths alone.
std::vector<std::filesystem::path> draw_maps(const State& state,
                                             const std::filesystem::path& folder,
                                             const MapView& view = {}, std::string_view note = {});

/// Draws one field of a state into a PNG file: elevation in hypsometric colours that break at the
/// shore, categories with their names, numbers in a perceptual colour map that follows their
/// spread, all over the coast and the shading of `elevation` where the state has it. Throws Bug
/// when the state lacks the field, IoError.
MapFile draw_field_file(const State& state, const FieldSpec& spec,
                        const std::filesystem::path& file, const MapView& view = {},
                        std::string_view note = {});

/// Area-weighted hypsometric curve of a planet beside Earth's, and the share of the area per 250 m
/// (hypsometry.png). Throws Bug when the state has no elevation, IoError.
MapFile draw_hypsometry_file(const State& state, const std::filesystem::path& folder,
                             std::string_view note = {});
std::filesystem::path draw_hypsometry(const State& state, const std::filesystem::path& folder);

}  // namespace geo::io
