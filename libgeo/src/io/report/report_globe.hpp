#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geo/core/state.hpp"
#include "io/maps/planet_months.hpp"

namespace geo::io {

/// Columns of the page's cells at most.
inline constexpr int kMostColumns = 1024;

/// A moment of a planet's past.
struct GlobeFrame {
  double time_myr = 0.0;
  State state;  ///< with crust_elevation or elevation
};

/// A section of the report with a globe that turns under the mouse: heights, and every mapped field
/// of the state as a layer in the colours of its map; rivers, boundaries of plates and winds as
/// lines; `frames` and `months` under sliders. All of it lies in the page. Grids of more than 1024
/// columns are thinned to cells of their own, whose values are the file's to 16 bits of the layer's
/// range. Empty for what is no whole planet with an elevation.
std::string globe_markup(const State& state, const std::vector<GlobeFrame>& frames = {},
                         const std::optional<PlanetMonths>& months = {});

}  // namespace geo::io
