#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "geo/core/grid.hpp"

namespace geo::io {

/// One projection that maps can be drawn in, computed by PROJ on the sphere.
struct MapProjection {
  std::string_view name;        ///< "robinson"
  std::string_view definition;  ///< for PROJ, without centre and radius: "+proj=robin"
  std::string_view doc;
};

/// All of them; the first is the default.
std::span<const MapProjection> map_projections();

/// What of a planet a map shows, and how.
struct MapView {
  // A width alone is the default view of that width.
  MapView(int width = 1800) : width_px(width) {}  // NOLINT(google-explicit-constructor)

  int width_px;                                ///< of the map itself, 300 to 20000
  std::string projection = "equirectangular";  ///< a name of `map_projections()`
  /// Middle of the map. Unset: longitude 0 on the equator, or the middle of `box`. Only azimuthal
  /// projections take a latitude; the polar ones take the longitude that points down (north) or up
  /// (south).
  std::optional<Centre> centre;
  /// Only what lies within; east of 180° where it crosses the date line (170 to 200), at most 360°
  /// wide.
  std::optional<Window> box;

  /// The grid as it lies, whole and uncut.
  [[nodiscard]] bool is_default() const {
    return projection == "equirectangular" && !centre && !box;
  }
};

/// "LAT,LON" in degrees. Throws ConfigurationError that begins with `what`.
Centre parse_centre(std::string_view what, std::string_view text);
/// "W,S,E,N" in degrees; an east edge west of the west edge lies beyond the date line. Throws
/// ConfigurationError that begins with `what`.
Window parse_box(std::string_view what, std::string_view text);
/// "LAT,LON,ANGLE" in degrees as the turn of a grid (`turn_to_pole`); empty turns nothing. Throws
/// ConfigurationError that begins with `what`.
std::array<double, 3> parse_turn(std::string_view what, std::string_view text);
/// Throws ConfigurationError that names the nearest projection where the name is none.
const MapProjection& find_projection(std::string_view name);

}  // namespace geo::io
