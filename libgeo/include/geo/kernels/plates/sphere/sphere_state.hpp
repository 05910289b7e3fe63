#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/numerics/quaternion.hpp"

namespace geo {

/// Crust data of a sample (Cortial et al. 2019, Table 1), one array each; 52 bytes a sample.
/// Samples are those of a Fibonacci sphere and stay where they are in the frame of their plate.
struct SphereCrust {
  std::vector<std::int16_t> plate;       ///< place in SphereState::plates; -1: consumed
  std::vector<std::int8_t> continental;  ///< crust type: 1 continental, 0 oceanic
  std::vector<std::int8_t> orogeny;      ///< OrogenyType
  std::vector<float> thickness_m;        ///< of ocean floor with what volcanoes have laid on it
  std::vector<float> elevation_m;
  std::vector<float> sediment_m;            ///< of its thickness: what rivers have laid on it
  std::vector<float> age_myr;               ///< of oceanic crust, since it left its ridge
  std::vector<float> orogeny_age_myr;       ///< of continental crust, since it was last folded
  std::vector<std::array<float, 3>> ridge;  ///< unit vector along the ridge that made it, or zero
  std::vector<std::array<float, 3>> fold;   ///< direction of folds in the ground, or zero

  void resize(std::size_t samples);
  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(plate.size()); }
};

/// What of a plate is left to chance. Draws belong to a plate by its descent, which is the same
/// however many samples there are, and not to its number or place. Events are those of Poisson
/// processes: one happens when the integral of its rate over time, the hazard, passes an
/// exponential draw, so that a small change of a rate moves an event a little and does not undo it.
struct PlateChances {
  std::uint64_t descent = 0;
  double rift_hazard = 0.0, initiation_hazard = 0.0;  ///< since the last event of that kind
  std::int32_t rifts = 0, initiations = 0;            ///< events of the plate so far
};

/// A rigid plate. Positions of its samples are `turn` times those of the lattice.
struct SpherePlate {
  /// In SphereState::lives, and in files: no other plate of a run has it. -1: a terrane that
  /// another plate carries, and is part of.
  std::int16_t id = -1;
  Quaternion turn;               ///< since the last resampling
  std::vector<Quaternion> past;  ///< what that was at the times SphereState::past_myr
  Vector3 axis{0.0, 0.0, 1.0};   ///< w, unit vector
  double speed_rad_myr = 0.0;    ///< omega
  bool alive = true;
  /// The plate that carries this body since it collided with it, or -1: both move as one and become
  /// one at the next resampling.
  std::int16_t carrier = -1;
  double born_myr = 0.0;
  bool is_held = false;  ///< its motion was given: neither slab pull nor the frame changes it
  Vector3 yielding{};  ///< by which plates that it meets or parts from change its rotation, rad/Myr
  /// Its number in the reconstruction whose rotations drive it, or -1.
  std::int32_t driver = -1;
  PlateChances chances;
};

/// What is known of a plate by its number, also when it is no more.
struct PlateLife {
  /// There from the beginning; from a rift; floor whose subduction began at a margin; a piece that
  /// was left over; a terrane whose new plate has gone down before they had become one; an arc
  /// that has followed its trench; a block of a continent that another one has indented.
  enum class Origin : std::int8_t {
    first,
    rift,
    subduction_initiation,
    piece,
    terrane,
    back_arc,
    block
  };

  Origin origin = Origin::first;
  std::int16_t parent = -1;  ///< number of the plate of which it was a part
  double born_myr = 0.0;
  double ended_myr = kLives;  ///< when it collided, or the last of it had subducted
  std::int16_t joined = -1;   ///< number of the plate that it is part of since then

  static constexpr double kLives = std::numeric_limits<double>::infinity();
};

/// What is remembered of two plates, the one of lower number first.
struct PlatePair {
  std::int8_t ocean_top = -1;       ///< which one's ocean floor stays up: 0 first, 1 second
  bool is_ocean_top_final = false;  ///< they have met along enough of their edges to tell
  std::int8_t continent_top = -1;   ///< the same of their continents
  float last_contact_myr = -1e9F;
  float parted_myr = -1e9F;  ///< when a rift made them
  float under_km = 0.0F;  ///< how far one continent had been thrust below the other at resampling
};

/// A plume of the mantle, below the plates and at rest.
struct SpherePlume {
  Vector3 place;              ///< unit vector
  double growth_mm_yr = 0.0;  ///< of a mound on sea floor at rest above it: sets its output
  std::int64_t number = 0;    ///< by which its volcanoes are drawn
  // The volcano that it feeds.
  std::int64_t volcanoes = 0;  ///< how many there have been
  Vector3 volcano{};           ///< unit vector, or zero before the first
  double volcano_km3 = 0.0;    ///< what it has brought forth
};

/// All that a run of the sphere model needs to go on.
struct SphereState {
  SphereCrust crust;
  std::vector<SpherePlate> plates;
  std::vector<PlatePair> pairs;  ///< plates.size() squared; used where row < column
  std::vector<SpherePlume> plumes;
  std::vector<PlateLife> lives;  ///< by number
  std::vector<double> past_myr;  ///< beginnings of the steps since the last resampling
  double time_myr = 0.0;
  std::int64_t steps = 0;
  double resampled_myr = 0.0;  ///< time of the last resampling
  /// Common rotation that plates which are not held keep, rad/Myr.
  Vector3 kept_rotation_rad_myr{};
  /// Climate of a planet whose rivers know one: runoff over that of reference at the places of the
  /// lattice, in the frame of the planet; empty: 1 everywhere.
  std::vector<float> runoff;
  double water_km3 = 0.0;    ///< of the sea and the ice on land, which stays; 0: not known
  double ice_km3 = 0.0;      ///< what of that is ice
  double sea_level_m = 0.0;  ///< elevation of the sea's surface
  /// Age in a reconstruction, Ma, at which the drift began; nothing: none drives it.
  std::optional<double> reconstruction_ma;

  [[nodiscard]] PlatePair& pair(int a, int b) {
    return pairs[static_cast<std::size_t>(a < b ? a : b) * plates.size() + (a < b ? b : a)];
  }
  [[nodiscard]] const PlatePair& pair(int a, int b) const {
    return pairs[static_cast<std::size_t>(a < b ? a : b) * plates.size() + (a < b ? b : a)];
  }
  /// The plate that a body moves with: itself unless it is carried.
  [[nodiscard]] int root(int plate) const {
    while (plates[plate].carrier >= 0) plate = plates[plate].carrier;
    return plate;
  }
  /// A new plate in the place of a dead one, or behind the others; its pairs forget.
  int add_plate(const SpherePlate& plate);
  /// The number of a plate that is born now. Numbers are given one after the other and not again,
  /// until all that a file can hold have been: then that of the plate which ended first.
  std::int16_t begin_life(PlateLife::Origin origin, std::int16_t parent);
  /// A plate is no more; it has become part of another one (a number), or -1. Bodies without a
  /// number have no life.
  void end_life(std::int16_t id, std::int16_t joined);
};

}  // namespace geo
