#include "geo/core/planet.hpp"

namespace geo {

std::vector<Parameter> Planet::parameters() {
  return {
      real("planet.radius_km", radius_km, "km", 1.0, 1e6, "mean radius of the planet", "iau2015"),
      real("planet.flattening", flattening, "1", 0.0, 0.2,
           "flattening of the ellipsoid; Earth's is 0.0033528", "karney2013"),
      real("planet.gravity_m_s2", gravity_m_s2, "m s-2", 0.01, 100.0, "surface gravity",
           "turcotte2002"),
      real("planet.obliquity_deg", obliquity_deg, "degree", 0.0, 180.0,
           "tilt of the axis, which sets the seasons; beyond 90 the planet turns backwards",
           "berger1978"),
      real("planet.eccentricity", eccentricity, "1", 0.0, 0.9, "eccentricity of the orbit",
           "berger1978"),
      real("planet.perihelion_deg", perihelion_deg, "degree", 0.0, 360.0,
           "solar longitude of the perihelion", "berger1978"),
      real("planet.pressure_bar", pressure_bar, "bar", 0.0, 100.0,
           "surface pressure of the atmosphere", "holton2013"),
      choice("planet.sea_level", sea_level, {"fraction", "volume"},
             "whether the sea covers a share of the area or fills its basins with a volume",
             "cogley1984"),
      real("planet.ocean_fraction", ocean_fraction, "1", 0.0, 1.0,
           "share of the area below sea level", "cogley1984"),
      real("planet.water_volume_km3", water_volume_km3, "km3", 1.0, 1e12,
           "water of the sea, where planet.sea_level is volume", "cogley1984"),
  };
}

}  // namespace geo
