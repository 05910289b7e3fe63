#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

// The parts of a step. Each says what it needs beside fresh plates (SphereTectonics) and what it
// changes; all add to the budget what they move.

// Chance.

/// The descent of a plate that comes from another one as its n-th part of a kind.
enum class Descent : std::uint64_t { rift, piece, terrane };
[[nodiscard]] std::uint64_t descent_from(const SphereTectonics& model, const PlateChances& parent,
                                         Descent kind, std::uint64_t number);
/// Adds to a hazard what a rate comes to in a step, and tells whether it has passed the exponential
/// draw of a stream.
[[nodiscard]] bool is_struck(double& hazard, double expected, const RandomStream& random,
                             const PlateChances& of, std::int32_t event);
/// Number of a draw of the event, of which each has 16.
[[nodiscard]] inline std::uint64_t draw_of(std::int32_t event, std::uint64_t draw) {
  return 16U * static_cast<std::uint64_t>(event) + draw;
}
/// Places uniform on the sphere, a sequence for each event of a plate.
class DrawnPlaces {
 public:
  DrawnPlaces(const RandomStream& random, const PlateChances& of, std::int32_t event);
  [[nodiscard]] Vector3 operator[](std::uint64_t k) const { return random_->direction(first_ + k); }

 private:
  const RandomStream* random_;
  std::uint64_t first_;
};

// Plates.

/// Needs samples that have changed their plates, or their type, since. Plates that have lost all
/// end, what they carried goes on alone. Derives the partition and all below.
void derive_plates(SphereTectonics& model);
/// Needs plates that have turned or whose motion has changed since. Derives frames and rotations.
void derive_motion(SphereTectonics& model);
/// Needs floor that has become continental since. Derives the counts of continents and ranks.
void derive_ranks(SphereTectonics& model);
/// The same as derive_plates() for plates that are another model's, which do not end here.
void derive_followed_plates(SphereTectonics& model);
/// Turns plates by a step and remembers where they were.
void move_plates(SphereTectonics& model);
/// Whether a plate is one of its own that nothing from outside moves.
[[nodiscard]] inline bool is_free(const SpherePlate& plate) {
  return plate.alive && plate.carrier < 0 && !plate.is_held && plate.driver < 0;
}
/// The rotation that drives a plate, without what it yields to others, rad/Myr.
[[nodiscard]] Vector3 driven_rotation(const SphereState& state, int plate);
/// Common rotation of the plates that are not held, rad/Myr.
[[nodiscard]] Vector3 net_rotation(const SphereTectonics& model);

// Margins.

/// Needs plates that have moved. Derives the margins, and decides for pairs of plates that meet
/// anew which one stays up.
void find_margins(SphereTectonics& model);
/// Nothing lies over anything.
void forget_margins(SphereTectonics& model);

/// What handing trenches on asks of a sample, in one place of memory.
struct TrenchSpot {
  float x, y, z, chord2;  ///< of the nearest trench so far
  std::int32_t trench;    ///< that one, or -1
  std::int16_t plate;     ///< -1 also below another plate
};
/// The square of the chord that spans the reach of subduction.
[[nodiscard]] float subduction_chord2(const SphereSettings& settings);
/// One for each sample, none of which knows a trench: only nearer ones than the reach of subduction
/// will do. Needs partners and what is hidden.
[[nodiscard]] std::vector<TrenchSpot> spots_of_samples(const SphereTectonics& model);
/// Hands trenches of a plate on within it; `reached` learns of samples that had none.
void hand_on_trenches(const SphereTectonics& model, int plate,
                      std::span<const std::int32_t> trenches, std::vector<TrenchSpot>& spots,
                      std::vector<std::int32_t>* reached);

// Crust.

/// Needs margins. Raises, wears, sinks and ages all crust; arcs that emerge become continental.
void raise_crust(SphereTectonics& model);
/// Needs margins. Plumes build volcanoes on sea floor.
void erupt(SphereTectonics& model);
/// Needs what is hidden. The mantle gives and takes water so that in time the freeboard of
/// continents is what it was (Wise 1974).
void exchange_water(SphereTectonics& model);
/// What rivers have done to the crust, m: less than 0 where they took sediment first, then what is
/// below it.
void enter_sediment(SphereTectonics& model, const std::vector<float>& rock_m);
/// Needs margins. Floor that subducts leaves a share of its sediment on what overrides it and takes
/// the rest down.
void scrape_sediment(SphereTectonics& model);
/// Length of each way between neighbours, m, by its number in the mesh.
[[nodiscard]] std::vector<float> ways_m(const SphereMesh& mesh, double radius_km);
/// Needs margins. Rivers carve and deposit.
void run_rivers(SphereTectonics& model);
/// Needs what is hidden. Lets thick crust flow to its sides for a step.
void flow_lower_crust(SphereTectonics& model);
/// Needs what is hidden. Thins roots that are too thick.
void spread_roots(SphereTectonics& model);

// Motion.

/// Needs trenches. Turns axes of plates towards slabs that subduct, and derives motion.
void pull_slabs(SphereTectonics& model);
/// Needs margins. Lets motion follow the forces, and derives it. Returns what holds each plate back
/// with all that it carries, in units of what holds one sample of sea floor.
std::vector<Matrix3> balance_forces(SphereTectonics& model);
/// The same of plates that the mantle alone holds back.
[[nodiscard]] std::vector<Matrix3> drag_below(const SphereTectonics& model);
/// Of one plate without what it carries.
[[nodiscard]] Matrix3 drag_below(const SphereTectonics& model, int plate);
/// Needs margins. Plates that are linked slow each other, and motion is derived.
void yield_to_links(SphereTectonics& model, const std::vector<Matrix3>& drag);

// Happenings.

/// Needs margins. Continents that have gone far enough below another collide with it.
void collide_continents(SphereTectonics& model);
/// A terrane that has come to another plate.
struct Collision {
  int upper;                              ///< that plate
  std::span<const std::int32_t> terrane;  ///< its samples
  Vector3 centroid;                       ///< unit vector, in the frame of the planet
  double area_km2, speed_mm_yr;           ///< of the terrane
};
/// Mountains of the collided plate around a terrane. The crust that the terrane had pushed below is
/// consumed and given back as their roots: the profile and the reach are those of 4.2, its height
/// at most `surge_km`, and its reach drawn in until its volume is what was swallowed. Needs
/// margins; leaves it to the caller to derive the plates.
void surge(SphereTectonics& model, const Collision& what);
/// What a terrane (samples of plate `lower`) does to another plate when it collides. Needs margins.
void collide_terrane(SphereTectonics& model, int lower, int upper,
                     std::span<const std::int32_t> terrane, double speed_mm_yr);
/// Needs margins. Pairs of plates keep how far their continents have come below each other.
void remember_penetration(SphereTectonics& model);
/// Plates rift, and old margins begin to subduct, by chance.
void rift_by_chance(SphereTectonics& model);
void initiate_subduction_by_chance(SphereTectonics& model);
/// Needs margins. Floor well below arcs that follow their trenches, and below what is behind them,
/// sinks into the mantle. Tells whether any has, after which plates are to be derived.
bool sink_slabs(SphereTectonics& model);
/// Needs margins. Arcs above old slabs break off and follow their trenches, by chance.
void open_back_arcs_by_chance(SphereTectonics& model);
/// Whether a plate is such an arc.
[[nodiscard]] bool is_back_arc(const SphereState& state, int plate);
/// Needs margins. Continents above others that come fast break along blocks, by chance.
void break_blocks_by_chance(SphereTectonics& model);
/// Whether a plate is such a block.
[[nodiscard]] bool is_block(const SphereState& state, int plate);
/// Bounds how fast arcs leave the plates behind them, and derives motion.
void hold_back_arcs(SphereTectonics& model);
/// Fragments of a plate (-1 beside it) become plates, each turned about an axis on top of the old
/// motion. False when there are no two.
/// `part_at` tells other samples their fragment; without it they have that of the nearest sample.
using FragmentAt = std::function<int(const Vector3& place, bool continental)>;
bool part_plate(SphereTectonics& model, int plate, std::span<const std::int8_t> fragment,
                std::span<const Vector3> away, double speed_mm_yr, SphereEvent::Kind kind,
                FragmentAt part_at = {});

// Resampling.

/// resample(), with something else done to plates that have come apart: `settle` leaves them
/// derived.
void resample(SphereTectonics& model, const std::function<void(SphereTectonics&)>& settle);
/// Detached pieces of plates that are too small to be plates join the neighbour beside which they
/// move slowest.
void join_small_pieces(SphereTectonics& model);
/// What is remembered of two plates, told of the first one of other numbers.
[[nodiscard]] PlatePair seen_from(PlatePair pair, bool is_turned);
/// Plates that hardly move beside a neighbour become one with it. Needs crust that has just been
/// resampled.
void weld_still_plates(SphereTectonics& model);
/// Ridges jump to plumes beside them. Needs crust that has just been resampled.
void jump_ridges(SphereTectonics& model);
/// Ends the step: what follows happens at its end, and the next one may begin.
void end_step(SphereTectonics& model);
/// Uplift, erosion, volcanoes and rivers of a step. Needs margins.
void shape_crust(SphereTectonics& model);

/// New floor and the margins of continents where no plate is. `now` is the crust that grows,
/// `owner` the plate of each of its samples, -1 in gaps before and nowhere after, `body` what moved
/// as one before.
void fill_gaps(SphereTectonics& model, SphereCrust& now, std::vector<std::int16_t>& owner,
               std::span<const std::int16_t> body);
void stretch_margins(SphereTectonics& model, std::span<const std::int32_t> gaps,
                     std::span<const std::int32_t> nearest, SphereCrust& now,
                     std::span<const std::int16_t> owner);

// The budget.

/// Volume of the continents, number of plates and what their areas miss.
void measure_volume(SphereTectonics& model);

}  // namespace geo
