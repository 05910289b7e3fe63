#pragma once

#include <cstddef>
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

}  // namespace geo::io
