#include "geo/stages/plates/plates.hpp"

#include <algorithm>
#include <array>

#include "hypsography.hpp"
#include "stages/plates/growth/growth.hpp"
#include "stages/plates/raster/raster.hpp"
#include "stages/plates/sphere/sphere.hpp"

namespace geo {

std::vector<Parameter> PlatesParameters::declarations() {
  std::vector<Parameter> rows{
      choice("plates.model", model, {"growth", "sphere", "raster", "hypsography"},
             "how plates come about: they grow as they stand today; drift, subduct, "
             "collide and break on a sphere through time; drift and collide as height maps on a "
             "torus; or there is one at rest whose heights follow a hypsography",
             "cortial2019"),
      integer("plates.count", growth.count, "1", 1, 100, "number of plates", "tectonica2026"),
      real("plates.speed_cm_yr", growth.speed_cm_yr, "cm yr-1", 0.1, 50.0,
           "middle of the plates' speeds", "tectonica2026"),
      real("plates.growth.mantle_heat", growth.mantle_heat, "1", 0.0, 1.0,
           "how much hotter than the least the mantle below a plate may be", "tectonica2026"),
      real("plates.growth.size_spread", growth.size_spread, "1", 0.0, 3.0,
           "standard deviation of the logarithm of the plates' bias in size", "bird2003"),
      real("plates.growth.roughness", growth.roughness, "1", 0.0, 2.0,
           "roughness of the cost at which plates grow", "tectonica2026"),
      real("plates.growth.structure_km", growth.structure_km, "km", 50.0, 20000.0,
           "wavelength of weak and strong zones that plates grow along and around",
           "tectonica2026"),
      real("plates.growth.polar_resistance", growth.polar_resistance, "1", 0.0, 1.0,
           "extra cost of growth at the poles", "tectonica2026"),
      integer(
          "plates.growth.centre_candidates", growth.centre_candidates, "1", 1, 1000,
          "places drawn for each plate, of which it begins at the one farthest from its elders; "
          "1: anywhere",
          "tectonica2026"),
      real("plates.growth.smallest_part_km2", growth.smallest_part_km2, "km2", 0.0, 1e8,
           "smaller detached pieces of a plate join a neighbour at once, larger ones when all "
           "plates "
           "have moved",
           "tectonica2026"),
      flag("plates.no_net_rotation", no_net_rotation, "take the common rotation of all plates away",
           "bird2003"),
      integer("plates.growth.evolution_steps", evolution_steps, "1", 0, 100,
              "steps of 0.9 to 3.4 Myr in which the grown plates move", "tectonica2026"),
      real("plates.boundary_smoothing_km", boundary_smoothing_km, "km", 50.0, 2000.0,
           "length over which direction and motion of a boundary are taken", "design"),
      real("plates.boundary_width_km", boundary_width_km, "km", 10.0, 200.0,
           "width of the band of cells that count as boundary", "tectonica2026"),
      real("plates.growth.outline_bending_km", outline_bending_km, "km", 0.0, 200.0,
           "how far the outlines of plates bend below the resolution they grow at", "design"),
      choice("plates.continents", continents, {"cratons", "plates"},
             "continents grow together from cratons, or are whole plates", "tectonica2026"),
      real("plates.continental_share", cratons.share, "1", 0.0, 1.0,
           "share of the planet that is continental crust, with cratons", "cogley1984"),
      real("plates.growth.land_buffer", land_buffer, "1", 0.0, 1.0,
           "share of continental crust beyond that of land, with whole plates", "tectonica2026"),
      real("plates.growth.cratons_per_planet", cratons.per_sphere, "1", 1.0, 500.0,
           "number of cratons if every plate carried some", "design"),
      real("plates.growth.craton_smallest_km", cratons.smallest_km, "km", 50.0, 5000.0,
           "least radius of a craton", "artemieva2001"),
      real("plates.growth.craton_largest_km", cratons.largest_km, "km", 50.0, 5000.0,
           "largest radius of a craton", "artemieva2001"),
      real("plates.growth.ridge_clearance_km", cratons.ridge_clearance_km, "km", 0.0, 5000.0,
           "length over which a spreading ridge thins out continents", "design"),
      real("plates.growth.coast_roughness", coast_roughness, "1", 0.0, 5.0,
           "deviation of the noise that frays the continents' edges, in e-foldings of a craton",
           "design"),
      real("plates.growth.coast_wavelength_km", coast_wavelength_km, "km", 50.0, 20000.0,
           "longest wavelength of that noise", "design"),
      real("plates.growth.passive_margin_km", passive_margin_km, "km", 1.0, 2000.0,
           "width of a margin far from convergent boundaries", "watts2001"),
      real("plates.growth.active_margin_km", active_margin_km, "km", 1.0, 2000.0,
           "width of a margin at a convergent boundary", "watts2001"),
      real("plates.oldest_floor_myr", oldest_floor_myr, "Myr", 1.0, 5000.0,
           "age that the sea floor approaches far from its ridge", "muller2008"),
      real("plates.plumes", plumes, "1", 0.0, 200.0, "number of mantle plumes", "design"),
      real("plates.growth.orogeny_reach_km", orogeny_reach_km, "km", 0.0, 5000.0,
           "distance from a convergent boundary within which a continent belongs to its orogen",
           "england1982"),
      integer("plates.sphere.samples", samples, "1", 500, 8'000'000,
              "samples of crust on the whole planet", "cortial2019"),
      real("plates.sphere.time_myr", time_myr, "Myr", 0.0, 5000.0, "how long plates drift",
           "cortial2019"),
      real("plates.sphere.frames_myr", frames_myr, "Myr", 0.0, 5000.0,
           "time between the frames that are written; 0 writes none", "design"),
      real("plates.sphere.time_step_myr", sphere.law.step_myr, "Myr", 0.01, 50.0, "time step",
           "cortial2019"),
      real("plates.sphere.warp_km", start.warp_km, "km", 0.0, 5000.0,
           "how far the borders of the first plates are warped", "cortial2019"),
      real("plates.continent_km", start.continent_km, "km", 500.0, 40000.0,
           "wavelength of the first continents, unless they are whole plates", "design"),
      real("plates.sphere.smallest_sea_km2", start.smallest_sea_km2, "km2", 0.0, 1e8,
           "smaller seas that the first continents' noise encloses are land; 0 closes none",
           "design"),
      real("plates.sphere.first_crust_km", start.continental_km, "km", 5.0, 80.0,
           "thickness of the first continents", "laske2013"),
      real("plates.sphere.fastest_mm_yr", sphere.law.speed_mm_yr, "mm yr-1", 1.0, 1000.0,
           "speed of the fastest plate", "cortial2019"),
      real("plates.sphere.ridge_elevation_km", sphere.law.ridge_km, "km", -20.0, 0.0,
           "highest oceanic ridge", "cortial2019"),
      real("plates.sphere.abyss_elevation_km", sphere.law.abyss_km, "km", -20.0, 0.0,
           "abyssal plains", "cortial2019"),
      real("plates.sphere.trench_elevation_km", sphere.law.trench_km, "km", -30.0, -0.1,
           "deepest trench", "cortial2019"),
      real("plates.sphere.summit_elevation_km", sphere.law.summit_km, "km", 0.1, 30.0,
           "highest continent", "cortial2019"),
      real("plates.sphere.subduction_distance_km", sphere.law.subduction_distance_km, "km", 10.0,
           10000.0, "distance from the trench over which subduction raises the overriding plate",
           "cortial2019"),
      real("plates.sphere.subduction_uplift_mm_yr", sphere.law.uplift_mm_yr, "mm yr-1", 0.0, 100.0,
           "uplift above subduction, before the factors of distance, speed and elevation",
           "cortial2019"),
      choice("plates.sphere.given_motions", given_motions, {"held", "first"},
             "plates that fields.plates or an event gives a motion keep it until another "
             "event, or begin with it as all others do",
             "cortial2019"),
      choice("plates.sphere.uplift_profile", uplift_profile, {"piecewise", "driftworld"},
             "uplift over the distance from the trench, by two cubics or by Driftworld's one",
             "cortial2019"),
      choice("plates.sphere.overlap", overlap, {"crust", "score"},
             "what stays up where plates overlap: continents and the younger floor, or, as "
             "in Driftworld, the whole plate that has more continent",
             "cortial2019"),
      choice("plates.sphere.collisions", collisions, {"terranes", "plates"},
             "continents that collide leave their plate behind, or, as in Driftworld, their "
             "plates become one as soon as they touch",
             "cortial2019"),
      choice("plates.sphere.uplift_sources", uplift_sources, {"nearest", "all"},
             "uplift is that of the nearest trench, or, as in Driftworld, the sum over all "
             "subducting plates",
             "cortial2019"),
      choice("plates.sphere.accretion", accretion, {"wedge", "abyss"},
             "sediment piles in the wedge behind trenches, or, as in Driftworld, on all floor "
             "below plates.sphere.accretion_top_km",
             "cortial2019"),
      choice("plates.sphere.rifting", rifting, {"any", "largest"},
             "any plate may rift, or, as in Driftworld, the largest alone, into two",
             "cortial2019"),
      real("plates.sphere.uplift_control_km", sphere.uplift_control_km, "km", 1.0, 5000.0,
           "distance from the trench at which subduction raises most", "cortial2019"),
      real("plates.sphere.arc_reach_km", sphere.arc_reach_km, "km", 10.0, 10000.0,
           "distance from the trench over which subduction raises an overriding plate of ocean "
           "floor",
           "cortial2019"),
      real("plates.sphere.elevation_weight", sphere.elevation_weight, "1", 0.0, 4.0,
           "power of the factor by which the elevation of the subducting crust raises the "
           "overriding plate",
           "cortial2019"),
      real("plates.sphere.fold_turning_km", sphere.fold_per_km, "km-1", 0.0, 1.0,
           "weight of the relative motion in the direction of folds, per kilometre", "cortial2019"),
      real("plates.sphere.slab_pull_myr", sphere.slab_pull, "Myr-1", 0.0, 1.0,
           "turning of a plate's axis by each 1000 km of its trenches", "cortial2019"),
      flag("plates.sphere.forces", sphere.by_forces,
           "motion follows the balance of slabs, ridges and sutures with the mantle's drag, "
           "in place of the turning by slabs",
           "forsyth1975"),
      real("plates.sphere.slab_share", sphere.force.slab_share, "1", 0.0, 1.0,
           "share of a slab's weight that reaches its plate, with forces", "forsyth1975"),
      real("plates.sphere.suction_share", sphere.force.suction_share, "1", 0.0, 1.0,
           "share of a slab's weight that draws the plate above it to the trench, with "
           "forces",
           "conrad2002"),
      real("plates.sphere.slab_km", sphere.force.slab_km, "km", 0.0, 3000.0,
           "length of the slab that pulls, with forces", "turcotte2002"),
      real("plates.sphere.asthenosphere_pa_s", sphere.force.viscosity_pa_s, "Pa s", 1e17, 1e23,
           "viscosity of the asthenosphere, with forces", "turcotte2002"),
      real("plates.sphere.asthenosphere_km", sphere.force.asthenosphere_km, "km", 10.0, 1000.0,
           "thickness of the asthenosphere, with forces", "turcotte2002"),
      real("plates.sphere.continental_drag", sphere.force.continental_drag, "1", 0.1, 100.0,
           "drag below continents over that below oceans, with forces", "forsyth1975"),
      real("plates.sphere.suture_n_m", sphere.force.collision_n_m, "N m-1", 0.0, 1e14,
           "resistance of a suture to the continents that meet there, with forces", "copley2010"),
      real("plates.sphere.force_response_myr", sphere.force.response_myr, "Myr", 0.01, 1000.0,
           "time in which motion follows the forces", "design"),
      real("plates.sphere.penetration_km", sphere.penetration_km, "km", 0.0, 5000.0,
           "how far one continent is thrust below another before they collide", "cortial2019"),
      real("plates.sphere.suture_drag", sphere.suture_drag, "1", 0.0, 1e6,
           "drag between continents of which one is thrust below the other, over that of "
           "the mantle below a plate; 0: they do not slow each other",
           "copley2010"),
      real("plates.sphere.collision_distance_km", sphere.law.collision_distance_km, "km", 0.0,
           20000.0, "farthest reach of a collision", "cortial2019"),
      real("plates.sphere.collision_coefficient_km", sphere.law.collision_per_km, "km-1", 0.0, 1.0,
           "height of a collision's surge per area of the terrane", "cortial2019"),
      real("plates.sphere.surge_km", sphere.surge_km, "km", 0.0, 20.0,
           "most that one collision lifts", "christensen1995"),
      real("plates.sphere.thickest_km", sphere.thickest_km, "km", 0.0, 200.0,
           "thickest continental crust: lower-crustal flow spreads what would be thicker; 0 "
           "sets no limit",
           "clark2000"),
      choice("plates.sphere.ocean_floor", ocean_floor, {"damping", "age"},
             "sea floor that sinks by damping, or as deep as its age", "stein1992"),
      real("plates.sphere.ridge_falloff", sphere.ridge_falloff, "1", 0.001, 1.0,
           "distance over which a ridge's profile halves, in radii of the planet", "cortial2019"),
      real("plates.sphere.ocean_damping_mm_yr", sphere.law.damping_mm_yr, "mm yr-1", 0.0, 10.0,
           "sinking of the sea floor, with damping", "cortial2019"),
      real("plates.sphere.continental_erosion_mm_yr", sphere.law.erosion_mm_yr, "mm yr-1", 0.0,
           10.0, "erosion of the highest continents", "cortial2019"),
      choice(
          "plates.sphere.erosion", erosion, {"height", "land", "rivers"},
          "continents wear down by their height, and what lies below the sea fills up; "
          "the same on land alone; or rivers carve them between the steps and lay down what they "
          "carry",
          "cortial2019"),
      real("plates.sphere.river_erodibility_yr", sphere.rivers.erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility K for the square root of the drained area, with rivers", "whipple1999"),
      real("plates.sphere.settling_km", sphere.rivers.settling_km, "km", 1.0, 5000.0,
           "length over which the sea lays down most of what rivers bring, with rivers", "design"),
      real("plates.sphere.sediment_accretion_mm_yr", sphere.law.accretion_mm_yr, "mm yr-1", 0.0,
           10.0, "growth of the wedge of sediment at trenches", "cortial2019"),
      real("plates.sphere.accretion_top_km", sphere.accretion_top_km, "km", -10.0, 0.0,
           "height up to which that wedge grows", "design"),
      real("plates.sphere.accretion_width_km", sphere.accretion_width_km, "km", 0.0, 1000.0,
           "width of that wedge", "design"),
      real("plates.sphere.arc_km", sphere.arc_km, "km", 5.0, 80.0,
           "thickness of an island arc's crust when it emerges", "christensen1995"),
      real("plates.sphere.plume_mm_yr", sphere.plume_mm_yr, "mm yr-1", 0.0, 100.0,
           "output of plumes below the sea floor, as the growth of one mound on floor at "
           "rest",
           "cortial2019"),
      real("plates.sphere.plume_km", sphere.plume_km, "km", 1.0, 1000.0,
           "distance from a plume over which that growth falls to a half", "design"),
      real("plates.sphere.volcano_km", sphere.volcano_km, "km", 1.0, 500.0,
           "distance from a volcano's middle over which its growth falls to a half, most "
           "of a sample's spacing at least",
           "tenbrink1991"),
      real("plates.sphere.volcano_spacing_km", sphere.volcano_spacing_km, "km", 1.0, 5000.0,
           "mean way of a plate from one volcano of a plume to the next", "tenbrink1991"),
      real("plates.sphere.island_wear_myr", sphere.island_wear_myr, "Myr", 0.0, 1000.0,
           "time in which volcanic islands wear down to 1/e of their height; 0 keeps them",
           "ramalho2013"),
      real("plates.sphere.swell_decay_myr", sphere.swell_decay_myr, "Myr", 0.0, 1000.0,
           "time in which the sea floor sinks back to 1/e of what lifted it above the depth "
           "of its age, by age alone; 0 keeps it",
           "detrick1978"),
      real("plates.sphere.plume_top_km", sphere.plume_top_km, "km", -5.0, 10.0,
           "height that those volcanoes reach", "design"),
      real("plates.sphere.margin_km", sphere.margin_km, "km", 0.0, 1000.0,
           "width of the stretched crust where a continent breaks", "watts2001"),
      real("plates.sphere.margin_necking", sphere.margin_necking, "1", 1.0, 16.0,
           "how soon that crust is thin; above 1 most of the thinning is near the land",
           "peronpinvidic2013"),
      real("plates.sphere.margin_source_km", sphere.margin_source_km, "km", 1.0, 5000.0,
           "how far inland that crust flows from", "design"),
      real("plates.sphere.margin_thinning", sphere.margin_thinning, "1", 0.0, 0.5,
           "most that the crust inland thins for it, at the break", "design"),
      real("plates.sphere.rifts_myr", sphere.rift_per_myr, "Myr-1", 0.0, 1.0,
           "rate at which a wholly continental plate of mean size rifts", "cortial2019"),
      real("plates.sphere.rift_smallest", sphere.rift_smallest, "1", 0.0, 100.0,
           "plates smaller than this, in mean areas, do not rift", "design"),
      real("plates.sphere.rift_speed_mm_yr", sphere.rift_speed_mm_yr, "mm yr-1", 0.0, 1000.0,
           "speed at which fragments leave the middle of their plate", "design"),
      real("plates.sphere.rift_onset_myr", sphere.rift_onset_myr, "Myr", 0.0, 1000.0,
           "time in which they come to it; 0: at once", "brune2016"),
      real("plates.sphere.rift_warp_km", sphere.rift_warp_km, "km", 0.0, 5000.0,
           "how far the borders of fragments are warped", "cortial2019"),
      real("plates.sphere.subduction_initiation_myr", sphere.initiation_per_myr, "Myr-1", 0.0, 1.0,
           "rate at which each 1000 km of a passive margin with old floor become a "
           "subduction zone",
           "bradley2008"),
      real("plates.sphere.subduction_initiation_age_myr", sphere.initiation_age_myr, "Myr", 0.0,
           5000.0, "age from which floor at a passive margin is so old", "bradley2008"),
      real("plates.sphere.subduction_initiation_speed_mm_yr", sphere.initiation_speed_mm_yr,
           "mm yr-1", 0.0, 1000.0, "speed at which floor begins to subduct below its own continent",
           "stern2004"),
      real("plates.sphere.coast_warp_km", sphere.coast_warp_km, "km", 0.0, 2000.0,
           "how far the outline of crust that an event changes is warped, of a circle a "
           "fifth of its radius at most",
           "cortial2019"),
      real("plates.sphere.smallest_piece_km2", sphere.smallest_piece_km2, "km2", 0.0, 1e8,
           "smaller detached pieces of a plate join a neighbour", "design"),
      integer("plates.sphere.resampling_least", sphere.least_steps, "1", 1, 1000,
              "steps between resamplings, when a plate is as fast as any may be", "cortial2019"),
      integer("plates.sphere.resampling_most", sphere.most_steps, "1", 1, 1000,
              "most steps between resamplings", "cortial2019"),
  };
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
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    constexpr double kMesh_s = 0.45;     // plates that grow, on a mesh of their own
    constexpr double kDrift_ns = 190.0;  // per sample and million years
    constexpr double kRaster_s = 3.0;
    const std::string& model = parameters_.model;
    const double drift_s =
        1e-9 * kDrift_ns * static_cast<double>(parameters_.samples) * parameters_.time_myr;
    return {.per_cell_ns = 500.0,
            .fixed_s = model == "sphere"   ? drift_s
                       : model == "raster" ? kRaster_s
                       : model == "growth" ? kMesh_s
                                           : 0.0,
            .cell_bytes = 60.0};
  }

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
  static StageInfo with_crust(bool drifts) {
    StageInfo info =
        described({&field::crust_elevation, &field::crust_thickness, &field::orogeny_age,
                   &field::fold_direction_east, &field::fold_direction_north,
                   &field::ridge_direction_east, &field::ridge_direction_north});
    info.feels_events = drifts;
    if (drifts) info.writes.push_back(&field::subduction_polarity);
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
