#pragma once

#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/parameter.hpp"

namespace geo {

/// The planet as a body: what every stage may need to know.
struct Planet {
  double radius_km = 6371.0;
  double flattening = 0.0;
  double gravity_m_s2 = 9.81;
  double obliquity_deg = 23.44;
  double eccentricity = 0.0167;
  double perihelion_deg = 282.9;
  double pressure_bar = 1.0;
  std::string sea_level = "fraction";
  double ocean_fraction = 0.71;
  double water_volume_km3 = 1.334e9;

  [[nodiscard]] Ellipsoid figure() const { return {radius_km * 1000.0, flattening}; }
  /// Declarations of the members above, section "planet".
  [[nodiscard]] std::vector<Parameter> parameters();
};

}  // namespace geo
