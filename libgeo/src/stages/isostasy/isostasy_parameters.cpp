#include "geo/stages/isostasy/isostasy.hpp"

namespace geo {

namespace {

std::vector<Parameter> crust_and_plate_rows(IsostasyParameters& p) {
  return {
      choice("isostasy.crust", p.crust, {"margins", "blueprint", "simulated", "given"},
             "crust from cross sections of margins and belts, by the formulas of the Tectonica "
             "blueprint, as the plates' history has made it (plates.model = sphere) with what is "
             "finer on top, or as plates gave it to the last metre",
             "tectonica2026"),
      choice("isostasy.compensation", p.compensation, {"flexural", "airy", "airy-dry"},
             "what carries topography: an elastic plate, every column by itself with the sea as a "
             "load, or every column by itself without",
             "turcotte2002"),
      real("isostasy.mantle_density_kg_m3", p.density.mantle, "kg m-3", 1000.0, 10000.0,
           "density of the mantle", "turcotte2002"),
      real("isostasy.continental_density_kg_m3", p.density.continental_crust, "kg m-3", 1000.0,
           10000.0, "density of continental crust", "turcotte2002"),
      real("isostasy.oceanic_density_kg_m3", p.density.oceanic_crust, "kg m-3", 1000.0, 10000.0,
           "density of oceanic crust", "turcotte2002"),
      real("isostasy.water_density_kg_m3", p.density.water, "kg m-3", 0.0, 5000.0,
           "density of sea water", "turcotte2002"),
      real("isostasy.sediment_density_kg_m3", p.density.sediment, "kg m-3", 500.0, 5000.0,
           "density of sediment", "watts2001"),
      real("isostasy.elastic_thickness_km", p.elastic_thickness_km, "km", 0.0, 200.0,
           "elastic thickness of the lithosphere", "watts2001"),
  };
}

/// How boundaries deform the crust.
std::vector<Parameter> belts_rows(IsostasyParameters& p) {
  return {
      real("isostasy.convergent_length_km", p.convergent_length_km, "km", 1.0, 5000.0,
           "length over which convergence deforms the crust", "england1982"),
      real("isostasy.divergent_length_km", p.divergent_length_km, "km", 1.0, 5000.0,
           "length over which divergence deforms the crust", "tectonica2026"),
      real("isostasy.transform_length_km", p.transform_length_km, "km", 1.0, 5000.0,
           "length over which shear deforms the crust", "tectonica2026"),
      real("isostasy.weakness_length_km", p.weakness_length_km, "km", 1.0, 5000.0,
           "length over which the lithosphere grows strong away from plate boundaries",
           "artemieva2001"),
      real("isostasy.deformation_smoothing_km", p.deformation_smoothing_km, "km", 0.0, 1000.0,
           "length over which deformation is smoothed", "tectonica2026"),
  };
}

std::vector<Parameter> thicknesses_rows(IsostasyParameters& p) {
  return {
      real("isostasy.continental_km", p.continental_km, "km", 5.0, 80.0,
           "thickness of undisturbed continental crust", "laske2013"),
      real("isostasy.ocean_depth_m", p.ocean_depth_m, "m", 0.0, 20000.0,
           "mean depth of a sea given by its share, to which continental crust thickens or thins; "
           "0: it is as thick as continental_km says, or, simulated, settles about a floor as deep "
           "as "
           "its age",
           "wise1974"),
      real("isostasy.oceanic_km", p.oceanic_km, "km", 1.0, 30.0, "thickness of oceanic crust",
           "white1992"),
      real("isostasy.thickness_noise_km", p.thickness_noise_km, "km", 0.0, 50.0,
           "variation of continental thickness: standard deviation, or half of the blueprint's "
           "larger amplitude's range",
           "laske2013"),
      real("isostasy.collision_km", p.collision_km, "km", 0.0, 80.0,
           "thickening where continents meet or override an ocean", "christensen1995"),
      real("isostasy.collision_shortening", p.collision_shortening, "1", 0.0, 1.0,
           "share of the convergence of continents that thickens their crust", "england1982"),
      real("isostasy.subduction_shortening", p.subduction_shortening, "1", 0.0, 1.0,
           "share of convergence that thickens a continent above an ocean", "oncken2006"),
      real("isostasy.front_shortening", p.front_shortening, "1", 0.0, 1.0,
           "share of that thickening in the range behind the deformation front", "dahlen1990"),
      real("isostasy.arc_km", p.arc_km, "km", 0.0, 80.0, "thickening of oceanic crust in arcs",
           "christensen1995"),
      real("isostasy.rift_km", p.rift_km, "km", 0.0, 80.0, "thinning at divergent boundaries",
           "tectonica2026"),
      real("isostasy.transpression_km", p.transpression_km, "km", 0.0, 80.0,
           "thickening at transform boundaries", "tectonica2026"),
      real("isostasy.crust_smoothing_km", p.crust_smoothing_km, "km", 0.0, 1000.0,
           "length of the blueprint's smoothing of thickness", "tectonica2026"),
      real("isostasy.coast_smoothing_km", p.coast_smoothing_km, "km", 0.0, 1000.0,
           "length of the blueprint's smoothing of continental fraction", "tectonica2026"),
  };
}

/// What holds the surface up or down from below.
std::vector<Parameter> mantle_rows(IsostasyParameters& p) {
  return {
      real("isostasy.lithosphere", p.lithosphere, "1", 0.0, 3.0,
           "weight of the continents' mantle lithosphere, 1 that of old ocean floor", "stein1992"),
      real("isostasy.craton_compensation", p.craton_compensation, "1", 0.0, 1.0,
           "share of the buoyancy of thick crust that a thick lithosphere takes away in cratons",
           "artemieva2001"),
      real("isostasy.swell_m", p.swell_m, "m", 0.0, 5000.0,
           "standard deviation of broad swells and basins of continents", "turcotte2002"),
      real("isostasy.ocean_swell_m", p.ocean_swell_m, "m", 0.0, 5000.0,
           "standard deviation of broad swells and basins of the sea floor", "turcotte2002"),
      real("isostasy.margin_tilt_m", p.margin_tilt_m, "m", 0.0, 5000.0,
           "how much lower continents stand at their edge than inland", "watts2001"),
      real("isostasy.margin_tilt_km", p.margin_tilt_km, "km", 1.0, 5000.0,
           "length over which they rise inland", "watts2001"),
      real("isostasy.relict_km", p.relict_km, "km", 0.0, 40.0, "thickening left in old orogens",
           "christensen1995"),
      real("isostasy.heat_m", p.heat_m, "m", 0.0, 10000.0,
           "rise of the surface above the hottest mantle", "turcotte2002"),
      real("isostasy.thermal_coefficient", p.thermal_coefficient, "1", 0.0, 0.2,
           "loss of crustal density above the hottest mantle, blueprint crust alone",
           "tectonica2026"),
  };
}

std::vector<Parameter> sea_floor_rows(IsostasyParameters& p) {
  return {
      real("isostasy.shelf_depth_m", p.shelf_depth_m, "m", 0.0, 2000.0,
           "depth that scales shelves: D below the sea, sediment leaves d ln(1 + D / d)",
           "watts2001"),
      real("isostasy.shelf_edge", p.shelf_edge, "1", 0.0, 0.99,
           "share of continental crust in a column from which on shelves are built", "watts2001"),
      real("isostasy.trench_depth_m", p.trench_depth_m, "m", 0.0, 15000.0,
           "depth of the deepest trenches below the floor, before their flanks are smoothed, where "
           "plates made the crust (crust = simulated)",
           "turcotte2002"),
      real("isostasy.slab_trench_m", p.slab_trench_m, "m", 0.0, 15000.0,
           "depth of a trench below the floor where floor of 100 Myr subducts at 100 mm/yr, crust "
           "= margins",
           "hilde1983"),
      real("isostasy.seamount_m", p.seamount_m, "m", 0.0, 10000.0,
           "height of the largest seamounts; volcanoes of a margins crust have their own at 1800",
           "turcotte2002"),
      real("isostasy.seafloor_roughness_m", p.seafloor_roughness_m, "m", 0.0, 5000.0,
           "standard deviation of the hills of young sea floor", "huang1989"),
      real("isostasy.fracture_m", p.fracture_m, "m", 0.0, 5000.0,
           "standard deviation of depth across fracture zones on new sea floor; 0 draws none",
           "cortial2019"),
      real("isostasy.fracture_spacing_km", p.fracture_spacing_km, "km", 5.0, 1000.0,
           "distance between fracture zones along a ridge", "cortial2019"),
      real("isostasy.abyssal_hills_m", p.abyssal_hills_m, "m", 0.0, 5000.0,
           "standard deviation of the hills along the ridges that made the floor; 0 draws none",
           "cortial2019"),
      real("isostasy.fabric_age_myr", p.fabric_age_myr, "Myr", 1.0, 1000.0,
           "age over which fracture zones and these hills fade", "cortial2019"),
  };
}

std::vector<Parameter> land_rows(IsostasyParameters& p) {
  return {
      real("isostasy.land_roughness_m", p.land_roughness_m, "m", 0.0, 5000.0,
           "standard deviation of the noise on which drainage first forms", "huang1989"),
      renamed(
          real("isostasy.noise_factor", p.noise_factor, "1", 0.0, 100.0,
               "factor of the blueprint's noise overlay, blueprint crust alone", "tectonica2026"),
          "isostasy.noise_m"),
      choice("isostasy.detail", p.detail, {"noise", "exemplars"},
             "terrain of continents at wavelengths shorter than those of the plates: noise, or "
             "terrain like exemplars (fields.exemplars), aligned with the folds",
             "cortial2019"),
      real("isostasy.detail_longest_km", p.detail_longest_km, "km", 10.0, 1000.0,
           "longest waves of detail made of exemplars; longer ones are the plates' work", "design"),
      real("isostasy.detail_amplitude", p.detail_amplitude, "1", 0.0, 10.0,
           "height of that detail over the noise that it replaces; it is higher where longer waves "
           "around lead to expect it",
           "huang1989"),
      real("isostasy.old_orogeny_myr", p.old_orogeny_myr, "Myr", 0.0, 5000.0,
           "age from which orogens are made like old mountains", "cortial2019"),
      real("isostasy.plain_slope", p.plain_slope, "1", 0.0, 1.0,
           "slope of the longer wavelengths below which terrain is a plain", "design"),
  };
}

std::vector<Parameter> sediment_rows(IsostasyParameters& p) {
  return {
      real("isostasy.basin_fill", p.basin_fill, "1", 0.0, 0.95,
           "share of the subsidence of continental margins and sags that sediment has filled; 0: "
           "continents are bare",
           "laske2013"),
      real("isostasy.pelagic_m", p.sediment.early_m, "m", 0.0, 10000.0,
           "what soon covers new sea floor: 0.38 of it sediment, the rest plateaus and swells",
           "muller2008"),
      real("isostasy.pelagic_rate_m_myr", p.sediment.rate_m_myr, "m Myr-1", 0.0, 1000.0,
           "rate at which that grows with the age of the floor", "muller2008"),
      real("isostasy.apron_m", p.sediment.apron_m, "m", 0.0, 20000.0,
           "thickness of sediment at the foot of continents", "watts2001"),
      real("isostasy.apron_length_km", p.sediment.apron_length_km, "km", 1.0, 5000.0,
           "length over which that apron thins out", "watts2001"),
  };
}

}  // namespace

std::vector<Parameter> IsostasyParameters::declarations() {
  return joined(*this, {crust_and_plate_rows, belts_rows, thicknesses_rows, mantle_rows,
                        sea_floor_rows, land_rows, sediment_rows});
}

}  // namespace geo
