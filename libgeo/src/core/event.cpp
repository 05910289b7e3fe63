#include "geo/core/event.hpp"

#include <algorithm>

namespace geo {

std::vector<Parameter> Impact::declarations() {
  return {
      real("event.latitude_deg", latitude_deg, "degrees_north", -90.0, 90.0, "where it strikes",
           "design"),
      real("event.longitude_deg", longitude_deg, "degrees_east", -180.0, 360.0, "where it strikes",
           "design"),
      real("event.diameter_km", diameter_km, "km", 0.01, 1000.0, "diameter of the impactor",
           "collins2005"),
      real("event.velocity_km_s", velocity_km_s, "km s-1", 0.1, 100.0, "its velocity at the ground",
           "collins2005"),
      real("event.angle_deg", angle_deg, "degree", 1.0, 90.0,
           "angle of its path with the horizontal", "collins2005"),
      real("event.density_kg_m3", density_kg_m3, "kg m-3", 100.0, 20000.0,
           "density of the impactor: ice 1000, stone 3000, iron 8000", "collins2005"),
      real("event.ground_density_kg_m3", ground_density_kg_m3, "kg m-3", 500.0, 10000.0,
           "density of the ground", "collins2005"),
      real("event.aerosol_share", aerosol_share, "1", 0.0, 10.0,
           "mass of fine particles that stay aloft over the mass of the impactor", "toon1997"),
      real("event.aerosol_lifetime_yr", aerosol_lifetime_yr, "yr", 0.01, 1000.0,
           "time in which they fall to 1/e", "toon1997"),
      real("event.age_yr", age_yr, "yr", 0.0, 1e10,
           "how long ago; half a time step and more: erosion has worked on it since", "design"),
  };
}

std::vector<Parameter> Rift::declarations() {
  return {
      real("event.width_km", width_km, "km", 0.1, 2000.0,
           "width between the crests of its shoulders", "weissel1989"),
      real("event.depth_m", depth_m, "m", 0.0, 10000.0, "depth of its floor below the old ground",
           "weissel1989"),
      real("event.shoulder_m", shoulder_m, "m", 0.0, 10000.0, "uplift of its shoulders",
           "weissel1989"),
      real("event.shoulder_km", shoulder_km, "km", 1.0, 1000.0,
           "flexural parameter of the plate, over which the uplift fades", "turcotte2002"),
      real("event.roughness", roughness, "1", 0.0, 1.0,
           "deviation of its walls and floor from an even trough, as a share of width and depth",
           "design"),
      real("event.age_yr", age_yr, "yr", 0.0, 1e10,
           "how long ago; half a time step and more: erosion has worked on it since", "design"),
  };
}

std::vector<Parameter> OceanShift::declarations() {
  return {
      real("event.rise_m", rise_m, "m", -20000.0, 20000.0, "by how much the sea rises", "design"),
      real("event.water_km3", water_km3, "km3", -1e12, 1e12,
           "water that is added to the sea, in place of rise_m", "design"),
  };
}

namespace {

Parameter time_of(double& time_myr) {
  return real("event.time_myr", time_myr, "Myr", 0.0, 5000.0, "when, since the drift began",
              "cortial2019");
}
Parameter latitude_of(double& latitude_deg, std::string_view doc) {
  return real("event.latitude_deg", latitude_deg, "degrees_north", -90.0, 90.0, doc, "design");
}
Parameter longitude_of(double& longitude_deg, std::string_view doc) {
  return real("event.longitude_deg", longitude_deg, "degrees_east", -180.0, 360.0, doc, "design");
}

}  // namespace

std::vector<Parameter> PlateMotion::declarations() {
  return {
      time_of(time_myr),
      latitude_of(latitude_deg, "a place on the plate at that time"),
      longitude_of(longitude_deg, "a place on the plate at that time"),
      real("event.pole_latitude_deg", pole_latitude_deg, "degrees_north", -90.0, 90.0,
           "Euler pole about which it turns anticlockwise from then on", "cox1986"),
      real("event.pole_longitude_deg", pole_longitude_deg, "degrees_east", -180.0, 360.0,
           "Euler pole about which it turns anticlockwise from then on", "cox1986"),
      real("event.speed_mm_yr", speed_mm_yr, "mm yr-1", 0.0, 1000.0,
           "its speed at the equator of that pole", "cortial2019"),
  };
}

std::vector<Parameter> PlateRift::declarations() {
  return {
      time_of(time_myr),
      latitude_of(latitude_deg, "where the plate breaks"),
      longitude_of(longitude_deg, "where the plate breaks"),
      real("event.bearing_deg", bearing_deg, "degree", -360.0, 360.0,
           "direction of the fracture, clockwise from north", "design"),
      integer("event.fragments", fragments, "1", 2, 4, "number of fragments", "cortial2019"),
      real("event.speed_mm_yr", speed_mm_yr, "mm yr-1", 0.0, 1000.0,
           "speed at which they leave the middle of their plate", "design"),
  };
}

std::vector<Parameter> CrustChange::declarations() {
  return {
      time_of(time_myr),
      latitude_of(latitude_deg, "middle of the circle"),
      longitude_of(longitude_deg, "middle of the circle"),
      real("event.radius_km", radius_km, "km", 1.0, 20000.0, "its radius", "design"),
      flag("event.continental", continental, "whether the crust becomes continental or oceanic",
           "cortial2019"),
  };
}

std::vector<Parameter> PlumeChange::declarations() {
  return {
      time_of(time_myr),
      latitude_of(latitude_deg, "above the plume"),
      longitude_of(longitude_deg, "above the plume"),
      flag("event.active", active,
           "whether a plume begins there, or the one nearest to the place ends", "cortial2019"),
      real("event.growth_mm_yr", growth_mm_yr, "mm yr-1", 0.0, 100.0,
           "growth of volcanoes on the sea floor above it", "cortial2019"),
  };
}

std::vector<Centre>* Event::path() {
  return std::visit(
      [](auto& event) -> std::vector<Centre>* {
        if constexpr (requires { event.path; }) return &event.path;
        return nullptr;
      },
      what);
}

std::string_view Event::kind() const {
  return std::visit([](const auto& event) { return event.kKind; }, what);
}

std::vector<Parameter> Event::declarations() {
  return std::visit([](auto& event) { return event.declarations(); }, what);
}

double figure_of(const EventRecord& record, std::string_view name, double otherwise) {
  const auto found = std::find_if(record.figures.begin(), record.figures.end(),
                                  [&](const auto& figure) { return figure.first == name; });
  return found == record.figures.end() ? otherwise : found->second;
}

}  // namespace geo
