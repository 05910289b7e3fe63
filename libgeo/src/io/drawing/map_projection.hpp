#pragma once

#include <optional>
#include <string>

#include "geo/core/grid.hpp"

namespace geo::io {

/// Latitude and longitude of a projected point; nothing where `crs` (WKT, PROJ string or
/// "EPSG:32611") is no projection that PROJ knows.
std::optional<Centre> unproject(const std::string& crs, double x_m, double y_m);

/// Lambert's azimuthal equal-area projection about a centre as WKT (ISO 19162), from PROJ.
std::string equal_area_wkt(Centre centre, const Ellipsoid& figure);

}  // namespace geo::io
