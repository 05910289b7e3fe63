#include "geo/stages/plates/plates.hpp"

#include "growth.hpp"
#include "hypsography.hpp"
#include "raster.hpp"
#include "sphere.hpp"

namespace geo {

std::vector<Parameter> PlatesParameters::declarations() {
  std::vector<Parameter> rows{
      choice("plates.model", model, {"growth", "sphere", "raster", "hypsography"},
             "how plates come about: they grow as they stand today; drift, go below each other, "
             "collide and break on a sphere through time; drift and collide as height maps on a "
             "torus; or there is one at rest whose heights follow a hypsography",
             "cortial2019"),
      integer("plates.count", growth.count, "1", 2, 100, "number of plates", "tectonica2026"),
      real("plates.speed_cm_yr", growth.speed_cm_yr, "cm yr-1", 0.1, 50.0,
           "middle of the plates' speeds", "tectonica2026"),
      real("plates.mantle_heat", growth.mantle_heat, "1", 0.0, 1.0,
           "how much hotter than the least the mantle below a plate may be", "tectonica2026"),
      real("plates.size_spread", growth.size_spread, "1", 0.0, 3.0,
           "standard deviation of the logarithm of the plates' bias in size", "bird2003"),
      real("plates.roughness", growth.roughness, "1", 0.0, 2.0,
           "roughness of the cost at which plates grow", "tectonica2026"),
      real("plates.structure_km", growth.structure_km, "km", 50.0, 20000.0,
           "wavelength of weak and strong zones that plates grow along and around",
           "tectonica2026"),
      real("plates.polar_resistance", growth.polar_resistance, "1", 0.0, 1.0,
           "extra cost of growth at the poles", "tectonica2026"),
      integer(
          "plates.centre_candidates", growth.centre_candidates, "1", 1, 1000,
          "places drawn for each plate, of which it begins at the one farthest from its elders; "
          "1: anywhere",
          "tectonica2026"),
      real("plates.smallest_part_km2", growth.smallest_part_km2, "km2", 0.0, 1e8,
           "smaller detached pieces of a plate join a neighbour at once, larger ones when all "
           "plates "
           "have moved",
           "tectonica2026"),
      flag("plates.no_net_rotation", no_net_rotation, "take the common rotation of all plates away",
           "bird2003"),
      integer("plates.evolution_steps", evolution_steps, "1", 0, 100,
              "steps of 0.9 to 3.4 Myr in which the grown plates move", "tectonica2026"),
      real("plates.boundary_smoothing_km", boundary_smoothing_km, "km", 50.0, 2000.0,
           "length over which direction and motion of a boundary are taken", "design"),
      real("plates.boundary_width_km", boundary_width_km, "km", 10.0, 200.0,
           "width of the band of cells that count as boundary", "tectonica2026"),
      real("plates.outline_bending_km", outline_bending_km, "km", 0.0, 200.0,
           "how far the outlines of plates bend below the resolution they grow at", "design"),
      choice("plates.continents", continents, {"cratons", "plates"},
             "continents grow together from cratons, or are whole plates", "tectonica2026"),
      real("plates.continental_share", cratons.share, "1", 0.0, 1.0,
           "share of the planet that is continental crust, with cratons", "cogley1984"),
      real("plates.land_buffer", land_buffer, "1", 0.0, 1.0,
           "share of continental crust beyond that of land, with whole plates", "tectonica2026"),
      real("plates.cratons_per_planet", cratons.per_sphere, "1", 1.0, 500.0,
           "number of cratons if every plate carried some", "design"),
      real("plates.craton_smallest_km", cratons.smallest_km, "km", 50.0, 5000.0,
           "least radius of a craton", "artemieva2001"),
      real("plates.craton_largest_km", cratons.largest_km, "km", 50.0, 5000.0,
           "largest radius of a craton", "artemieva2001"),
      real("plates.ridge_clearance_km", cratons.ridge_clearance_km, "km", 0.0, 5000.0,
           "length over which a spreading ridge thins out continents", "design"),
      real("plates.coast_roughness", coast_roughness, "1", 0.0, 5.0,
           "deviation of the noise that frays the continents' edges, in e-foldings of a craton",
           "design"),
      real("plates.coast_wavelength_km", coast_wavelength_km, "km", 50.0, 20000.0,
           "longest wavelength of that noise", "design"),
      real("plates.passive_margin_km", passive_margin_km, "km", 1.0, 2000.0,
           "width of a margin far from convergent boundaries", "watts2001"),
      real("plates.active_margin_km", active_margin_km, "km", 1.0, 2000.0,
           "width of a margin at a convergent boundary", "watts2001"),
      real("plates.oldest_floor_myr", oldest_floor_myr, "Myr", 1.0, 5000.0,
           "age that the sea floor approaches far from its ridge", "muller2008"),
      real("plates.plumes", plumes, "1", 0.0, 200.0, "number of mantle plumes", "design"),
      real("plates.orogeny_reach_km", orogeny_reach_km, "km", 0.0, 5000.0,
           "distance from a convergent boundary within which a continent belongs to its orogen",
           "england1982"),
      integer("plates.samples", samples, "1", 500, 8'000'000,
              "sphere: samples of crust on the whole planet", "cortial2019"),
      real("plates.time_myr", time_myr, "Myr", 0.0, 5000.0, "sphere: how long plates drift",
           "cortial2019"),
      real("plates.frames_myr", frames_myr, "Myr", 0.0, 5000.0,
           "sphere: time between the frames that are written; 0 writes none", "design"),
      real("plates.time_step_myr", sphere.law.step_myr, "Myr", 0.01, 50.0, "sphere: time step",
           "cortial2019"),
      real("plates.warp_km", start.warp_km, "km", 0.0, 5000.0,
           "sphere: how far the borders of the first plates are warped", "cortial2019"),
      real("plates.continent_km", start.continent_km, "km", 500.0, 40000.0,
           "sphere: wavelength of the first continents, unless they are whole plates", "design"),
      real("plates.smallest_sea_km2", start.smallest_sea_km2, "km2", 0.0, 1e8,
           "sphere: smaller seas that the first continents' noise encloses are land; 0 closes none",
           "design"),
      real("plates.first_crust_km", start.continental_km, "km", 5.0, 80.0,
           "sphere: thickness of the first continents", "laske2013"),
      real("plates.fastest_mm_yr", sphere.law.speed_mm_yr, "mm yr-1", 1.0, 1000.0,
           "sphere: speed of the fastest plate", "cortial2019"),
      real("plates.ridge_elevation_km", sphere.law.ridge_km, "km", -20.0, 0.0,
           "sphere: highest oceanic ridge", "cortial2019"),
      real("plates.abyss_elevation_km", sphere.law.abyss_km, "km", -20.0, 0.0,
           "sphere: abyssal plains", "cortial2019"),
      real("plates.trench_elevation_km", sphere.law.trench_km, "km", -30.0, -0.1,
           "sphere: deepest trench", "cortial2019"),
      real("plates.summit_elevation_km", sphere.law.summit_km, "km", 0.1, 30.0,
           "sphere: highest continent", "cortial2019"),
      real("plates.subduction_distance_km", sphere.law.subduction_distance_km, "km", 10.0, 10000.0,
           "sphere: how far from its front subduction raises the upper plate", "cortial2019"),
      real("plates.subduction_uplift_mm_yr", sphere.law.uplift_mm_yr, "mm yr-1", 0.0, 100.0,
           "sphere: uplift above subduction, before the factors of distance, speed and elevation",
           "cortial2019"),
      choice("plates.given_motions", given_motions, {"held", "first"},
             "sphere: plates that fields.plates or an event gives a motion keep it until another "
             "event, or begin with it as all others do",
             "cortial2019"),
      choice(
          "plates.uplift_profile", uplift_profile, {"piecewise", "driftworld"},
          "sphere: uplift over the distance from the front, by two cubics or by Driftworld's one",
          "cortial2019"),
      choice("plates.overlap", overlap, {"crust", "score"},
             "sphere: what stays up where plates overlap: continents and the younger floor, or, as "
             "in Driftworld, the whole plate that has more continent",
             "cortial2019"),
      choice(
          "plates.collisions", collisions, {"terranes", "plates"},
          "sphere: continents that collide leave their plate behind, or, as in Driftworld, their "
          "plates become one as soon as they touch",
          "cortial2019"),
      choice("plates.uplift_sources", uplift_sources, {"nearest", "all"},
             "sphere: uplift is that of the nearest front, or, as in Driftworld, the sum over all "
             "plates that go below",
             "cortial2019"),
      choice(
          "plates.accretion", accretion, {"wedge", "abyss"},
          "sphere: sediment piles in the wedge behind trenches, or, as in Driftworld, on all floor "
          "below plates.accretion_top_km",
          "cortial2019"),
      choice("plates.rifting", rifting, {"any", "largest"},
             "sphere: any plate may rift, or, as in Driftworld, the largest alone, into two",
             "cortial2019"),
      real("plates.uplift_control_km", sphere.uplift_control_km, "km", 1.0, 5000.0,
           "sphere: distance from the front where subduction raises most", "cortial2019"),
      real("plates.arc_reach_km", sphere.arc_reach_km, "km", 10.0, 10000.0,
           "sphere: how far from its front subduction raises an upper plate of ocean floor",
           "cortial2019"),
      real("plates.elevation_weight", sphere.elevation_weight, "1", 0.0, 4.0,
           "sphere: power of the factor by which the height of what goes down raises the upper "
           "plate",
           "cortial2019"),
      real("plates.fold_turning_km", sphere.fold_per_km, "km-1", 0.0, 1.0,
           "sphere: weight of the relative motion in the direction of folds, per kilometre",
           "cortial2019"),
      real("plates.slab_pull_myr", sphere.slab_pull, "Myr-1", 0.0, 1.0,
           "sphere: turning of a plate's axis by each 1000 km of its subduction fronts",
           "cortial2019"),
      flag(
          "plates.forces", sphere.by_forces,
          "sphere: motion follows the balance of slabs, ridges and sutures with the mantle's drag, "
          "in place of the turning by slabs",
          "forsyth1975"),
      real("plates.slab_share", sphere.force.slab_share, "1", 0.0, 1.0,
           "sphere: share of a slab's weight that reaches its plate, with forces", "forsyth1975"),
      real("plates.suction_share", sphere.force.suction_share, "1", 0.0, 1.0,
           "sphere: share of a slab's weight that draws the plate above it to the trench, with "
           "forces",
           "conrad2002"),
      real("plates.slab_km", sphere.force.slab_km, "km", 0.0, 3000.0,
           "sphere: length of the slab that pulls, with forces", "turcotte2002"),
      real("plates.asthenosphere_pa_s", sphere.force.viscosity_pa_s, "Pa s", 1e17, 1e23,
           "sphere: viscosity of the asthenosphere, with forces", "turcotte2002"),
      real("plates.asthenosphere_km", sphere.force.asthenosphere_km, "km", 10.0, 1000.0,
           "sphere: thickness of the asthenosphere, with forces", "turcotte2002"),
      real("plates.continental_drag", sphere.force.continental_drag, "1", 0.1, 100.0,
           "sphere: drag below continents over that below oceans, with forces", "forsyth1975"),
      real("plates.suture_n_m", sphere.force.collision_n_m, "N m-1", 0.0, 1e14,
           "sphere: resistance of a suture to the continents that meet there, with forces",
           "copley2010"),
      real("plates.force_response_myr", sphere.force.response_myr, "Myr", 0.01, 1000.0,
           "sphere: time in which motion follows the forces", "design"),
      real("plates.penetration_km", sphere.penetration_km, "km", 0.0, 5000.0,
           "sphere: how far one continent is thrust below another before they collide",
           "cortial2019"),
      real("plates.suture_drag", sphere.suture_drag, "1", 0.0, 1e6,
           "sphere: drag between continents of which one has gone below the other, over that of "
           "the mantle below a plate; 0: they do not slow each other",
           "copley2010"),
      real("plates.collision_distance_km", sphere.law.collision_distance_km, "km", 0.0, 20000.0,
           "sphere: farthest reach of a collision", "cortial2019"),
      real("plates.collision_coefficient_km", sphere.law.collision_per_km, "km-1", 0.0, 1.0,
           "sphere: height of a collision's surge per area of the terrane", "cortial2019"),
      real("plates.surge_km", sphere.surge_km, "km", 0.0, 20.0,
           "sphere: most that one collision lifts", "christensen1995"),
      real("plates.thickest_km", sphere.thickest_km, "km", 0.0, 200.0,
           "sphere: thickest continental crust, whose deep part flows aside where there would be "
           "more; 0 sets no limit",
           "clark2000"),
      choice("plates.ocean_floor", ocean_floor, {"damping", "age"},
             "sphere: sea floor that sinks by damping, or as deep as its age", "stein1992"),
      real("plates.ridge_falloff", sphere.ridge_falloff, "1", 0.001, 1.0,
           "sphere: distance over which a ridge's profile halves, in radii of the planet",
           "cortial2019"),
      real("plates.ocean_damping_mm_yr", sphere.law.damping_mm_yr, "mm yr-1", 0.0, 10.0,
           "sphere: sinking of the sea floor, with damping", "cortial2019"),
      real("plates.continental_erosion_mm_yr", sphere.law.erosion_mm_yr, "mm yr-1", 0.0, 10.0,
           "sphere: erosion of the highest continents", "cortial2019"),
      choice(
          "plates.erosion", erosion, {"height", "land", "rivers"},
          "sphere: continents wear down by their height, and what lies below the sea fills up; "
          "the same on land alone; or rivers carve them between the steps and lay down what they "
          "carry",
          "cortial2019"),
      real("plates.river_erodibility_yr", sphere.rivers.erodibility_yr, "yr-1", 0.0, 1.0,
           "sphere: erodibility K for the square root of the drained area, with rivers",
           "whipple1999"),
      real("plates.settling_km", sphere.rivers.settling_km, "km", 1.0, 5000.0,
           "sphere: length over which the sea lays down most of what rivers bring, with rivers",
           "design"),
      real("plates.sediment_accretion_mm_yr", sphere.law.accretion_mm_yr, "mm yr-1", 0.0, 10.0,
           "sphere: growth of the wedge of sediment at trenches", "cortial2019"),
      real("plates.accretion_top_km", sphere.accretion_top_km, "km", -10.0, 0.0,
           "sphere: height up to which that wedge grows", "design"),
      real("plates.accretion_width_km", sphere.accretion_width_km, "km", 0.0, 1000.0,
           "sphere: width of that wedge", "design"),
      real("plates.arc_km", sphere.arc_km, "km", 5.0, 80.0,
           "sphere: thickness of an island arc's crust when it emerges", "christensen1995"),
      real("plates.plume_mm_yr", sphere.plume_mm_yr, "mm yr-1", 0.0, 100.0,
           "sphere: output of plumes below the sea floor, as the growth of one mound on floor at "
           "rest",
           "cortial2019"),
      real("plates.plume_km", sphere.plume_km, "km", 1.0, 1000.0,
           "sphere: distance from a plume over which that growth falls to a half", "design"),
      real("plates.volcano_km", sphere.volcano_km, "km", 1.0, 500.0,
           "sphere: distance from a volcano's middle over which its growth falls to a half, most "
           "of a sample's spacing at least",
           "tenbrink1991"),
      real("plates.volcano_spacing_km", sphere.volcano_spacing_km, "km", 1.0, 5000.0,
           "sphere: mean way of a plate from one volcano of a plume to the next", "tenbrink1991"),
      real("plates.island_wear_myr", sphere.island_wear_myr, "Myr", 0.0, 1000.0,
           "sphere: time in which volcanic islands wear down to 1/e of their height; 0 keeps them",
           "ramalho2013"),
      real(
          "plates.swell_decay_myr", sphere.swell_decay_myr, "Myr", 0.0, 1000.0,
          "sphere: time in which the sea floor sinks back to 1/e of what lifted it above the depth "
          "of its age, by age alone; 0 keeps it",
          "detrick1978"),
      real("plates.plume_top_km", sphere.plume_top_km, "km", -5.0, 10.0,
           "sphere: height that those volcanoes reach", "design"),
      real("plates.margin_km", sphere.margin_km, "km", 0.0, 1000.0,
           "sphere: width of the stretched crust where a continent breaks", "watts2001"),
      real("plates.margin_necking", sphere.margin_necking, "1", 1.0, 16.0,
           "sphere: how soon that crust is thin; above 1 most of the thinning is near the land",
           "peronpinvidic2013"),
      real("plates.margin_source_km", sphere.margin_source_km, "km", 1.0, 5000.0,
           "sphere: how far inland that crust flows from", "design"),
      real("plates.margin_thinning", sphere.margin_thinning, "1", 0.0, 0.5,
           "sphere: most that the crust inland thins for it, at the break", "design"),
      real("plates.rifts_myr", sphere.rift_per_myr, "Myr-1", 0.0, 1.0,
           "sphere: rate at which a wholly continental plate of mean size rifts", "cortial2019"),
      real("plates.rift_smallest", sphere.rift_smallest, "1", 0.0, 100.0,
           "sphere: plates smaller than this, in mean areas, do not rift", "design"),
      real("plates.rift_speed_mm_yr", sphere.rift_speed_mm_yr, "mm yr-1", 0.0, 1000.0,
           "sphere: speed at which fragments leave the middle of their plate", "design"),
      real("plates.rift_onset_myr", sphere.rift_onset_myr, "Myr", 0.0, 1000.0,
           "sphere: time in which they come to it; 0: at once", "brune2016"),
      real("plates.rift_warp_km", sphere.rift_warp_km, "km", 0.0, 5000.0,
           "sphere: how far the borders of fragments are warped", "cortial2019"),
      real("plates.subduction_initiation_myr", sphere.initiation_per_myr, "Myr-1", 0.0, 1.0,
           "sphere: rate at which each 1000 km of a passive margin with old floor become a "
           "subduction zone",
           "bradley2008"),
      real("plates.subduction_initiation_age_myr", sphere.initiation_age_myr, "Myr", 0.0, 5000.0,
           "sphere: age from which floor at a passive margin is so old", "bradley2008"),
      real("plates.subduction_initiation_speed_mm_yr", sphere.initiation_speed_mm_yr, "mm yr-1",
           0.0, 1000.0, "sphere: speed at which floor begins to subduct below its own continent",
           "stern2004"),
      real("plates.coast_warp_km", sphere.coast_warp_km, "km", 0.0, 2000.0,
           "sphere: how far the outline of crust that an event changes is warped, of a circle a "
           "fifth of its radius at most",
           "cortial2019"),
      real("plates.smallest_piece_km2", sphere.smallest_piece_km2, "km2", 0.0, 1e8,
           "sphere: smaller detached pieces of a plate join a neighbour", "design"),
      integer("plates.resampling_least", sphere.least_steps, "1", 1, 1000,
              "sphere: steps between resamplings, when a plate is as fast as any may be",
              "cortial2019"),
      integer("plates.resampling_most", sphere.most_steps, "1", 1, 1000,
              "sphere: most steps between resamplings", "cortial2019"),
  };
  for (Parameter& row : hypsography_parameters(*this)) rows.push_back(std::move(row));
  for (Parameter& row : raster_declarations(raster)) rows.push_back(std::move(row));
  return rows;
}

namespace {

class PlatesStage final : public Stage {
 public:
  explicit PlatesStage(PlatesParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kSeen = described({});
    static const StageInfo kDrifting = with_crust(true), kRaster = with_crust(false);
    static const StageInfo kStarting = with_ranking(kDrifting);
    static const StageInfo kFollowing = of_hypsography(kRaster);
    if (parameters_.model == "growth") return kSeen;
    if (parameters_.model == "raster") return kRaster;
    if (parameters_.model == "hypsography") return kFollowing;
    return parameters_.initial_elevation == "hypsography" ? kStarting : kDrifting;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }

  void run(StageIo& io, Context& context) const override {
    if (parameters_.model == "sphere") return drift(parameters_, info(), io, context);
    if (!context.plates.empty() || context.initial_elevation) {
      context.warnings.push_back(
          "fields.plates and fields.initial_elevation are for plates.model = sphere: not used");
    }
    if (parameters_.model == "hypsography") return draw_hypsography(parameters_, io, context);
    if (parameters_.model == "raster") return collide_rasters(parameters_, io, context);
    grow(parameters_, io, context);
  }

 private:
  /// Models with a history also write the crust that it made.
  static StageInfo with_crust(bool feels_events) {
    StageInfo info =
        described({&field::crust_elevation, &field::crust_thickness, &field::orogeny_age,
                   &field::fold_direction_east, &field::fold_direction_north,
                   &field::ridge_direction_east, &field::ridge_direction_north});
    info.feels_events = feels_events;
    return info;
  }
  static StageInfo described(std::initializer_list<const FieldSpec*> crust) {
    StageInfo info{"plates",
                   "tectonic plates, their motion, boundaries, sea floor and continents",
                   {},
                   {},
                   {&field::plate_id, &field::continental_fraction, &field::plate_velocity_east,
                    &field::plate_velocity_north, &field::boundary_type, &field::boundary_strength,
                    &field::crust_age, &field::orogeny_type, &field::heat_anomaly}};
    info.writes.insert(info.writes.end(), crust);
    return info;
  }
  static StageInfo with_ranking(StageInfo info) {
    info.optional.push_back(&field::ranking);
    return info;
  }
  /// Densities come with the heights; nothing moves that an event could turn.
  static StageInfo of_hypsography(StageInfo info) {
    info.writes.push_back(&field::crust_density);
    return with_ranking(std::move(info));
  }

  PlatesParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_plates_stage(PlatesParameters parameters) {
  return std::make_unique<PlatesStage>(std::move(parameters));
}

}  // namespace geo
