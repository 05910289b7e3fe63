#pragma once

#include <string>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

// What the history of a planet begins with where somebody gives it.

/// A plate as it is drawn on a map.
struct PlateOutline {
  std::string name;
  /// Closed lines; a place within an odd number of them is on the plate, so that a hole is one more
  /// ring. Their edges are straight in latitude and longitude.
  std::vector<std::vector<Centre>> rings;
  Centre pole;                ///< Euler pole, about which it turns anticlockwise
  double rate_deg_myr = 0.0;  ///< how fast
};

/// The elevation of a whole planet.
struct GivenElevation {
  Grid grid;
  std::vector<float> elevation_m;  ///< of its cells, sea level at 0
  std::vector<float> age_myr;  ///< of the sea floor, NaN where unknown; empty: told by its depth
};

}  // namespace geo
