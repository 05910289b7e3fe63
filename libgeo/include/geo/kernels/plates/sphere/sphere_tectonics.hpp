#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/plates/sphere/plate_forces.hpp"
#include "geo/kernels/plates/sphere/sphere_mesh.hpp"
#include "geo/kernels/plates/sphere/sphere_partition.hpp"
#include "geo/kernels/plates/sphere/sphere_state.hpp"
#include "geo/kernels/plates/tectonic_laws.hpp"
#include "geo/kernels/water/surface_rivers.hpp"

namespace geo {

class GreatCircleLine;

/// Settings of the plates of a sphere through time.
struct SphereSettings {
  TectonicConstants law;
  double radius_km = 6370.0;
  bool driftworld_uplift = false;    ///< Driftworld's f instead of the piecewise one
  double uplift_control_km = 200.0;  ///< where subduction raises most
  double arc_reach_km = 1800.0;      ///< of the uplift where the overriding crust is oceanic
  double elevation_weight = 1.0;     ///< power of the factor h in the uplift
  double fold_per_km = 0.002;        ///< beta of the fold direction, per km of relative motion
  double slab_pull = 1e-3;           ///< epsilon, per Myr and 1000 km of trench
  bool by_forces = false;            ///< motion balances forces, in place of that
  PlateForces force;
  double penetration_km = 300.0;      ///< of continents, before they collide
  double suture_drag = 0.0;           ///< between them, over that below a plate
  double surge_km = 4.5;              ///< most that one collision lifts
  double thickest_km = 75.0;          ///< of continents: thicker roots spread; 0: no limit
  double oceanic_km = 7.0;            ///< thickness of new crust
  double arc_km = 25.0;               ///< thickness of an island arc when it emerges
  double ridge_falloff = 0.05;        ///< sigma of the ridge's profile, in radii
  bool floor_by_age = false;          ///< depth by GDH1 instead of damping
  double accretion_top_km = -3.0;     ///< up to which a trench's sediment piles
  double accretion_width_km = 100.0;  ///< of the wedge
  double margin_km = 120.0;           ///< width of stretched crust where a continent breaks
  double margin_necking = 1.0;        ///< exponent with which it thins: 1 or more
  double margin_source_km = 500.0;    ///< from which inland it flows there
  double margin_thinning = 0.18;      ///< most that the inland thins for it, at the break
  double rift_per_myr = 0.004;        ///< lambda_0
  double rift_smallest = 0.5;         ///< smaller plates, in mean areas, do not rift
  double rift_speed_mm_yr = 30.0;     ///< at which fragments part
  double rift_onset_myr = 0.0;        ///< in which they come to it
  double rift_warp_km = 400.0;        ///< of their borders
  double initiation_per_myr =
      0.01;  ///< rate at which 1000 km of old passive margin begin to subduct
  double initiation_age_myr = 120.0;     ///< from which floor at a passive margin is old
  double initiation_speed_mm_yr = 50.0;  ///< at which such floor subducts
  double coast_warp_km = 120.0;          ///< of crust that events change
  double mean_area_km2 = 1.27e7;         ///< A_0
  double smallest_piece_km2 = 5e5;       ///< detached pieces below join a neighbour
  double plume_mm_yr = 0.0;              ///< output of the first plumes, as growth of one mound
  double plume_km = 60.0;                ///< over which that would fall to a half
  double volcano_km = 30.0;              ///< over which the growth of one volcano does
  double volcano_spacing_km = 100.0;     ///< mean way of a plate from one volcano to the next
  double island_wear_myr = 6.0;          ///< in which ocean floor above the sea wears down to 1/e
  double swell_decay_myr = 30.0;  ///< the same of what lifted floor, with floor_by_age; 0: never
  double plume_top_km = 2.0;      ///< height that volcanoes of the sea floor reach
  // Rules of Driftworld in place of the paper's.
  bool rank_by_score = false;  ///< whole plates stay up by score(), not continents and young floor
  bool merge_plates = false;   ///< plates whose continents touch become one
  bool add_uplifts = false;    ///< of all subducting plates, not of the nearest alone
  bool fill_abyss = false;     ///< sediment piles on all floor below accretion_top_km
  bool rift_largest = false;   ///< only the largest plate rifts, into two, however much is land
  bool by_rivers = false;      ///< rivers carve and deposit, in place of erosion by height
  bool wears_land_alone = false;  ///< erosion by height leaves what lies below the sea as it is
  RiverLaw rivers;                ///< their step and rebound are the model's
  bool no_net_rotation = true;
  bool hold_motions = true;  ///< whether a plate goes on turning as it is told to
  std::int64_t least_steps = 10, most_steps = 60;  ///< between resamplings
  double rebound = 6.6;  ///< thickness of a root per height: rho_m / (rho_m - rho_c)
};

/// Sums over a step. Areas km2, volumes of continental crust km3.
struct SphereBudget {
  double time_myr = 0.0;
  int plates = 0;
  bool resampled = false;
  int collisions = 0, rifts = 0, subduction_initiations = 0;
  double area_error = 0.0;        ///< sum of the plates' areas over the sphere's, less 1
  double created_km2 = 0.0;       ///< new ocean floor
  double consumed_km2 = 0.0;      ///< ocean floor that had subducted
  double buried_km2 = 0.0;        ///< continents thrust below others
  double ocean_change_km2 = 0.0;  ///< of the oceanic area, measured
  double ocean_error_km2 = 0.0;   ///< created - consumed - turned into continent - change
  double emerged_km2 = 0.0;       ///< ocean floor that became continental
  double continental_km3 = 0.0;   ///< volume of continental crust at the end of the step
  double accreted_km3 = 0.0;      ///< sediment that the wedges behind trenches grew by
  double raised_km3 = 0.0;        ///< added by subduction: magma and accretion
  double eroded_km3 = 0.0;
  double deposited_km3 = 0.0;   ///< laid on continents and their shelves by rivers
  double sea_floor_km3 = 0.0;   ///< laid on ocean floor by rivers
  double emerged_km3 = 0.0;     ///< of arcs when they became continental
  double stretched_km2 = 0.0;   ///< margins that broken continents grew
  double swallowed_km3 = 0.0;   ///< moved by collisions from roots into mountains
  double changed_km3 = 0.0;     ///< made or taken by change_crust
  double erupted_km3 = 0.0;     ///< that plumes laid on ocean floor
  double lost_km3 = 0.0;        ///< subducted below floor, or from roots that found no room
  double resampling_km3 = 0.0;  ///< what interpolation added or took
};

/// A happening worth telling.
struct SphereEvent {
  enum class Kind { collision, rift, subduction_initiation } kind;
  double time_myr;
  int first, second;  ///< plates: terrane's and collided one, or the plate that broke and -1
  Vector3 place;      ///< centroid, unit vector
  double area_km2;    ///< of the terrane or plate
};

/// Plates on a sphere through time: the model of "Procedural Tectonic Planets" (Cortial, Peytavie,
/// Galin & Guerin 2019) on the samples of a Fibonacci sphere.
///
/// Samples stay where they are in the frame of their plate, which turns as a rigid body. Whether
/// two plates overlap is asked of the lattice: a sample carried into another plate's frame lies
/// over the sample nearest to it. Only samples in blocks that may touch another plate are asked.
/// The top of an overlap is the continental crust, of two oceans the plate whose floor was younger
/// when they met, of two continents the plate that carries more of it. From time to time all is
/// resampled at the lattice's places, where new floor fills what has opened.
///
/// Results do not depend on the number of threads. Cost: linear in samples.
class SphereTectonics {
 public:
  /// Takes the state over. Throws Bug when it does not fit the mesh.
  SphereTectonics(const SphereMesh& mesh, const SphereSettings& settings, SphereState state,
                  std::uint64_t seed);

  /// Takes the common rotation of the plates away that are not held, but for what they keep.
  void subtract_net_rotation();
  /// Opens the budget of the next step and, with settings.no_net_rotation, subtracts that. What is
  /// done to the model from outside before advance() is in that budget. advance() does it where it
  /// has not been done.
  void begin_step();
  /// One step of settings.law.step_myr.
  void advance();
  /// Resamples the crust at the places of the lattice and fills gaps with new floor.
  void resample();
  /// Resamples unless the last step has; the budget is that of this alone.
  void finish();
  /// Splits a plate by the nearest of some places, warped. Fragments leave each other across the
  /// fractures between them, each at the speed.
  void rift(int plate, std::span<const Vector3> places, double speed_mm_yr);
  /// Splits a plate along a line; with three or four fragments the sides are cut across at the
  /// middle of the line, the right one first. They part as ever.
  void rift_along(int plate, const GreatCircleLine& line, int fragments, double speed_mm_yr);

  /// Whether a sample stays above one of another plate where the two meet.
  [[nodiscard]] bool is_on_top(std::int32_t sample, std::int32_t other) const;
  /// The plate that is on top at a place, or -1 in a gap.
  [[nodiscard]] int plate_at(const Vector3& place) const;
  /// From now on a plate turns about an axis (unit vector), rad/Myr. With settings.hold_motions it
  /// is held, and the others keep the common rotation that they have without it.
  void set_motion(int plate, const Vector3& axis, double speed_rad_myr);
  /// Holds all plates as they move now.
  void hold_motions();
  /// The crust at all places (unit vectors) of which something holds becomes continental or
  /// oceanic, whatever its plates. Places are asked for as far as `warp_km` beside where they are,
  /// so that coasts bend. Returns the area that changed, km2.
  double change_crust(const std::function<bool(const Vector3&)>& holds, bool continental,
                      double warp_km = 0.0);
  /// Torques on a plate about the planet's centre, in the frame of the planet.
  struct Torques {
    Matrix3 drag_n_m_s{};   ///< (eta / h) R^4 int f (1 - r r^T) dA, times rotation in rad/s
    Vector3 driving_n_m{};  ///< R^2 closed int F dl of slabs, ridges and sutures
  };
  /// Those of settings.force on each plate with all that it carries, as of the last step. Floor
  /// that opens between resamplings counts as there: it pushes up to where it has its age.
  [[nodiscard]] std::vector<Torques> torques() const;
  /// Driftworld's rank of a plate with all that it carries: a hundred for each sample of continent
  /// less one for each of floor.
  [[nodiscard]] double score(int plate) const { return score_[plate]; }
  /// Area of each plate with all that it carries, km2; 0 of those that are no more.
  [[nodiscard]] std::vector<double> plate_areas_km2() const;

  [[nodiscard]] const SphereState& state() const noexcept { return state_; }
  /// For what changes a state from outside, between steps; call repartition() after changing
  /// plates.
  [[nodiscard]] SphereState& state() noexcept { return state_; }
  void repartition();
  [[nodiscard]] const SphereMesh& mesh() const noexcept { return *mesh_; }
  [[nodiscard]] const SphereSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const SphereBudget& budget() const noexcept { return budget_; }
  [[nodiscard]] const std::vector<SphereEvent>& events() const noexcept { return events_; }
  [[nodiscard]] const SpherePartition& partition() const noexcept { return partition_; }
  /// Rotation of each plate, rad/Myr, in the frame of the planet.
  [[nodiscard]] const std::vector<Vector3>& rotations() const noexcept { return rotation_; }
  /// Sample of another plate that lies at the same place, or -1, as of the last step.
  [[nodiscard]] std::span<const std::int32_t> partners() const noexcept { return partner_; }
  /// Whether a sample lies below its partner.
  [[nodiscard]] std::span<const std::uint8_t> hidden() const noexcept { return hidden_; }

  /// A sample at the edge of an overriding plate, above a subducting one: a trench, or where
  /// continents meet the deformation front.
  struct TrenchSample {
    std::int32_t sample;      ///< of the overriding plate
    std::int16_t lower;       ///< subducting plate
    float lower_elevation_m;  ///< of its crust there
  };
  [[nodiscard]] const std::vector<TrenchSample>& trenches() const noexcept { return trenches_; }
  /// The nearest trench of the same plate to each sample, or -1.
  [[nodiscard]] std::span<const std::int32_t> nearest_trench() const noexcept { return trench_of_; }

 private:
  class EdgeForces;
  class TrenchUplift;
  class GapHistory;
  class MovingSurface;
  void move();
  void set_frames();
  void rank_plates();
  void find_contacts();
  void decide_pairs();
  void find_trenches();
  void spread_trenches();
  void spread(int plate, std::span<const std::int32_t> trenches,
              std::vector<std::int32_t>* reached);
  [[nodiscard]] float farthest_chord2() const;
  void add_uplifts(const TrenchUplift& uplift);
  void raise();
  void erupt();
  struct Eruption {
    Vector3 place;
    double volume_km3;
  };
  [[nodiscard]] std::vector<Eruption> eruptions(SpherePlume& plume, const Vector3& rotation) const;
  void grow_volcano(int plate, const Vector3& place, double volume_km3);
  void run_rivers();
  void pull_slabs();
  [[nodiscard]] Matrix3 drag_below(int plate) const;
  [[nodiscard]] std::vector<Matrix3> drag_below() const;
  [[nodiscard]] std::vector<Matrix3> balance_forces();
  /// What holds two plates together: a drag on how they move beside each other, in units of that
  /// below one sample.
  struct Link {
    int first, second;
    Matrix3 drag;
  };
  [[nodiscard]] std::vector<Link> links_of_rifts(const std::vector<Matrix3>& drag) const;
  [[nodiscard]] std::vector<Link> links_of_continents() const;
  void yield(const std::vector<Matrix3>& drag);
  void collide();
  void collide(std::int32_t sample);
  [[nodiscard]] double penetration_km(std::int32_t sample) const;
  [[nodiscard]] const PlatePair& pair_of(std::int32_t sample) const;
  void remember_penetration();
  void surge(int upper, std::span<const std::int32_t> terrane, const Vector3& centroid,
             double area_km2, double speed_mm_yr);
  void spread_roots();
  void rift_by_chance();
  [[nodiscard]] int largest_plate() const;
  [[nodiscard]] std::vector<Vector3> across_fractures(int plate,
                                                      std::span<const std::int8_t> fragment,
                                                      int fragments, const Vector3& about) const;
  [[nodiscard]] std::size_t fragment_nearest(int body, int plate,
                                             std::span<const std::int8_t> fragment) const;
  bool part(int plate, std::span<const std::int8_t> fragment, std::span<const Vector3> away,
            double speed_mm_yr, SphereEvent::Kind kind);
  [[nodiscard]] std::vector<std::int32_t> old_margins() const;
  void initiate_subduction_by_chance();
  void initiate_subduction(std::int32_t start);
  [[nodiscard]] Vector3 driven_rotation(int plate) const;
  [[nodiscard]] Vector3 net_rotation() const;
  void fill_gaps(SphereCrust& now, std::vector<std::int16_t>& owner,
                 std::span<const std::int16_t> body);
  void stretch_margins(std::span<const std::int32_t> gaps, std::span<const std::int32_t> nearest,
                       SphereCrust& now, std::span<const std::int16_t> owner);
  void tidy_pieces();
  void measure_volume();
  [[nodiscard]] bool is_due() const;
  [[nodiscard]] double distance_km(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] double sample_km2() const;
  [[nodiscard]] std::vector<std::int32_t> terrane_of(std::int32_t sample) const;

  const SphereMesh* mesh_;
  SphereSettings settings_;
  SphereState state_;
  std::uint64_t seed_;
  Noise warp_, coasts_;
  SphereBudget budget_;
  bool has_begun_ = false;  // the next step
  std::vector<SphereEvent> events_;
  SpherePartition partition_;
  std::vector<Matrix3> frame_;     // of each plate
  std::vector<Vector3> rotation_;  // of each plate, rad/Myr
  std::vector<std::int32_t> partner_, contacts_, trench_of_;
  std::vector<std::uint8_t> hidden_;
  std::vector<TrenchSample> trenches_;
  std::vector<double> score_;     // of each plate
  std::vector<float> uplift_km_;  // of each sample in a step, where uplifts add up
  std::vector<float> chord2_;
  /// What spreading trenches asks of a sample, in one place of memory.
  struct Spot {
    float x, y, z, chord2;  // of the nearest trench so far
    std::int32_t trench;
    std::int16_t plate;  // -1 also below another plate
  };
  std::vector<Spot> spots_;
};

}  // namespace geo
