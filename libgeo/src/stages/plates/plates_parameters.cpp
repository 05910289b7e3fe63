#include <algorithm>
#include <array>
#include <vector>

#include "geo/stages/plates/plates.hpp"
#include "hypsography.hpp"
#include "stages/plates/raster/raster.hpp"

namespace geo {
namespace {

/// What all models share.
std::vector<Parameter> shared_rows(PlatesParameters& p) {
  return {
      choice("plates.model", p.model, {"growth", "sphere", "raster", "hypsography"},
             "origin of the plates: grown as they are today; drifting, subducting, colliding and "
             "rifting on a sphere through time; drifting and colliding as height maps; or one "
             "plate at rest whose elevations follow a hypsography",
             "cortial2019"),
      integer("plates.count", p.growth.count, "1", 1, 100, "number of plates", "tectonica2026"),
      real("plates.speed_cm_yr", p.growth.speed_cm_yr, "cm yr-1", 0.1, 50.0,
           "middle of the plates' speeds", "tectonica2026"),
      flag("plates.no_net_rotation", p.no_net_rotation, "remove the net rotation of all plates",
           "bird2003"),
      real("plates.boundary_smoothing_km", p.boundary_smoothing_km, "km", 50.0, 2000.0,
           "length over which direction and motion of a boundary are taken", "design"),
      real("plates.boundary_width_km", p.boundary_width_km, "km", 10.0, 200.0,
           "width of the band of cells that count as boundary", "tectonica2026"),
      choice("plates.continents", p.continents, {"cratons", "plates"},
             "continents grow together from cratons, or are whole plates", "tectonica2026"),
      real("plates.continental_share", p.cratons.share, "1", 0.0, 1.0,
           "share of the planet that is continental crust, with cratons", "cogley1984"),
      real("plates.oldest_floor_myr", p.oldest_floor_myr, "Myr", 1.0, 5000.0,
           "age that the sea floor approaches far from its ridge", "muller2008"),
      real("plates.plumes", p.plumes, "1", 0.0, 200.0, "number of mantle plumes", "design"),
      real("plates.continent_km", p.start.continent_km, "km", 500.0, 40000.0,
           "wavelength of the first continents, unless they are whole plates", "design"),
  };
}

/// Plates of the model growth.
std::vector<Parameter> growth_rows(PlatesParameters& p) {
  return {
      real("plates.growth.mantle_heat", p.growth.mantle_heat, "1", 0.0, 1.0,
           "how much hotter than the least the mantle below a plate may be", "tectonica2026"),
      real("plates.growth.size_spread", p.growth.size_spread, "1", 0.0, 3.0,
           "standard deviation of the logarithm of the plates' bias in size", "bird2003"),
      real("plates.growth.roughness", p.growth.roughness, "1", 0.0, 2.0,
           "roughness of the cost at which plates grow", "tectonica2026"),
      real("plates.growth.structure_km", p.growth.structure_km, "km", 50.0, 20000.0,
           "wavelength of weak and strong zones that plates grow along and around",
           "tectonica2026"),
      real("plates.growth.polar_resistance", p.growth.polar_resistance, "1", 0.0, 1.0,
           "extra cost of growth at the poles", "tectonica2026"),
      integer("plates.growth.centre_candidates", p.growth.centre_candidates, "1", 1, 1000,
              "candidate places drawn for each plate, which starts at the one farthest from "
              "earlier plates; 1: anywhere",
              "tectonica2026"),
      real("plates.growth.smallest_part_km2", p.growth.smallest_part_km2, "km2", 0.0, 1e8,
           "smaller detached pieces of a plate join a neighbour at once, larger ones when all "
           "plates "
           "have moved",
           "tectonica2026"),
      integer("plates.growth.evolution_steps", p.evolution_steps, "1", 0, 100,
              "steps of 0.9 to 3.4 Myr in which the grown plates move", "tectonica2026"),
      real("plates.growth.outline_bending_km", p.outline_bending_km, "km", 0.0, 200.0,
           "amplitude by which outlines of plates are warped below the resolution at which they "
           "grow",
           "design"),
  };
}

/// Their continents.
std::vector<Parameter> growth_continent_rows(PlatesParameters& p) {
  return {
      real("plates.growth.land_buffer", p.land_buffer, "1", 0.0, 1.0,
           "share of continental crust beyond that of land, with whole plates", "tectonica2026"),
      real("plates.growth.cratons_per_planet", p.cratons.per_sphere, "1", 1.0, 500.0,
           "number of cratons if every plate carried some", "design"),
      real("plates.growth.craton_smallest_km", p.cratons.smallest_km, "km", 50.0, 5000.0,
           "least radius of a craton", "artemieva2001"),
      real("plates.growth.craton_largest_km", p.cratons.largest_km, "km", 50.0, 5000.0,
           "largest radius of a craton", "artemieva2001"),
      real("plates.growth.ridge_clearance_km", p.cratons.ridge_clearance_km, "km", 0.0, 5000.0,
           "length over which a spreading ridge thins out continents", "design"),
      real("plates.growth.trench_clearance_km", p.cratons.trench_clearance_km, "km", 0.0, 5000.0,
           "length over which sea floor is left before a trench, on the subducting plate",
           "forsyth1975"),
      real("plates.growth.coast_roughness", p.coast_roughness, "1", 0.0, 5.0,
           "deviation of the noise that frays the continents' edges, in e-foldings of a craton",
           "design"),
      real("plates.growth.coast_wavelength_km", p.coast_wavelength_km, "km", 50.0, 20000.0,
           "longest wavelength of that noise", "design"),
      real("plates.growth.passive_margin_km", p.passive_margin_km, "km", 1.0, 2000.0,
           "width of a margin far from convergent boundaries", "watts2001"),
      real("plates.growth.active_margin_km", p.active_margin_km, "km", 1.0, 2000.0,
           "width of a margin at a convergent boundary", "watts2001"),
      real("plates.growth.orogeny_reach_km", p.orogeny_reach_km, "km", 0.0, 5000.0,
           "distance from a convergent boundary within which a continent belongs to its orogen",
           "england1982"),
  };
}

std::vector<Parameter> sphere_drift_rows(PlatesParameters& p) {
  return {
      integer("plates.sphere.samples", p.samples, "1", 500, 8'000'000,
              "samples of crust on the whole planet", "cortial2019"),
      integer("plates.sphere.motion_samples", p.motion_samples, "1", 0, 8'000'000,
              "samples on which the motion of plates is solved and decided when they break and "
              "collide, so that it does not depend on plates.sphere.samples; 0: those of the crust",
              "design"),
      real("plates.sphere.time_myr", p.time_myr, "Myr", 0.0, 5000.0, "how long plates drift",
           "cortial2019"),
      real(
          "plates.sphere.spin_up_myr", p.spin_up_myr, "Myr", 0.0, 5000.0,
          "how long plates that are drawn drift before time 0, so that margins, ages and belts are "
          "those of their motion; plates and elevations that are given begin at time 0",
          "design"),
      choice("plates.sphere.initial_continents", p.initial_continents,
             {"dispersed", "supercontinent"},
             "where the first continents lie: across plates anywhere, or together on one plate",
             "design"),
      real("plates.sphere.frames_myr", p.frames_myr, "Myr", 0.0, 5000.0,
           "time between the frames that are written; 0 writes none", "design"),
      real("plates.sphere.time_step_myr", p.sphere.law.step_myr, "Myr", 0.01, 50.0, "time step",
           "cortial2019"),
      real("plates.sphere.warp_km", p.start.warp_km, "km", 0.0, 5000.0,
           "how far the borders of the first plates are warped", "cortial2019"),
      real("plates.sphere.smallest_sea_km2", p.start.smallest_sea_km2, "km2", 0.0, 1e8,
           "smaller seas that the first continents' noise encloses are land; 0 closes none",
           "design"),
      real("plates.sphere.first_crust_km", p.start.continental_km, "km", 5.0, 80.0,
           "initial thickness of continents", "laske2013"),
      real("plates.sphere.fastest_mm_yr", p.sphere.law.speed_mm_yr, "mm yr-1", 1.0, 1000.0,
           "speed of the fastest plate", "cortial2019"),
      real("plates.sphere.ridge_elevation_km", p.sphere.law.ridge_km, "km", -20.0, 0.0,
           "highest oceanic ridge", "cortial2019"),
      real("plates.sphere.abyss_elevation_km", p.sphere.law.abyss_km, "km", -20.0, 0.0,
           "abyssal plains", "cortial2019"),
      real("plates.sphere.trench_elevation_km", p.sphere.law.trench_km, "km", -30.0, -0.1,
           "deepest trench", "cortial2019"),
      real("plates.sphere.slab_trench_m", p.slab_trench_m, "m", 0.0, 15000.0,
           "depth of a trench below the floor where floor of 100 Myr subducts at 100 mm/yr, in "
           "frames and in what they hand on; 0: only stage isostasy makes trenches",
           "hilde1983"),
      real("plates.sphere.summit_elevation_km", p.sphere.law.summit_km, "km", 0.1, 30.0,
           "highest continent", "cortial2019"),
  };
}

std::vector<Parameter> sphere_subduction_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.subduction_distance_km", p.sphere.law.subduction_distance_km, "km", 10.0,
           10000.0, "distance from the trench over which subduction raises the overriding plate",
           "cortial2019"),
      real("plates.sphere.subduction_uplift_mm_yr", p.sphere.law.uplift_mm_yr, "mm yr-1", 0.0,
           100.0, "uplift above subduction, before the factors of distance, speed and elevation",
           "cortial2019"),
      choice("plates.sphere.given_motions", p.given_motions, {"held", "first"},
             "plates that fields.plates or an event gives a motion keep it until another "
             "event, or begin with it as all others do",
             "cortial2019"),
      choice("plates.sphere.uplift_profile", p.uplift_profile, {"piecewise", "driftworld"},
             "uplift over the distance from the trench, by two cubics or by Driftworld's one",
             "cortial2019"),
      choice("plates.sphere.overlap", p.overlap, {"crust", "score"},
             "what overrides where plates overlap: continents and the younger floor, or, as in "
             "Driftworld, the whole plate that has more continent",
             "cortial2019"),
      choice("plates.sphere.collisions", p.collisions, {"terranes", "plates"},
             "continents that collide leave their plate behind, or, as in Driftworld, their "
             "plates become one as soon as they touch",
             "cortial2019"),
      choice("plates.sphere.uplift_sources", p.uplift_sources, {"nearest", "all"},
             "uplift is that of the nearest trench, or, as in Driftworld, the sum over all "
             "subducting plates",
             "cortial2019"),
      choice("plates.sphere.accretion", p.accretion, {"wedge", "abyss"},
             "sediment accretes in the wedge behind trenches, or, as in Driftworld, on all floor "
             "below plates.sphere.accretion_top_km",
             "cortial2019"),
      choice("plates.sphere.rifting", p.rifting, {"any", "largest"},
             "any plate may rift, or, as in Driftworld, the largest alone, into two",
             "cortial2019"),
      real("plates.sphere.uplift_control_km", p.sphere.uplift_control_km, "km", 1.0, 5000.0,
           "distance from the trench at which uplift by subduction is greatest", "cortial2019"),
      real("plates.sphere.arc_reach_km", p.sphere.arc_reach_km, "km", 10.0, 10000.0,
           "distance from the trench over which subduction raises an overriding plate of ocean "
           "floor",
           "cortial2019"),
      real("plates.sphere.elevation_weight", p.sphere.elevation_weight, "1", 0.0, 4.0,
           "power of the factor by which the elevation of the subducting crust raises the "
           "overriding plate",
           "cortial2019"),
      real(
          "plates.sphere.upper_plate_advance_mm_yr", p.sphere.advance_mm_yr, "mm yr-1", 0.0, 1000.0,
          "advance of an overriding plate on its trench that raises the factor of its uplift by 1, "
          "from a third at rest up to five thirds; 0: uplift does not depend on it",
          "heuret2005"),
      real("plates.sphere.fold_turning_km", p.sphere.fold_per_km, "km-1", 0.0, 1.0,
           "weight of the relative motion in the direction of folds, per kilometre", "cortial2019"),
  };
}

std::vector<Parameter> sphere_force_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.slab_pull_myr", p.sphere.slab_pull, "Myr-1", 0.0, 1.0,
           "turning of a plate's axis by each 1000 km of its trenches", "cortial2019"),
      flag("plates.sphere.forces", p.sphere.by_forces,
           "motion follows the balance of slabs, ridges and sutures with the mantle's drag, "
           "in place of the turning by slabs",
           "forsyth1975"),
      real("plates.sphere.slab_share", p.sphere.force.slab_share, "1", 0.0, 1.0,
           "share of a slab's weight that reaches its plate, with forces", "forsyth1975"),
      real("plates.sphere.suction_share", p.sphere.force.suction_share, "1", 0.0, 1.0,
           "share of a slab's weight that pulls the overriding plate towards the trench, with "
           "forces",
           "conrad2002"),
      real("plates.sphere.slab_km", p.sphere.force.slab_km, "km", 0.0, 3000.0,
           "length of the slab that pulls, with forces", "turcotte2002"),
      real("plates.sphere.asthenosphere_pa_s", p.sphere.force.viscosity_pa_s, "Pa s", 1e17, 1e23,
           "viscosity of the asthenosphere, with forces", "turcotte2002"),
      real("plates.sphere.asthenosphere_km", p.sphere.force.asthenosphere_km, "km", 10.0, 1000.0,
           "thickness of the asthenosphere, with forces", "turcotte2002"),
      real("plates.sphere.continental_drag", p.sphere.force.continental_drag, "1", 0.1, 100.0,
           "drag below continents over that below oceans, with forces", "forsyth1975"),
      real("plates.sphere.suture_n_m", p.sphere.force.collision_n_m, "N m-1", 0.0, 1e14,
           "resistance of a suture to the continents that meet there, with forces", "copley2010"),
      real("plates.sphere.force_response_myr", p.sphere.force.response_myr, "Myr", 0.01, 1000.0,
           "time in which motion follows the forces", "design"),
  };
}

std::vector<Parameter> sphere_collision_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.penetration_km", p.sphere.penetration_km, "km", 0.0, 5000.0,
           "how far one continent is thrust below another before they collide", "cortial2019"),
      real("plates.sphere.suturing_mm_yr", p.sphere.suturing_mm_yr, "mm yr-1", 0.0, 1000.0,
           "speed below which continents of which one is thrust 300 km below the other become one "
           "plate; 0: they do so only after plates.sphere.penetration_km",
           "copley2010"),
      real("plates.sphere.welding_mm_yr", p.sphere.welding_mm_yr, "mm yr-1", 0.0, 1000.0,
           "speed below which plates beside each other become one when the crust is resampled; 0: "
           "none do",
           "gordon1998"),
      real("plates.sphere.welding_after_myr", p.sphere.welding_after_myr, "Myr", 0.0, 1e4,
           "time that a rift has to open faster than that, or it fails", "design"),
      real("plates.sphere.welding_continental", p.sphere.welding_continental, "1", 0.0, 1.0,
           "share by which that speed is lower where continents border each other", "design"),
      real("plates.sphere.suture_drag", p.sphere.suture_drag, "1", 0.0, 1e6,
           "drag between continents of which one is thrust below the other, over that of "
           "the mantle below a plate; 0: they do not slow each other",
           "copley2010"),
      real("plates.sphere.collision_distance_km", p.sphere.law.collision_distance_km, "km", 0.0,
           20000.0, "farthest reach of a collision", "cortial2019"),
      real("plates.sphere.collision_coefficient_km", p.sphere.law.collision_per_km, "km-1", 0.0,
           1.0, "height of a collision's surge per area of the terrane", "cortial2019"),
      real("plates.sphere.surge_km", p.sphere.surge_km, "km", 0.0, 20.0,
           "greatest uplift by one collision", "christensen1995"),
      real("plates.sphere.crustal_flow_km2_myr", p.sphere.crustal_flow_km2_myr, "km2 Myr-1", 0.0,
           100000.0,
           "diffusivity with which the lower crust of belts flows to their sides; 0: none flows "
           "until crust is too thick",
           "clark2000"),
      real("plates.sphere.crustal_flow_above_km", p.sphere.crustal_flow_above_km, "km", 10.0, 200.0,
           "thickness of crust above which it flows", "clark2000"),
      real("plates.sphere.thickest_km", p.sphere.thickest_km, "km", 0.0, 200.0,
           "thickest continental crust: lower-crustal flow spreads what would be thicker; 0 "
           "sets no limit",
           "clark2000"),
  };
}

std::vector<Parameter> sphere_surface_rows(PlatesParameters& p) {
  return {
      choice("plates.sphere.ocean_floor", p.ocean_floor, {"damping", "age"},
             "subsidence of the sea floor, by damping or to the depth of its age", "stein1992"),
      real("plates.sphere.ridge_segment_km", p.sphere.ridge_segment_km, "km", 0.0, 5000.0,
           "length of the segments into which transforms cut a ridge at 45 degrees to its motion; "
           "0: ridges run half way between plates, at any angle",
           "oldenburg1972"),
      real("plates.sphere.ridge_falloff", p.sphere.ridge_falloff, "1", 0.001, 1.0,
           "distance over which a ridge's profile halves, in radii of the planet", "cortial2019"),
      real("plates.sphere.ocean_damping_mm_yr", p.sphere.law.damping_mm_yr, "mm yr-1", 0.0, 10.0,
           "subsidence of the sea floor, with damping", "cortial2019"),
      real("plates.sphere.continental_erosion_mm_yr", p.sphere.law.erosion_mm_yr, "mm yr-1", 0.0,
           10.0, "erosion of the highest continents", "cortial2019"),
      choice(
          "plates.sphere.erosion", p.erosion, {"height", "land", "rivers"},
          "continents erode according to their height, and basins below the sea fill up; the same "
          "on land alone; or rivers erode them between the steps and deposit what they carry",
          "cortial2019"),
      choice(
          "plates.landscape", p.landscape, {"none", "full"},
          "whether drifting plates have a climate: rivers that run on its rain, ice, a sea whose "
          "water stays, and all of that in the frames",
          "design"),
      real("plates.sphere.climate_myr", p.climate_myr, "Myr", 0.1, 1000.0,
           "time between two of these climates", "design"),
      real("plates.sphere.freeboard_myr", p.sphere.freeboard_myr, "Myr", 0.0, 10000.0,
           "time in which the mantle gives and takes water until the sea covers "
           "planet.ocean_fraction, to 1/e, with landscape = full; 0: the sea's water stays",
           "wise1974"),
      choice("plates.sphere.sea_level", p.sea_level, {"fixed", "ocean"},
             "base level of that erosion: elevation 0, or, in each step, the level below which "
             "planet.ocean_fraction of the surface lies",
             "design"),
      real("plates.sphere.river_erodibility_yr", p.sphere.rivers.erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility K for the square root of the drained area, with rivers", "whipple1999"),
      real("plates.sphere.old_rock_erodibility", p.sphere.old_rock_erodibility, "1", 0.0, 10.0,
           "erodibility of rock that was folded long ago over that of young belts and of sediment, "
           "with rivers",
           "harel2016"),
      real("plates.sphere.hardening_myr", p.sphere.hardening_myr, "Myr", 1.0, 5000.0,
           "time in which rock of belts hardens to 1/e of the difference", "harel2016"),
      real("plates.sphere.river_deposition", p.sphere.rivers.deposition, "1", 0.0, 1000.0,
           "deposition G: what rivers deposit, over the mean loss of the land upstream",
           "davy2009"),
      real("plates.sphere.accreted_share", p.sphere.accreted_share, "1", 0.0, 1.0,
           "share of the rivers' sediment on floor that subducts which is scraped off and stays",
           "vonhuene1991"),
      real("plates.sphere.settling_km", p.sphere.rivers.settling_km, "km", 1.0, 5000.0,
           "length over which most of the rivers' sediment is deposited at sea, with rivers",
           "design"),
      real("plates.sphere.sediment_accretion_mm_yr", p.sphere.law.accretion_mm_yr, "mm yr-1", 0.0,
           10.0, "growth of the wedge of sediment at trenches", "cortial2019"),
      real("plates.sphere.accretion_top_km", p.sphere.accretion_top_km, "km", -10.0, 0.0,
           "height up to which that wedge grows", "design"),
      real("plates.sphere.accretion_width_km", p.sphere.accretion_width_km, "km", 0.0, 1000.0,
           "width of that wedge", "design"),
  };
}

std::vector<Parameter> sphere_volcano_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.arc_km", p.sphere.arc_km, "km", 5.0, 80.0,
           "thickness of an island arc's crust when it emerges", "christensen1995"),
      real("plates.sphere.plume_mm_yr", p.sphere.plume_mm_yr, "mm yr-1", 0.0, 100.0,
           "output of plumes below the sea floor, as the growth of one mound on floor at "
           "rest",
           "cortial2019"),
      real("plates.sphere.plume_km", p.sphere.plume_km, "km", 1.0, 1000.0,
           "distance from a plume over which that growth falls to a half", "design"),
      real("plates.sphere.volcano_km", p.sphere.volcano_km, "km", 1.0, 500.0,
           "distance from a volcano's middle over which its growth falls to a half, most "
           "of a sample's spacing at least",
           "tenbrink1991"),
      real("plates.sphere.volcano_spacing_km", p.sphere.volcano_spacing_km, "km", 1.0, 5000.0,
           "mean distance on a plate from one volcano of a plume to the next", "tenbrink1991"),
      real("plates.sphere.island_wear_myr", p.sphere.island_wear_myr, "Myr", 0.0, 1000.0,
           "time in which volcanic islands erode to 1/e of their height; 0 keeps them",
           "ramalho2013"),
      real("plates.sphere.swell_decay_myr", p.sphere.swell_decay_myr, "Myr", 0.0, 1000.0,
           "time in which uplift of the sea floor above the depth of its age decays to 1/e, by age "
           "alone; 0 keeps it",
           "detrick1978"),
      real("plates.sphere.plume_top_km", p.sphere.plume_top_km, "km", -5.0, 10.0,
           "height that those volcanoes reach", "design"),
  };
}

std::vector<Parameter> sphere_margin_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.margin_km", p.sphere.margin_km, "km", 0.0, 1000.0,
           "width of the stretched crust where a continent breaks", "watts2001"),
      real("plates.sphere.margin_necking", p.sphere.margin_necking, "1", 1.0, 16.0,
           "how soon that crust is thin; above 1 most of the thinning is near the land",
           "peronpinvidic2013"),
      real("plates.sphere.margin_source_km", p.sphere.margin_source_km, "km", 1.0, 5000.0,
           "how far inland that crust flows from", "design"),
      real("plates.sphere.margin_thinning", p.sphere.margin_thinning, "1", 0.0, 0.5,
           "most that the crust inland thins for it, at the break", "design"),
  };
}

std::vector<Parameter> sphere_rifting_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.rifts_myr", p.sphere.rift_per_myr, "Myr-1", 0.0, 1.0,
           "rate at which a wholly continental plate of mean size rifts", "cortial2019"),
      real("plates.sphere.rift_smallest", p.sphere.rift_smallest, "1", 0.0, 100.0,
           "plates smaller than this, in mean areas, do not rift", "design"),
      real("plates.sphere.rift_speed_mm_yr", p.sphere.rift_speed_mm_yr, "mm yr-1", 0.0, 1000.0,
           "speed at which fragments leave the middle of their plate", "design"),
      real("plates.sphere.rift_onset_myr", p.sphere.rift_onset_myr, "Myr", 0.0, 1000.0,
           "time in which they reach it; 0: at once", "brune2016"),
      real("plates.sphere.rift_onset_power", p.sphere.rift_onset_power, "1", 0.1, 10.0,
           "with which power of time they do: above 1 they are slow for long and then fast",
           "brune2016"),
      real("plates.sphere.plume_rift_share", p.sphere.plume_rift_share, "1", 0.0, 1.0,
           "share of the rifts of plates with a plume below their continents whose arms meet above "
           "it",
           "burke1973"),
      real("plates.sphere.rift_warp_km", p.sphere.rift_warp_km, "km", 0.0, 5000.0,
           "how far the borders of fragments are warped", "cortial2019"),
      renamed(real("plates.sphere.subduction_initiation_myr", p.sphere.initiation_per_myr, "Myr-1",
                   0.0, 1.0,
                   "rate at which each 1000 km of a passive margin with old floor become a "
                   "subduction zone",
                   "bradley2008"),
              "plates.foundering_myr"),
      renamed(
          real("plates.sphere.subduction_initiation_age_myr", p.sphere.initiation_age_myr, "Myr",
               0.0, 5000.0, "age from which floor at a passive margin is so old", "bradley2008"),
          "plates.foundering_age_myr"),
      renamed(real("plates.sphere.subduction_initiation_speed_mm_yr",
                   p.sphere.initiation_speed_mm_yr, "mm yr-1", 0.0, 1000.0,
                   "speed at which floor begins to subduct below its own continent", "stern2004"),
              "plates.foundering_speed_mm_yr"),
  };
}

std::vector<Parameter> sphere_back_arc_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.back_arc_myr", p.sphere.back_arc_per_myr, "Myr-1", 0.0, 1.0,
           "rate at which each 1000 km of trench with old floor begin to retreat, and the arc "
           "above to follow; 0: none does",
           "sdrolias2006"),
      real("plates.sphere.back_arc_age_myr", p.sphere.back_arc_age_myr, "Myr", 0.0, 5000.0,
           "age from which floor that subducts is so old", "sdrolias2006"),
      real("plates.sphere.back_arc_mm_yr", p.sphere.back_arc_mm_yr, "mm yr-1", 0.0, 1000.0,
           "most speed at which such an arc leaves the plate behind it", "sdrolias2006"),
      real("plates.sphere.back_arc_km", p.sphere.back_arc_km, "km", 0.0, 2000.0,
           "width of such an arc", "sdrolias2006"),
      real("plates.sphere.back_arc_lasts_myr", p.sphere.back_arc_lasts_myr, "Myr", 0.0, 1000.0,
           "how long an arc that is too small for a plate goes on as one", "sdrolias2006"),
      real("plates.sphere.indentation_myr", p.sphere.indentation_per_myr, "Myr-1", 0.0, 1.0,
           "rate at which each 1000 km of a collision faster than 10 mm/yr break a block off the "
           "continent above; 0: none",
           "molnar1975"),
      real("plates.sphere.indentation_km", p.sphere.indentation_km, "km", 0.0, 5000.0,
           "how far such a block reaches behind the deformation front", "tapponnier1982"),
      real("plates.sphere.indentation_lasts_myr", p.sphere.indentation_lasts_myr, "Myr", 0.0,
           5000.0, "how long a block that hardly moves any more stays one", "tapponnier1982"),
      real("plates.sphere.ridge_jump_km", p.sphere.ridge_jump_km, "km", 0.0, 2000.0,
           "distance up to which a ridge jumps to a plume beside it; 0: none does",
           "mittelstaedt2011"),
      real("plates.sphere.ridge_jump_age_myr", p.sphere.ridge_jump_age_myr, "Myr", 0.0, 1000.0,
           "age of the oldest floor above a plume to which a ridge jumps", "mittelstaedt2008"),
  };
}

std::vector<Parameter> sphere_piece_rows(PlatesParameters& p) {
  return {
      real("plates.sphere.coast_warp_km", p.sphere.coast_warp_km, "km", 0.0, 2000.0,
           "how far the outline of crust that an event changes is warped, of a circle a "
           "fifth of its radius at most",
           "cortial2019"),
      real("plates.sphere.smallest_piece_km2", p.sphere.smallest_piece_km2, "km2", 0.0, 1e8,
           "smaller detached pieces of a plate join a neighbour", "design"),
      real("plates.sphere.piece_continental_weight", p.sphere.piece_continental_weight, "1", 1.0,
           100.0,
           "how many times the area of continents counts there: plates of floor are taken "
           "over by their neighbours sooner than those of continents",
           "stock1994"),
      integer("plates.sphere.resampling_least", p.sphere.least_steps, "1", 1, 1000,
              "steps between resamplings, when a plate is as fast as any may be", "cortial2019"),
      integer("plates.sphere.resampling_most", p.sphere.most_steps, "1", 1, 1000,
              "most steps between resamplings", "cortial2019"),
  };
}

}  // namespace

std::vector<Parameter> PlatesParameters::declarations() {
  std::vector<Parameter> rows =
      joined(*this, {shared_rows, growth_rows, growth_continent_rows, sphere_drift_rows,
                     sphere_subduction_rows, sphere_force_rows, sphere_collision_rows,
                     sphere_surface_rows, sphere_volcano_rows, sphere_margin_rows,
                     sphere_rifting_rows, sphere_back_arc_rows, sphere_piece_rows});
  for (Parameter& row : hypsography_parameters(*this)) rows.push_back(std::move(row));
  for (Parameter& row : raster_declarations(raster)) rows.push_back(std::move(row));
  // What all models share, then model by model.
  constexpr std::array kSections{"plates", "plates.growth", "plates.sphere", "plates.raster",
                                 "plates.hypsography"};
  std::stable_sort(rows.begin(), rows.end(), [&](const Parameter& a, const Parameter& b) {
    const auto place = [&](const Parameter& row) {
      return std::find(kSections.begin(), kSections.end(), row.section());
    };
    return place(a) < place(b);
  });
  return rows;
}

}  // namespace geo
