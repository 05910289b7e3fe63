#include "climate_events.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "geo/kernels/climate/aerosol.hpp"

namespace geo {
namespace {

/// Dimmed sunlight cools the sea to this heat capacity: 100 m of water, W yr m-2 K-1.
constexpr double kStirredSea_w_yr_m2_k = 13.0;

AerosolVeil veil_of(const Impact& impact, const EnergyBalance& model, const Planet& planet) {
  const double diameter_m = 1e3 * impact.diameter_km, radius_m = 1e3 * planet.radius_km;
  const double volume_m3 = std::numbers::pi / 6.0 * std::pow(diameter_m, 3);
  const double sea = planet.ocean_fraction;
  return {.mass_kg = impact.aerosol_share * impact.density_kg_m3 * volume_m3,
          .lifetime_yr = impact.aerosol_lifetime_yr,
          .planet_area_m2 = 4.0 * std::numbers::pi * radius_m * radius_m,
          .absorbed_w_m2 = 0.25 * model.solar_constant_w_m2 * model.coalbedo,
          .feedback_w_m2_k = model.outgoing_slope_w_m2_k,
          .heat_capacity_w_yr_m2_k =
              sea * kStirredSea_w_yr_m2_k + (1.0 - sea) * model.land_heat_capacity_w_yr_m2_k};
}

/// What is left of a veil's optical depth after the age of its impact.
double optical_depth_left(const AerosolVeil& veil, double age_yr) {
  return aerosol_optical_depth(veil) * std::exp(-age_yr / veil.lifetime_yr);
}

}  // namespace

DimmedSun dim_the_sun(const EnergyBalance& model, const BlueprintClimate* closed,
                      Context& context) {
  DimmedSun dimmed;
  for (std::size_t i = 0; i < context.events.size(); ++i) {
    const Event& event = context.events[i];
    const auto* impact = std::get_if<Impact>(&event.what);
    if (impact == nullptr) continue;
    const AerosolVeil veil = veil_of(*impact, model, context.planet);
    const double cooling_k = aerosol_cooling_k(veil, impact->age_yr);
    const double depth_left = optical_depth_left(veil, impact->age_yr);
    dimmed.cooling_k += cooling_k;
    dimmed.aerosol += depth_left;
    const auto rain = closed == nullptr
                          ? std::pair("rain_left", precipitation_left(cooling_k))
                          : std::pair("rain_lost_mm_yr", closed->aerosol_mm_yr * depth_left);
    context.event_records.push_back({.number = static_cast<int>(i) + 1,
                                     .kind = std::string(event.kind()),
                                     .name = event.name,
                                     .figures = {{"age_yr", impact->age_yr},
                                                 {"optical_depth", aerosol_optical_depth(veil)},
                                                 {"cooling_k", cooling_k},
                                                 {rain.first, rain.second}}});
  }
  dimmed.rain_left = precipitation_left(dimmed.cooling_k);
  return dimmed;
}

double aerosol_of(std::span<const Event> events, const Planet& planet) {
  double sum = 0.0;
  for (const Event& event : events) {
    if (const auto* impact = std::get_if<Impact>(&event.what)) {
      sum += optical_depth_left(veil_of(*impact, {}, planet), impact->age_yr);
    }
  }
  return sum;
}

}  // namespace geo
