#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/numerics/quaternion.hpp"

namespace geo {

/// The vector along the axis of a rotation, as long as its angle in radians, 0 to pi.
[[nodiscard]] Vector3 rotation_vector(const Quaternion& rotation);

/// Thrown where a plate is fixed to itself, by whatever circuit.
struct CircularPlates : InputError {
  CircularPlates(int plate_number, double at_ma);
  int plate;
  double time_ma;
};

/// A finite rotation: what lies at a place today lay at the rotated place then.
struct FiniteRotation {
  double time_ma = 0.0;  ///< before the present
  Quaternion rotation;
};

/// Finite rotations of one plate relative to another one, times ascending.
struct RotationSequence {
  int moving = 0, fixed = 0;  ///< numbers of plates; 0 is the absolute frame
  std::vector<FiniteRotation> rotations;
};

/// The plate circuit of a reconstruction, as rotation files of GPlates have it: each plate has one
/// or more sequences of finite rotations, each relative to a plate of its own (Cox & Hart 1986,
/// chapter 7). Where the fixed plate changes from one sequence to the next, at a crossover, both
/// give the same rotation in the absolute frame.
///
/// Between two times of a sequence a plate turns about one pole relative to its fixed plate, at a
/// constant rate (spherical linear interpolation of quaternions, Shoemake 1985).
class RotationModel {
 public:
  RotationModel() = default;
  /// Throws CircularPlates where a plate is fixed to itself, by whatever circuit, and InputError
  /// where times do not ascend.
  explicit RotationModel(std::vector<RotationSequence> sequences);

  [[nodiscard]] std::span<const RotationSequence> sequences() const { return sequences_; }
  /// Numbers of the moving plates, ascending.
  [[nodiscard]] std::vector<int> plates() const;
  /// From where crust of a plate is today to where it was, in the absolute frame. Nothing where no
  /// circuit leads from the plate to that frame at this time. At a crossover the younger sequence
  /// counts. Cost: logarithmic in rotations, for each plate of the circuit.
  [[nodiscard]] std::optional<Quaternion> at(int plate, double time_ma) const;
  /// Mean rotation between two times, rad/Myr forwards in time, in the absolute frame: it carries
  /// crust from where it was at `from_ma` to where it was at the younger time `to_ma`.
  [[nodiscard]] std::optional<Vector3> stage_rad_myr(int plate, double from_ma, double to_ma) const;

 private:
  [[nodiscard]] const RotationSequence* sequence_of(int plate, double time_ma) const;
  [[nodiscard]] std::optional<Quaternion> at(int plate, double time_ma, std::size_t depth) const;

  std::vector<RotationSequence> sequences_;
  std::map<int, std::vector<std::size_t>> of_plate_;  // younger sequences first
};

/// How a plate turned for some time.
struct PlateTurn {
  int plate = 0;
  double from_myr = 0.0, to_myr = 0.0;  ///< since the drift began
  Vector3 rotation_rad_myr{};
};

/// When a plate was there, and what its crust was part of before and after.
struct PlateSpan {
  int plate = 0;
  int parent = -1;  ///< of which it was a part before; -1: none
  int joined = -1;  ///< of which it has been a part since; -1: it was subducted, or lives
  double born_myr = 0.0;
  double ended_myr = std::numeric_limits<double>::infinity();
};

/// Finite rotations of a drift whose end is the present.
///
/// A plate has rotations in the absolute frame over its own life, one for each end of its turns.
/// Before, it is fixed to its parent, and once it has become part of another plate it is fixed to
/// that one; a plate that was subducted has no rotations after its end and counts as if it had
/// stayed where it was then. Numbers of plates in the model are those of the spans plus
/// `first_number`, which is 1 at least, as 0 is the absolute frame.
///
/// @param turns      in the order of time; those of a plate follow each other without gaps
/// @param spans      one for each plate
/// @param begin_myr  of the drift, as far as turns are known
/// @param end_myr    its end, the present
/// Throws InputError where a turn or a span names a plate that has no span.
[[nodiscard]] RotationModel rotations_of_drift(std::span<const PlateTurn> turns,
                                               std::span<const PlateSpan> spans, double begin_myr,
                                               double end_myr, int first_number);

}  // namespace geo
