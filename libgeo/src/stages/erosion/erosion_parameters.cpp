#include "geo/stages/erosion/erosion.hpp"

namespace geo {

namespace {

std::vector<Parameter> steps_and_rivers_rows(ErosionParameters& p) {
  return {
      integer("erosion.steps", p.steps, "1", 0, 1'000'000,
              "number of steps; 0 leaves elevation as it is and reports the present incision",
              "design"),
      real("erosion.time_step_yr", p.time_step_yr, "yr", 1.0, 1e9, "length of a step", "braun2013"),
      integer("erosion.route_every", p.route_every, "1", 1, 1000,
              "steps between two routings of the water", "salles2023"),
      real("erosion.area_exponent", p.area_exponent, "1", 0.0, 3.0,
           "exponent m of drainage area in the stream-power law", "whipple1999"),
      real("erosion.slope_exponent", p.slope_exponent, "1", 0.1, 10.0,
           "exponent n of slope in the stream-power law", "whipple1999"),
      real("erosion.erodibility_yr", p.erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility K where no field gives it; in m^(1-2m) yr-1 for another m than 0.5",
           "harel2016"),
      real("erosion.diffusivity_m2_yr", p.diffusivity_m2_yr, "m2 yr-1", 0.0, 1e6,
           "hillslope diffusivity kappa", "salles2023"),
      choice("erosion.model", p.model, {"detachment", "sediment"},
             "what becomes of what rivers take: it is lost, or they deposit it where they "
             "cannot carry it, on plains, in lakes and at sea",
             "davy2009"),
      choice("erosion.discharge", p.discharge, {"rain", "area"},
             "what makes rivers large: the runoff of the climate of the surface as it stands, or "
             "the area that they drain",
             "fekete2002"),
      real("erosion.reference_runoff_mm_yr", p.reference_runoff_mm_yr, "mm yr-1", 1.0, 10000.0,
           "runoff at which the erodibilities hold, with discharge = rain", "fekete2002"),
      real("erosion.least_runoff_mm_yr", p.least_runoff_mm_yr, "mm yr-1", 0.0, 10000.0,
           "runoff of the driest land, which flows in floods", "fekete2002"),
      integer("erosion.climates", p.climates, "1", 1, 1000,
              "times that the climate is computed again while elevation changes, with discharge = "
              "rain",
              "design"),
  };
}

std::vector<Parameter> ice_rows(ErosionParameters& p) {
  return {
      choice("erosion.ice.model", p.ice_model, {"none", "plastic"},
             "whether ice forms where more snow falls than melts, as perfectly plastic ice, and "
             "works on its bed, with discharge = rain",
             "nye1951"),
      real("erosion.ice.stress_kpa", p.ice_stress_kpa, "kPa", 1.0, 1000.0,
           "stress at the base of the ice", "reeh1982"),
      real("erosion.ice.ice_melt_mm_k_d", p.ice_melt_mm_k_d, "mm K-1 day-1", 0.1, 100.0,
           "melt of ice per degree-day above freezing, as water", "braithwaite1995"),
      real("erosion.ice.snow_melt_mm_k_d", p.snow_melt_mm_k_d, "mm K-1 day-1", 0.1, 100.0,
           "melt of snow per degree-day above freezing, as water", "braithwaite1995"),
      real("erosion.ice.glacial_time_yr", p.glacial_time_yr, "yr", 0.0, 1e9,
           "last part of the run in which cold and warm times take turns and ice works on its bed",
           "lisiecki2005"),
      real("erosion.ice.glacial_share", p.glacial_share, "1", 0.0, 1.0,
           "share of the cold times in that", "lisiecki2005"),
      real("erosion.ice.glacial_cooling_k", p.glacial_cooling_k, "K", 0.0, 100.0,
           "by how much the mean of the planet is colder in the cold times than today",
           "tierney2020"),
      integer("erosion.ice.glacial_cycles", p.glacial_cycles, "1", 1, 100,
              "times in all that cold and warm ice are computed again", "design"),
      real("erosion.ice.abrasion", p.abrasion, "1", 0.0, 1.0,
           "lowering of the bed over the way that ice has moved on it", "humphrey1994"),
      real("erosion.ice.overdeepening", p.overdeepening, "1", 0.0, 100.0,
           "steepest climb of a bed over the slope of the ice above", "alley2003"),
      real("erosion.ice.till_share", p.till_share, "1", 0.0, 1.0,
           "share of the debris that stays on land where the ice around it melts", "design"),
      real("erosion.ice.grounding_m", p.grounding_m, "m", 0.0, 5000.0,
           "depth of today's sea in which ice stands in the cold times", "design"),
  };
}

std::vector<Parameter> straits_rows(ErosionParameters& p) {
  return {
      real("erosion.strait_sill_m", p.strait_sill_m, "m", 0.0, 10000.0,
           "highest land over which high stands of the sea join a sea to the ocean of a whole "
           "planet "
           "and cut a strait; 0: seas stay as they are",
           "haq1987"),
      real("erosion.strait_drawdown", p.strait_drawdown, "1", 0.0, 1.0,
           "the same as a share of the depth of the sea, where that is more: rivers that fall into "
           "the "
           "hollow of a sea cut off from the ocean cut back through its rim",
           "loget2006"),
      real("erosion.strait_land_km", p.strait_land_km, "km", 0.0, 1e5,
           "longest way of a strait over land", "design"),
      real("erosion.strait_depth_m", p.strait_depth_m, "m", 0.01, 5000.0, "depth of straits",
           "garciacastellanos2009"),
      real("erosion.strait_width_km", p.strait_width_km, "km", 0.1, 5000.0,
           "width of straits, at least a cell", "design"),
      real("erosion.strait_sea_km2", p.strait_sea_km2, "km2", 0.0, 1e9,
           "area of the smallest sea that is joined to the ocean", "design"),
  };
}

std::vector<Parameter> routing_rows(ErosionParameters& p) {
  return {
      choice("erosion.flow_routing", p.flow_routing, {"d8", "mfd"},
             "whether drainage area follows the steepest descent or spreads over all lower "
             "neighbours; the implicit solve takes the steepest one in both",
             "freeman1991"),
      real("erosion.flow_exponent", p.flow_exponent, "1", 0.0, 20.0,
           "exponent p of slope by which multiple flow is shared", "freeman1991"),
      choice("erosion.depressions", p.depressions, {"fill", "breach"},
             "whether water crosses depressions at their spill level or cuts their sills at once",
             "cordonnier2019"),
  };
}

std::vector<Parameter> uplift_rows(ErosionParameters& p) {
  return {
      real("erosion.uplift_mm_yr", p.uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift of all land, on top of a field of uplift", "design"),
      choice("erosion.uplift_from", p.uplift_from,
             {"shortening", "deformation", "boundaries", "none"},
             "what raises the ground: crust that convergence thickens, at the pace of the plates; "
             "given rates over the belts of deformation, or on the cells of boundaries; or nothing",
             "tectonica2026"),
      real("erosion.convergent_uplift_mm_yr", p.convergent_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates converge, at full strength", "tectonica2026"),
      real("erosion.divergent_uplift_mm_yr", p.divergent_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates part", "tectonica2026"),
      real("erosion.transform_uplift_mm_yr", p.transform_uplift_mm_yr, "mm yr-1", -100.0, 100.0,
           "rock uplift where plates shear", "tectonica2026"),
      real("erosion.uplift_speed_cm_yr", p.uplift_speed_cm_yr, "cm yr-1", 0.0, 50.0,
           "speed of plates (plates.speed_cm_yr) at which these rates hold, in proportion to which "
           "they grow; 0: the same at any speed",
           "tectonica2026"),
  };
}

/// What rock holds against rivers.
std::vector<Parameter> resistance_rows(ErosionParameters& p) {
  return {
      real("erosion.damage", p.damage, "1", 0.0, 1000.0,
           "by how many times more rock is erodible where shortening doubles its thickness",
           "molnar2007"),
      real("erosion.erodibility_factor", p.erodibility_factor, "1", 0.0, 1000.0,
           "factor of the erodibilities that a field gives", "harel2016"),
      real("erosion.reference_cell_km", p.reference_cell_km, "km", 0.01, 1000.0,
           "cell size at which the erodibilities hold", "design"),
      real("erosion.subgrid_exponent", p.subgrid_exponent, "1", 0.0, 2.0,
           "erodibility falls with the cell size to this power, for the local relief that larger "
           "cells do not resolve",
           "hack1957"),
  };
}

std::vector<Parameter> rebound_and_warping_rows(ErosionParameters& p) {
  return {
      real("erosion.rebound_fraction", p.rebound_fraction, "1", 0.0, 1.0,
           "share of the eroded thickness that the crust rises again, density of crust over mantle",
           "turcotte2002"),
      real("erosion.rebound_length_km", p.rebound_length_km, "km", 0.0, 2000.0,
           "length over which the plate's stiffness spreads the rebound", "watts2001"),
      real("erosion.rebound_time_yr", p.rebound_time_yr, "yr", 1.0, 1e9,
           "relaxation time of the mantle", "turcotte2002"),
      real("erosion.warping_m", p.warping_m, "m", 0.0, 5000.0,
           "standard deviation of the latest warping of the land, which rivers have not yet cut "
           "through",
           "turcotte2002"),
      real("erosion.warping_km", p.warping_km, "km", 1.0, 20000.0,
           "longest wavelength of the warping", "turcotte2002"),
  };
}

/// What is done to the surface at the end.
std::vector<Parameter> finish_rows(ErosionParameters& p) {
  return {
      real("erosion.noise_injection_m", p.noise_injection_m, "m", 0.0, 1000.0,
           "noise added to the land after erosion", "tectonica2026"),
      real("erosion.relaxation_fraction", p.relaxation_fraction, "1", 0.0, 1.0,
           "share by which the land returns to its initial, isostatic elevation at the end",
           "tectonica2026"),
      real("erosion.land_smoothing_km", p.land_smoothing_km, "km", 0.0, 1000.0,
           "length over which the land is smoothed after that", "tectonica2026"),
      choice("erosion.hypsometry", p.hypsometry, {"none", "power-law", "blueprint", "rank"},
             "whether the surface keeps its own hypsometric curve, has its land bent to a median "
             "height, is bent once by the blueprint's 4.7 to 4.9, or takes over a given curve by "
             "quantile mapping",
             "tectonica2026"),
      real("erosion.hypsometry_median_m", p.hypsometry_median_m, "m", 1.0, 20000.0,
           "median height of land, with power-law and blueprint", "cogley1984"),
      real("erosion.hypsometry_smoothing_km", p.hypsometry_smoothing_km, "km", 0.0, 1000.0,
           "length over which the bending is smoothed", "tectonica2026"),
      real("erosion.detail_noise", p.detail_noise, "1", 0.0, 100.0,
           "factor of the blueprint's terrain noise", "tectonica2026"),
  };
}

std::vector<Parameter> sediment_rows(ErosionParameters& p) {
  return {
      real("erosion.sediment.deposition", p.deposition, "1", 0.0, 1000.0,
           "deposition G: what rivers deposit, over the mean loss of the land upstream",
           "guerit2019"),
      real("erosion.sediment.dispersal_km", p.dispersal_km, "km", 0.0, 5000.0,
           "length over which the sea spreads what rivers bring", "design"),
      real("erosion.sediment.wave_base_m", p.wave_base_m, "m", 0.0, 1000.0,
           "depth down to which waves let no sediment lie, at the lowest stands of the sea",
           "design"),
      real("erosion.sediment.highstand_yr", p.highstand_yr, "yr", 0.0, 1e9,
           "time for which the sea has stood where it does and rivers have built deltas",
           "stanley1994"),
  };
}

}  // namespace

std::vector<Parameter> ErosionParameters::declarations() {
  return joined(*this, {steps_and_rivers_rows, ice_rows, straits_rows, routing_rows, uplift_rows,
                        resistance_rows, rebound_and_warping_rows, finish_rows, sediment_rows});
}

}  // namespace geo
