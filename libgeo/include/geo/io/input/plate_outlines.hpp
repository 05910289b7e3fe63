#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "geo/core/initial_conditions.hpp"

namespace geo::io {

// What is told of plates that come as a file.
constexpr std::size_t kMostPlates = 200;
constexpr double kFastestPlate_deg_myr = 100.0;
constexpr double kHighestPlateNumber = 32767.0;

/// Plates of a GeoJSON file (RFC 7946): "earth", sixteen of today's, or a path.
///
/// Each feature is a Polygon or a MultiPolygon of one plate; features of the same name are one.
/// Names are the property `name`, `Name`, `PlateName`, or `Code`; the Euler pole is
/// `pole_latitude_deg`, `pole_longitude_deg` and `rate_deg_myr` (anticlockwise), or `pole_lat`,
/// `pole_lon` and `rate`. A plate without them takes those of PB2002 (Bird 2003, table 1, the
/// Pacific at rest) by its `Code`. Throws InputError that names file, feature and what is wrong;
/// IoError when the file cannot be read.
[[nodiscard]] std::vector<PlateOutline> read_plate_outlines(const std::string& name_or_file);

/// A polygon of GPlates: the outline of crust of a plate where it is today, over the time for which
/// it is there.
struct DatedOutline {
  int plate = 0;      ///< PLATEID1: its number in rotation files
  std::string where;  ///< file, feature and name, for messages
  PlateOutline outline;
  double from_ma = std::numeric_limits<double>::infinity();
  double to_ma = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_valid_at(double time_ma) const;
};

/// Polygons of a GeoJSON file with the attributes that GPlates writes: PLATEID1, and FROMAGE and
/// TOAGE (Ma; 999 and -999, or none: always) and NAME where they are there. One for each feature.
/// Edges are arcs of great circles, as GPlates has them: long ones are divided, every degree. Rings
/// may cross themselves. Throws InputError that names file, feature and what is wrong; IoError when
/// the file cannot be read.
[[nodiscard]] std::vector<DatedOutline> read_dated_outlines(const std::string& file);

}  // namespace geo::io
