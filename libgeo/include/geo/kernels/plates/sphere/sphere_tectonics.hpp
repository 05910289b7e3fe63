#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geo/kernels/plates/sphere/plate_change.hpp"
#include "geo/kernels/plates/sphere/sphere_budget.hpp"
#include "geo/kernels/plates/sphere/sphere_mesh.hpp"
#include "geo/kernels/plates/sphere/sphere_partition.hpp"
#include "geo/kernels/plates/sphere/sphere_settings.hpp"
#include "geo/kernels/plates/sphere/sphere_state.hpp"

namespace geo {

class GreatCircleLine;

/// A sample at the edge of an overriding plate, above a subducting one: a trench, or where
/// continents meet the deformation front.
struct TrenchSample {
  std::int32_t sample;      ///< of the overriding plate
  std::int16_t lower;       ///< subducting plate
  float lower_elevation_m;  ///< of its crust there
};

/// Where plates lay over each other when they had moved in the last step. Nowhere once the crust
/// has been resampled. Vectors of each sample have the mesh's size.
struct SphereMargins {
  std::vector<std::int32_t> contacts;        ///< samples with another plate at the same place
  std::vector<std::int32_t> partner;         ///< of each sample: the other plate's there, or -1
  std::vector<std::uint8_t> hidden;          ///< of each sample: lies below its partner
  std::vector<TrenchSample> trenches;        ///< in the order of the contacts
  std::vector<std::int32_t> nearest_trench;  ///< of each sample: of its plate, in reach, or -1
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
///
/// All that there is of a model stands here to be read. What its functions derive from the plates
/// is always that of the plates as they are: whatever changes which samples are whose, how plates
/// have turned or how they move is one of the functions below, and derives it anew before it
/// returns. Fields of the crust, plumes and lives may be changed from outside between steps.
struct SphereTectonics {
  /// Takes the state over and derives the rest. Throws Bug when it does not fit the mesh.
  SphereTectonics(const SphereMesh& mesh, const SphereSettings& settings, SphereState state,
                  std::uint64_t seed);

  // Given.
  const SphereMesh* mesh;  ///< with the samples; outlives the model
  SphereSettings settings;
  std::uint64_t seed;

  /// What a run needs to go on: crust, plates, plumes, clock.
  SphereState state;

  // Derived from the plates of the state, by their place there.
  SpherePartition partition;      ///< which samples are whose
  std::vector<Matrix3> frame;     ///< from a plate's own frame to that of the planet
  std::vector<Vector3> rotation;  ///< rad/Myr, in the frame of the planet
  /// Driftworld's rank of a plate with all that it carries: a hundred for each sample of continent
  /// less one for each of floor.
  std::vector<double> score;

  /// Derived from the mesh for rivers, else empty: length of each way between neighbours, m.
  std::vector<float> way_m;

  /// Derived from where the last step has moved them.
  SphereMargins margins;

  // What has happened.
  SphereBudget budget;              ///< of the last step, or of the one that has begun
  bool has_begun = false;           ///< whether the budget of the next step is open
  std::vector<SphereEvent> events;  ///< all that have happened so far
  PlateStep step;                   ///< the last one, or the one that has begun

  /// Area that each sample stands for.
  [[nodiscard]] double sample_km2() const;
  /// Great-circle distance of two samples in the frame of one plate.
  [[nodiscard]] double distance_km(std::int32_t a, std::int32_t b) const;
};

// Through time.

/// Opens the budget of the next step and, with settings.no_net_rotation, subtracts that. What is
/// done to the model from outside before advance() is in that budget. advance() does it where it
/// has not been done.
void begin_step(SphereTectonics& model);
/// One step of settings.law.step_myr.
void advance(SphereTectonics& model);
/// Resamples the crust at the places of the lattice and fills gaps with new floor.
void resample(SphereTectonics& model);
/// Resamples unless the last step has; the budget is that of this alone.
void finish(SphereTectonics& model);

// Through time, led by the plates of another model.

/// Plates that move, break and collide as those of a leader: the same planet on other samples. The
/// motion of plates amplifies any difference, so that two models that each decide for themselves
/// part, however fine they are; led, they have the same plates. The follower's crust is its own:
/// it is raised, worn, thickened and resampled where its own samples lie.
///
/// Takes the leader's plates over. The crust of both has just been resampled, or made: each
/// connected piece of the follower's continents and floors comes to the plate that holds most of
/// it on the leader's samples, and floor to that which holds it well within its borders. So borders
/// between floors differ by no more than a spacing of the leader's samples.
void follow(SphereTectonics& follower, const SphereTectonics& leader);
/// begin_step() of both. What is done to plates after it is done to the leader alone, what is done
/// to crust and plumes to both.
void begin_step_of_both(SphereTectonics& follower, SphereTectonics& leader);
/// advance() of both.
void advance_both(SphereTectonics& follower, SphereTectonics& leader);
/// finish() of both.
void finish_both(SphereTectonics& follower, SphereTectonics& leader);

// What is done to the model from outside, between steps.

/// Takes the common rotation of the plates away that are not held, but for what they keep.
void subtract_net_rotation(SphereTectonics& model);
/// From now on a plate turns about an axis (unit vector), rad/Myr. With settings.hold_motions it
/// is held, and the others keep the common rotation that they have without it. No reconstruction
/// drives it any more.
void set_motion(SphereTectonics& model, int plate, const Vector3& axis, double speed_rad_myr);
/// Holds all plates as they move now.
void hold_motions(SphereTectonics& model);
/// Lets a plate turn through the next step as a reconstruction has it, rad/Myr, and holds it.
/// Neither forces nor plates that it meets change that.
void guide_plate(SphereTectonics& model, int plate, const Vector3& rotation_rad_myr);
/// Cuts the samples out of a plate of which `inside` (one for each sample of the mesh) is not 0, as
/// a rift does; both parts move as the whole did, and nothing drives them. Returns the places of
/// the part outside and the part inside; nothing, and no change, where one of them has no samples.
std::optional<std::pair<int, int>> split_plate(SphereTectonics& model, int plate,
                                               std::span<const std::uint8_t> inside);
/// Splits a plate by the nearest of some places, warped. Fragments leave each other across the
/// fractures between them, each at the speed.
void rift_plate(SphereTectonics& model, int plate, std::span<const Vector3> places,
                double speed_mm_yr);
/// Splits a plate along a line; with three or four fragments the sides are cut across at the
/// middle of the line, the right one first. They part as ever.
void rift_plate_along(SphereTectonics& model, int plate, const GreatCircleLine& line, int fragments,
                      double speed_mm_yr);
/// The crust at all places (unit vectors) of which something holds becomes continental or
/// oceanic, whatever its plates. Places are asked for as far as `warp_km` beside where they are,
/// so that coasts bend. Returns the area that changed, km2.
double change_crust(SphereTectonics& model, const std::function<bool(const Vector3&)>& holds,
                    bool continental, double warp_km = 0.0);
/// The sea stands where its water has it, if that is known.
void keep_water(SphereTectonics& model);

// What is asked of it.

/// Whether a sample stays above one of another plate where the two meet.
[[nodiscard]] bool is_on_top(const SphereTectonics& model, std::int32_t sample, std::int32_t other);
/// The plate that is on top at a place, or -1 in a gap.
[[nodiscard]] int plate_at(const SphereTectonics& model, const Vector3& place);
/// Area of each plate with all that it carries, km2; 0 of those that are no more.
[[nodiscard]] std::vector<double> plate_areas_km2(const SphereTectonics& model);

/// Torques on a plate about the planet's centre, in the frame of the planet.
struct SphereTorques {
  Matrix3 drag_n_m_s{};   ///< (eta / h) R^4 int f (1 - r r^T) dA, times rotation in rad/s
  Vector3 driving_n_m{};  ///< R^2 closed int F dl of slabs, ridges and sutures
};
/// Those of settings.force on each plate with all that it carries, as of the last step. Floor
/// that opens between resamplings counts as there: it pushes up to where it has its age.
[[nodiscard]] std::vector<SphereTorques> torques(const SphereTectonics& model);

}  // namespace geo
