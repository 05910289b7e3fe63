#include "geo/stages/climate/climate.hpp"

namespace geo {
namespace {

/// The model and where it works.
std::vector<Parameter> frame_rows(ClimateParameters& p) {
  return {
      choice("climate.model", p.model, {"energy-balance", "blueprint"},
             "physics of the climate: energy and moisture budgets, or the closed formulas of the "
             "blueprint",
             "design"),
      real("climate.resolution_deg", p.resolution_deg, "degree", 0.5, 10.0,
           "spacing of the grid on which air, heat and moisture move", "design"),
      renamed(real("climate.topography_resolution_km", p.topography_resolution_km, "km", 5.0, 500.0,
                   "spacing of the topography that lifts the air", "design"),
              "climate.relief_resolution_km"),
      real("climate.latitude_deg", p.latitude_deg, "degree", -90.0, 90.0,
           "latitude of the middle of a grid that does not know where it lies", "design"),
      choice("climate.surroundings", p.surroundings, {"edge", "ocean"},
             "what lies around a part of a planet: its own edge for 1000 km, or the sea", "design"),
  };
}

/// Heat of air, ground and sea.
std::vector<Parameter> energy_rows(ClimateParameters& p) {
  EnergyBalance& e = p.seasonal.energy;
  SeasonalClimate& seasonal = p.seasonal;
  return {
      real("climate.solar_constant_w_m2", e.solar_constant_w_m2, "W m-2", 10.0, 10000.0,
           "sunlight at the planet's distance", "berger1978"),
      real("climate.outgoing_w_m2", e.outgoing_w_m2, "W m-2", 0.0, 1000.0,
           "infrared that leaves at 0 degC (A of A + B T), at 1 bar", "north1981"),
      real("climate.outgoing_slope_w_m2_k", e.outgoing_slope_w_m2_k, "W m-2 K-1", 0.5, 6.0,
           "its increase with temperature (B)", "north1981"),
      real("climate.diffusivity_w_m2_k", e.diffusivity_w_m2_k, "W m-2 K-1", 0.01, 5.0,
           "heat diffusion on the unit sphere (D) at 15 degC and 1 bar", "north1975"),
      real("climate.channel_share", e.channel_share, "1", 0.0, 1.0,
           "share of the diffusivity that the sea lacks where no coast bars a current round the "
           "planet",
           "toggweiler2000"),
      real("climate.moist_transport", e.moist_transport, "1", 0.0, 2.0,
           "share of latent heat in the change of D with temperature", "flannery1984"),
      real("climate.advected_heat_j_m2_k", e.advected_heat_j_m2_k, "J m-2 K-1", 0.0, 1e8,
           "heat of the air that winds carry along", "north1983"),
      real("climate.heat_wind_share", e.heat_wind_share, "1", 0.0, 2.0,
           "share of the zonal wind in mid-troposphere that carries heat along", "north1983"),
      real("climate.heat_wave_share", e.heat_wave_share, "1", 0.0, 2.0,
           "share of the winds about warm and cold ground that carries heat along", "lindzen1987"),
      real("climate.coalbedo", e.coalbedo, "1", 0.0, 1.0, "absorbed share of sunlight without ice",
           "north1981"),
      real("climate.coalbedo_p2", e.coalbedo_p2, "1", -0.3, 0.3,
           "its second Legendre coefficient in latitude", "north1981"),
      real("climate.snow_coalbedo", e.snow_coalbedo, "1", 0.0, 1.0,
           "absorbed share of sunlight over snow beneath trees", "betts1997"),
      real("climate.open_snow_coalbedo", e.open_snow_coalbedo, "1", 0.0, 1.0,
           "absorbed share of sunlight over snow that melts in summers too cold for trees",
           "bonan1992"),
      real("climate.tree_temperature_c", e.tree_temperature_c, "degC", -50.0, 50.0,
           "mean of the warmest month at which half the land has trees", "kottek2006"),
      real("climate.snow_temperature_c", e.snow_temperature_c, "degC", -50.0, 10.0,
           "monthly mean at which half the land is under snow", "north1981"),
      real("climate.ice_coalbedo", e.ice_coalbedo, "1", 0.0, 1.0,
           "absorbed share of sunlight over land whose snow stays", "north1981"),
      real("climate.glacier_coalbedo", e.glacier_coalbedo, "1", 0.0, 1.0,
           "absorbed share of sunlight over glaciers and ice sheets that melt in summer",
           "cuffey2010"),
      real("climate.sea_ice_coalbedo", e.sea_ice_coalbedo, "1", 0.0, 1.0,
           "absorbed share of sunlight over sea ice", "north1981"),
      real("climate.ice_temperature_c", e.ice_temperature_c, "degC", -50.0, 10.0,
           "annual mean at which half the sea is ice", "north1981"),
      real("climate.ice_width_k", e.ice_width_k, "K", 0.0, 20.0,
           "width of the transition to snow and ice; 0: none", "north1975"),
      real("climate.land_heat_capacity_w_yr_m2_k", e.land_heat_capacity_w_yr_m2_k, "W yr m-2 K-1",
           0.01, 50.0, "heat that land and the air above it store through the year", "north1983"),
      real("climate.freezing_heat_w_yr_m2", e.freezing_heat_w_yr_m2, "W yr m-2", 0.0, 10.0,
           "heat that water in the ground and snow on it give as they freeze and take as they melt",
           "viterbo1999"),
      real("climate.ocean_heat_capacity_w_yr_m2_k", e.ocean_heat_capacity_w_yr_m2_k, "W yr m-2 K-1",
           0.01, 100.0, "heat that the ocean's mixed layer stores", "north1983"),
      real("climate.sea_exchange_w_m2_k", e.sea_exchange_w_m2_k, "W m-2 K-1", 0.1, 1e4,
           "heat and vapour that pass from sea to air for each kelvin between them, at 15 degC",
           "haney1971"),
      real("climate.sunlit_air_share", e.sunlit_air_share, "1", 0.0, 1.0,
           "share of the absorbed sunlight over the sea that the air absorbs", "peixoto1992"),
      real("climate.ice_heat_capacity_w_yr_m2_k", e.ice_heat_capacity_w_yr_m2_k, "W yr m-2 K-1",
           0.01, 100.0, "heat that sea ice stores", "north1983"),
      real("climate.melt_w_m2_k", e.melt_w_m2_k, "W m-2 K-1", 0.0, 20.0,
           "heat that melting ice takes for each kelvin above -1 degC", "north1983"),
      real("climate.dry_warming_k_m2_w", e.dry_warming_k_m2_w, "K m2 W-1", 0.0, 0.2,
           "by which ground that evaporates nothing is warmer for each W m-2 of sunlight",
           "budyko1974"),
      real("climate.dry_warming_from_w_m2", e.dry_warming_from_w_m2, "W m-2", 0.0, 1000.0,
           "sunlight from which on that counts", "budyko1974"),
      real("climate.inversion_k", e.inversion_k, "K", 0.0, 40.0,
           "by which ground under snow is colder than the air above it in the polar night",
           "connolley1996"),
      real("climate.inversion_growth", e.inversion_growth, "1", 0.0, 2.0,
           "by how much more for each kelvin that the air is colder than -10 degC",
           "connolley1996"),
      real("climate.inversion_below_w_m2", e.inversion_below_w_m2, "W m-2", 1.0, 500.0,
           "sunlight that keeps the air over snow mixed", "connolley1996"),
      real("climate.current_friction_1_s", seasonal.currents.friction_1_s, "s-1", 1e-8, 1e-4,
           "friction of wind-driven currents", "stommel1948"),
      real("climate.current_layer_m", seasonal.currents.layer_m, "m", 10.0, 5000.0,
           "depth of the water that wind-driven currents move", "stommel1948"),
      real("climate.upwelling_w_m2", e.upwelling_w_m2, "W m-2", 0.0, 500.0,
           "heat that water takes which wells up at the equator off an eastern coast",
           "wyrtki1981"),
      real("climate.upwelling_reach_km", e.upwelling_reach_km, "km", 50.0, 20000.0,
           "distance from that coast over which upwelling falls by e", "wyrtki1981"),
      real("climate.gyre_heat_w_m2", e.gyre_heat_w_m2, "W m-2", 0.0, 500.0,
           "heat that ocean gyres release along a western coast of a sea", "stommel1948"),
      real("climate.gyre_reach_km", e.gyre_reach_km, "km", 50.0, 10000.0,
           "e-folding distance of a coast's influence on gyres", "stommel1948"),
      real("climate.subpolar_heat_w_m2", e.subpolar_heat_w_m2, "W m-2", 0.0, 500.0,
           "heat that subpolar gyres, beyond 45 deg, release along an eastern coast of a sea",
           "stommel1948"),
      real("climate.subpolar_reach_km", e.subpolar_reach_km, "km", 50.0, 10000.0,
           "e-folding distance of a coast's influence on subpolar gyres", "stommel1948"),
      real("climate.heat_blocking_height_m", e.blocking_height_m, "m", 100.0, 1e6,
           "mean height of topography that halves the heat passing over it", "manabe1974"),
      real("climate.lapse_k_m", e.lapse_k_m, "K m-1", 0.0, 0.02, "fall of temperature with height",
           "holton2013"),
  };
}

/// Pressure and winds.
std::vector<Parameter> wind_rows(ClimateParameters& p) {
  Circulation& c = p.seasonal.circulation;
  SeasonalClimate& seasonal = p.seasonal;
  return {
      real("climate.rotation_period_h", c.rotation_period_h, "h", 1.0, 10000.0,
           "sidereal day of the planet", "holton2013"),
      flag("climate.retrograde", c.retrograde, "whether the planet turns from east to west",
           "holton2013"),
      real("climate.air_density_kg_m3", c.air_density_kg_m3, "kg m-3", 0.001, 100.0,
           "density of air at sea level", "holton2013"),
      real("climate.drag_ocean_s", c.drag_ocean_s, "s-1", 1e-6, 1e-3,
           "linear drag on the air over the sea", "lindzen1987"),
      real("climate.drag_land_s", c.drag_land_s, "s-1", 1e-6, 1e-3, "linear drag over land",
           "lindzen1987"),
      real("climate.subtropical_high_hpa", c.subtropical_high_hpa, "hPa", 0.0, 50.0,
           "rise of pressure from the equatorial trough to 30 deg", "peixoto1992"),
      real("climate.subpolar_low_hpa", c.subpolar_low_hpa, "hPa", 0.0, 80.0,
           "fall of pressure from 30 to 60 deg", "peixoto1992"),
      real("climate.polar_high_hpa", c.polar_high_hpa, "hPa", 0.0, 50.0,
           "rise of pressure from 60 deg to the pole", "peixoto1992"),
      real("climate.thermal_low_hpa_k", c.thermal_low_hpa_k, "hPa K-1", 0.0, 5.0,
           "fall of pressure per kelvin of heat anomaly", "lindzen1987"),
      real("climate.cold_high_share", c.cold_high_share, "1", 0.0, 2.0,
           "share of it where the anomaly is cold, and shallow", "lindzen1987"),
      real("climate.itcz_share", seasonal.itcz_share, "1", 0.0, 2.0,
           "share of the thermal equator's excursion that the tropical cells follow",
           "peixoto1992"),
      real("climate.displacement_decay", c.displacement_decay, "1", 1.0, 6.0,
           "exponent by which the cells' displacement with the thermal equator falls off towards "
           "the poles",
           "peixoto1992"),
      real("climate.itcz_lag_month", seasonal.itcz_lag_month, "month", 0.0, 1.0,
           "time, in twelfths of a year, by which the trough follows the temperature of the air, "
           "as the sea does",
           "peixoto1992"),
      real("climate.heat_low_lag_month", seasonal.heat_low_lag_month, "month", 0.0, 1.0,
           "time, in twelfths of a year, by which heat lows and cold highs follow the ground's "
           "temperature, as the troposphere does",
           "lindzen1987"),
      real("climate.itcz_locality", seasonal.itcz_locality, "1", 0.0, 1.0,
           "how far the trough follows the warmest latitude of each meridian, not of all",
           "peixoto1992"),
  };
}

/// Waves that heating and mountains set up.
std::vector<Parameter> wave_rows(ClimateParameters& p) {
  StationaryWave& w = p.seasonal.wave;
  SeasonalClimate& seasonal = p.seasonal;
  return {
      real("climate.wave_speed_m_s", w.internal.speed_m_s, "m s-1", 5.0, 200.0,
           "speed of the troposphere's first baroclinic mode", "gill1980"),
      real("climate.wave_momentum_damping_d", w.internal.momentum_damping_d, "day", 0.1, 100.0,
           "time in which drag stops the winds of waves that heating sets up", "gill1980"),
      real("climate.wave_thermal_damping_d", w.internal.thermal_damping_d, "day", 0.1, 100.0,
           "time in which such waves lose their heat", "gill1980"),
      real("climate.wave_wind_share", w.internal.wind_share, "1", 0.0, 2.0,
           "share of the zonal wind in mid-troposphere that carries such waves along",
           "hoskins1981"),
      real("climate.wave_heating_m4_s3_w", w.heating_m4_s3_w, "m4 s-3 W-1", 0.0, 1e-3,
           "fall of the geopotential near the ground by 1 W m-2 of heating", "gill1980"),
      real("climate.mountain_wave_damping_d", w.external.momentum_damping_d, "day", 0.1, 100.0,
           "time in which drag stops the winds of waves that mountains set up", "held1983"),
      real("climate.mountain_wave_wind_share", w.external.wind_share, "1", 0.0, 2.0,
           "share of the zonal wind in mid-troposphere that carries such waves along", "held1983"),
      real("climate.mountain_share", w.mountain_share, "1", 0.0, 1.0,
           "share of the height of mountains that the flow goes over", "held1983"),
      real("climate.wave_smoothing_km", w.smoothing_km, "km", 0.0, 5000.0,
           "wavelength over 2 pi at which half of the heating is smoothed away", "design"),
      real("climate.sensible_w_m2_k", seasonal.sensible_w_m2_k, "W m-2 K-1", 0.0, 50.0,
           "heating of the air over land per kelvin that it is warmer than its parallel",
           "rodwell2001"),
  };
}

/// Evaporation, transport and rain.
std::vector<Parameter> moisture_rows(ClimateParameters& p) {
  MoistureBudget& m = p.seasonal.moisture;
  SeasonalClimate& seasonal = p.seasonal;
  SoilMoisture& soil = p.seasonal.soil;
  return {
      real("climate.rain_time_d", m.rain_time_d, "day", 0.1, 50.0,
           "rain-out time of a saturated column of air", "bretherton2004"),
      integer("climate.humidity_exponent", m.humidity_exponent, "1", 0, 12,
              "how sharply rain follows the relative humidity of the column", "bretherton2004"),
      real("climate.evaporation_velocity_1_d", m.evaporation_velocity_1_d, "day-1", 0.0, 5.0,
           "share of a column's deficit that open water makes up in a day, under a wind of 8 m/s",
           "peixoto1992"),
      real("climate.evaporating_share", m.evaporating_share, "1", 0.01, 2.0,
           "most that the sea evaporates, as a share of the annual insolation", "peixoto1992"),
      real("climate.base_diffusivity_m2_s", seasonal.base_diffusivity_m2_s, "m2 s-1", 0.0, 1e8,
           "mixing of moisture without eddies", "north1975"),
      real("climate.eddy_diffusivity_m2_s", seasonal.eddy_diffusivity_m2_s, "m2 s-1", 0.0, 1e8,
           "mixing of moisture by eddies at the reference gradient of temperature", "north1975"),
      real("climate.eddy_rain", seasonal.eddy_rain, "1", 0.0, 20.0,
           "rain-out by eddies at the reference gradient, whether the mean air rises or sinks",
           "peixoto1992"),
      real("climate.eddy_gradient_k_1000km", seasonal.eddy_gradient_k_1000km, "K Mm-1", 0.1, 100.0,
           "reference gradient of zonal-mean temperature", "peixoto1992"),
      real("climate.eddy_exponent", seasonal.eddy_exponent, "1", 1.0, 4.0,
           "by which eddies grow with the temperature gradient", "held1999"),
      real("climate.eddy_locality", seasonal.eddy_locality, "1", 0.0, 1.0,
           "how far eddies follow the local gradient of temperature, not the parallel's",
           "hoskins1990"),
      real("climate.gust_m_s", seasonal.gust_m_s, "m s-1", 0.0, 30.0,
           "winds of eddies over the sea at the reference gradient of temperature", "fairall2003"),
      real(
          "climate.cold_air_heat_j_m2_k", seasonal.cold_air_heat_j_m2_k, "J m-2 K-1", 0.0, 1e7,
          "heat capacity of the air that water warms by evaporation where winds come from the cold",
          "fairall2003"),
      real("climate.ascent_time_d", seasonal.ascent_time_d, "day", 0.0, 30.0,
           "time over which converging winds multiply rain-out by e (diverging ones divide it)",
           "held1980"),
      real("climate.descent_time_d", seasonal.descent_time_d, "day", 0.0, 60.0,
           "the same for air that stationary waves let sink", "rodwell2001"),
      real("climate.ascent_bound", seasonal.ascent_bound, "1", 0.1, 5.0,
           "most by which ascent raises the logarithm of rain-out", "design"),
      real("climate.descent_bound", seasonal.descent_bound, "1", 0.1, 8.0,
           "most by which descent lowers the logarithm of rain-out", "design"),
      real("climate.eddy_descent_share", seasonal.eddy_descent_share, "1", 0.0, 1.0,
           "share of that descent which the rain of eddies feels", "design"),
      real("climate.ascent_latitude_deg", seasonal.ascent_latitude_deg, "degree", 5.0, 90.0,
           "latitude at which converging winds make half as much rain as where rotation is weak",
           "neelin2000"),
      real("climate.ascent_smoothing_km", seasonal.ascent_smoothing_km, "km", 0.0, 3000.0,
           "distance over which ascent and descent are felt", "design"),
      real("climate.convection_1_k", seasonal.convection_1_k, "K-1", 0.0, 1.0,
           "growth of rain-out with the moist static energy near the ground over the tropics' mean",
           "neelin2000"),
      real("climate.convection_latitude_deg", seasonal.convection_latitude_deg, "degree", 5.0, 90.0,
           "latitude within which the free atmosphere is level", "neelin2000"),
      real("climate.soil_capacity_mm", soil.capacity_mm, "mm", 1.0, 2000.0,
           "water that soil holds for plants", "manabe1969"),
      real("climate.soil_stressed_share", soil.stressed_share, "1", 0.05, 1.0,
           "share of it below which plants evaporate less", "manabe1969"),
      real("climate.orographic_share", seasonal.orographic_share, "1", 0.0, 1.0,
           "share of the mean height of a coarse cell by which moist air is lifted", "roe2005"),
      real("climate.blocking_height_m", seasonal.blocking_height_m, "m", 100.0, 1e6,
           "mean height at which topography halves the moist flow", "roe2005"),
      real("climate.land_transpiration", seasonal.land_transpiration, "1", 0.0, 1.0,
           "share of the soil's evaporation that returns to the air", "manabe1969"),
      real("climate.lift_reach_km", p.lift_reach_km, "km", 1.0, 1000.0,
           "e-folding distance over which air remembers the topography that it crossed",
           "smith1979"),
      real("climate.lift_height_m", p.lift_height_m, "m", 100.0, 1e6,
           "lift that multiplies rain by e (and descent that divides it)", "roe2005"),
  };
}

/// Noise on annual means.
std::vector<Parameter> noise_rows(ClimateParameters& p) {
  return {
      real("climate.temperature_noise_k", p.temperature_noise_k, "K", 0.0, 20.0,
           "amplitude of coherent noise in temperature", "tectonica2026"),
      real("climate.precipitation_noise_mm_yr", p.precipitation_noise_mm_yr, "mm yr-1", 0.0, 1000.0,
           "amplitude of coherent noise in precipitation", "tectonica2026"),
      real("climate.noise_wavelength_km", p.noise_wavelength_km, "km", 10.0, 20000.0,
           "longest wavelength of that noise", "tectonica2026"),
  };
}

/// The closed formulas, by the numbers of their equations.
std::vector<Parameter> blueprint_rows(ClimateParameters& p) {
  BlueprintClimate& b = p.blueprint;
  return {
      real("climate.greenhouse_k", b.greenhouse_k, "K", 0.0, 100.0,
           "warming by air: greenhouse ln(1 + pressure in bar); energy-balance counts from 1 bar",
           "tectonica2026"),
      real("climate.wind_speed_m_s", p.wind_speed_m_s, "m s-1", 0.0, 100.0,
           "speed of the blueprint's zonal winds", "peixoto1992"),
      real("climate.equator_c", b.equator_c, "degC", -100.0, 100.0,
           "blueprint: sea-level temperature at the equator (5.1)", "tectonica2026"),
      real("climate.cooling_c_deg2", b.cooling_c_deg2, "K degree-2", 0.0, 0.05,
           "blueprint: its fall with the square of latitude (5.1)", "tectonica2026"),
      real("climate.lapse_rate_k_km", b.lapse_k_km, "K km-1", 0.0, 20.0,
           "blueprint: fall of temperature with height (5.2)", "tectonica2026"),
      real("climate.ocean_warming_k", b.ocean_warming_k, "K", -20.0, 20.0,
           "blueprint: warming at sea (5.3)", "tectonica2026"),
      real("climate.continental_k_km", b.continental_k_km, "K km-1", 0.0, 0.1,
           "blueprint: cooling inland, times the sine of latitude (5.3a)", "tectonica2026"),
      real("climate.windward_mm_yr", b.windward_mm_yr, "mm yr-1", 0.0, 10000.0,
           "blueprint: rain from the sea upwind (5.5)", "tectonica2026"),
      real("climate.windward_decay_km", b.windward_decay_km, "km", 1.0, 100000.0,
           "blueprint: land over which it falls by e (5.5)", "tectonica2026"),
      real("climate.windward_trace_km", b.windward_trace_km, "km", 40.0, 10000.0,
           "blueprint: how far upwind it looks (5.5)", "tectonica2026"),
      real("climate.coastal_mm_yr", b.coastal_mm_yr, "mm yr-1", 0.0, 10000.0,
           "blueprint: rain of a place surrounded by sea (5.6)", "tectonica2026"),
      real("climate.coastal_reach_km", b.coastal_reach_km, "km", 1.0, 1000.0,
           "blueprint: radius within which the sea counts (5.6)", "tectonica2026"),
      real("climate.lift_mm_yr_m", b.lift_mm_yr_m, "mm yr-1 m-1", 0.0, 10.0,
           "blueprint: rain per metre of rise along the wind (5.7)", "tectonica2026"),
      real("climate.lift_step_km", b.lift_step_km, "km", 1.0, 500.0,
           "blueprint: distance over which that rise counts (5.7)", "tectonica2026"),
      real("climate.shadow_mm_yr_m", b.shadow_mm_yr_m, "mm yr-1 m-1", 0.0, 10.0,
           "blueprint: rain lost per metre that the ground upwind stands higher (5.8)",
           "tectonica2026"),
      real("climate.shadow_decay_km", b.shadow_decay_km, "km", 1.0, 10000.0,
           "blueprint: e-folding distance of the rain shadow (5.8)", "tectonica2026"),
      real("climate.shadow_trace_km", b.shadow_trace_km, "km", 20.0, 10000.0,
           "blueprint: length of the rain shadow (5.8)", "tectonica2026"),
      real("climate.altitude_decay_1_m", b.altitude_decay_1_m, "m-1", 0.0, 0.01,
           "blueprint: fall of rain with altitude (5.9)", "tectonica2026"),
      real("climate.continental_decay_km", b.continental_decay_km, "km", 1.0, 100000.0,
           "blueprint: e-folding distance of rain from the coast (5.10a)", "tectonica2026"),
      real("climate.ocean_factor", b.ocean_factor, "1", 0.0, 10.0,
           "blueprint: rain at sea over the zonal base", "tectonica2026"),
      real("climate.aerosol_mm_yr", b.aerosol_mm_yr, "mm yr-1", 0.0, 10000.0,
           "blueprint: rain on land lost per unit of aerosol, the optical depth of the dust of "
           "impacts (5.10)",
           "tectonica2026"),
  };
}

}  // namespace

std::vector<Parameter> ClimateParameters::declarations() {
  return joined(*this, {frame_rows, energy_rows, wind_rows, wave_rows, moisture_rows, noise_rows,
                        blueprint_rows});
}

}  // namespace geo
