#pragma once

#include <cstdint>

#include "geo/kernels/plates/sphere/plate_forces.hpp"
#include "geo/kernels/plates/tectonic_laws.hpp"
#include "geo/kernels/water/surface_rivers.hpp"

namespace geo {

/// Settings of the plates of a sphere through time.
struct SphereSettings {
  TectonicConstants law;
  double radius_km = 6370.0;
  bool driftworld_uplift = false;    ///< Driftworld's f instead of the piecewise one
  double uplift_control_km = 200.0;  ///< where subduction raises most
  double arc_reach_km = 1800.0;      ///< of the uplift where the overriding crust is oceanic
  double elevation_weight = 1.0;     ///< power of the factor h in the uplift
  /// v_u, mm/yr: subduction raises an overriding plate that advances on its trench at v by the
  /// factor 1/3 + v/v_u, from 0 to 5/3 (Heuret & Lallemand 2005); 0: by 1, whatever its motion.
  double advance_mm_yr = 0.0;
  double fold_per_km = 0.002;  ///< beta of the fold direction, per km of relative motion
  double slab_pull = 1e-3;     ///< epsilon, per Myr and 1000 km of trench
  bool by_forces = false;      ///< motion balances forces, in place of that
  PlateForces force;
  double penetration_km = 300.0;        ///< of continents, before they collide
  double suturing_mm_yr = 0.0;          ///< slower continents collide after 300 km; 0: none do
  double welding_mm_yr = 0.0;           ///< plates that move slower beside each other become one
  double welding_after_myr = 40.0;      ///< of a rift before its sides may do so
  double welding_continental = 0.0;     ///< share of that speed by which continents hold out
  double suture_drag = 0.0;             ///< between them, over that below a plate
  double surge_km = 4.5;                ///< most that one collision lifts
  double crustal_flow_km2_myr = 0.0;    ///< D with which thick crust flows to its sides
  double crustal_flow_above_km = 42.0;  ///< h_c: what of its thickness is above that
  double thickest_km = 75.0;            ///< of continents: thicker roots spread; 0: no limit
  double oceanic_km = 7.0;              ///< thickness of new crust
  double arc_km = 25.0;                 ///< thickness of an island arc when it emerges
  double ridge_falloff = 0.05;          ///< sigma of the ridge's profile, in radii
  double ridge_segment_km = 0.0;        ///< of a ridge at 45 degrees to its motion; 0: half way
  bool floor_by_age = false;            ///< depth by GDH1 instead of damping
  double accretion_top_km = -3.0;       ///< up to which a trench's sediment piles
  double accretion_width_km = 100.0;    ///< of the wedge
  double margin_km = 120.0;             ///< width of stretched crust where a continent breaks
  double margin_necking = 1.0;          ///< exponent with which it thins: 1 or more
  double margin_source_km = 500.0;      ///< from which inland it flows there
  double margin_thinning = 0.18;        ///< most that the inland thins for it, at the break
  double rift_per_myr = 0.004;          ///< lambda_0
  double rift_smallest = 0.5;           ///< smaller plates, in mean areas, do not rift
  double rift_speed_mm_yr = 30.0;       ///< at which fragments part
  double rift_onset_myr = 0.0;          ///< in which they come to it
  double rift_onset_power = 1.0;        ///< n: at (t / onset)^n of what drives them apart
  double rift_warp_km = 400.0;          ///< of their borders
  double plume_rift_share = 0.0;        ///< of the rifts of continents above a plume begin there
  double initiation_per_myr =
      0.01;  ///< rate at which 1000 km of old passive margin begin to subduct
  double initiation_age_myr = 120.0;      ///< from which floor at a passive margin is old
  double initiation_speed_mm_yr = 50.0;   ///< at which such floor subducts
  double back_arc_per_myr = 0.0;          ///< rate at which 1000 km of old trench begin to retreat
  double back_arc_age_myr = 55.0;         ///< from which floor that subducts is old
  double back_arc_mm_yr = 40.0;           ///< most at which an arc leaves what is behind it
  double back_arc_km = 350.0;             ///< width of the arc that follows its trench
  double back_arc_lasts_myr = 20.0;       ///< before a small one joins a neighbour
  double indentation_per_myr = 0.0;       ///< rate at which 1000 km of fast collision break a block
  double indentation_km = 1200.0;         ///< how far behind the deformation front that reaches
  double indentation_lasts_myr = 40.0;    ///< before it may weld as other plates do
  double ridge_jump_km = 0.0;             ///< from which a plume draws a ridge to itself; 0: none
  double ridge_jump_age_myr = 20.0;       ///< of the oldest floor that breaks there
  double coast_warp_km = 120.0;           ///< of crust that events change
  double mean_area_km2 = 1.27e7;          ///< A_0
  double smallest_piece_km2 = 5e5;        ///< detached pieces below join a neighbour
  double piece_continental_weight = 1.0;  ///< by which the area of continents counts there
  double plume_mm_yr = 0.0;               ///< output of the first plumes, as growth of one mound
  double plume_km = 60.0;                 ///< over which that would fall to a half
  double volcano_km = 30.0;               ///< over which the growth of one volcano does
  double volcano_spacing_km = 100.0;      ///< mean way of a plate from one volcano to the next
  double island_wear_myr = 6.0;           ///< in which ocean floor above the sea wears down to 1/e
  double swell_decay_myr = 30.0;  ///< the same of what lifted floor, with floor_by_age; 0: never
  double plume_top_km = 2.0;      ///< height that volcanoes of the sea floor reach
  // Rules of Driftworld in place of the paper's.
  bool rank_by_score = false;  ///< whole plates stay up by score(), not continents and young floor
  bool merge_plates = false;   ///< plates whose continents touch become one
  bool add_uplifts = false;    ///< of all subducting plates, not of the nearest alone
  bool fill_abyss = false;     ///< sediment piles on all floor below accretion_top_km
  bool rift_largest = false;   ///< only the largest plate rifts, into two, however much is land
  bool by_rivers = false;      ///< rivers carve and deposit, in place of erosion by height
  /// Share of the planet below the sea, whose level is where that leaves it in each step: the base
  /// level of erosion by height, to which arcs emerge; 0: the sea stays at elevation 0.
  double ocean_share = 0.0;
  bool wears_land_alone = false;  ///< erosion by height leaves what lies below the sea as it is
  RiverLaw rivers{.deposition = 1.0};  ///< their step and rebound are the model's
  double freeboard_myr =
      0.0;  ///< in which the sea comes to cover that share again, to 1/e; 0: never
  double freeboard_ocean_share = 0.71;
  double old_rock_erodibility =
      1.0;                       ///< of rock that was folded long ago, over that of young belts
  double hardening_myr = 100.0;  ///< in which rock becomes so, to 1/e
  double accreted_share = 0.2;   ///< of the sediment of floor that subducts: scraped off
  bool no_net_rotation = true;
  bool hold_motions = true;  ///< whether a plate goes on turning as it is told to
  std::int64_t least_steps = 10, most_steps = 60;  ///< between resamplings
  double rebound = 6.6;  ///< thickness of a root per height: rho_m / (rho_m - rho_c)
};

}  // namespace geo
