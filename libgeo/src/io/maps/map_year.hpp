#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "geo/io/maps/maps.hpp"
#include "planet_months.hpp"

namespace geo::io {

/// Draws a year as twelve small maps of temperature and twelve of precipitation, in the colours of
/// the annual maps: `year.png` in the folder. `elevation_m` is that of the months' cells; its shore
/// is drawn. Throws IoError.
MapFile draw_year_file(const PlanetMonths& months, std::span<const float> elevation_m,
                       const std::filesystem::path& folder, std::string_view note);

}  // namespace geo::io
