#include "geo/kernels/plates/rotation_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace geo {
namespace {

constexpr double kSameTime_myr = 1e-6;

Quaternion inverse(const Quaternion& q) { return {q.w, scaled(q.v, -1.0)}; }

/// The finite rotation at a time within a sequence.
Quaternion interpolated(const RotationSequence& sequence, double time_ma) {
  const auto& all = sequence.rotations;
  const auto older = std::lower_bound(
      all.begin(), all.end(), time_ma,
      [](const FiniteRotation& sample, double time) { return sample.time_ma < time; });
  if (older == all.begin()) return all.front().rotation;
  if (older == all.end()) return all.back().rotation;
  const FiniteRotation& younger = *(older - 1);
  const double share = (time_ma - younger.time_ma) / (older->time_ma - younger.time_ma);
  const Vector3 between = rotation_vector(older->rotation.after(inverse(younger.rotation)));
  return Quaternion::about(scaled(between, share)).after(younger.rotation);
}

}  // namespace

Vector3 rotation_vector(const Quaternion& rotation) {
  const double sine = length(rotation.v);
  if (sine == 0.0) return {};
  // Of the two ways round that end in the same place, the shorter one.
  const double sign = rotation.w < 0.0 ? -1.0 : 1.0;
  return scaled(rotation.v, 2.0 * sign * std::atan2(sine, sign * rotation.w) / sine);
}

CircularPlates::CircularPlates(int plate_number, double at_ma)
    : InputError("rotations of plate " + std::to_string(plate_number) +
                 ": its circuit of fixed plates leads back to itself at " + std::to_string(at_ma) +
                 " Ma"),
      plate(plate_number),
      time_ma(at_ma) {}

RotationModel::RotationModel(std::vector<RotationSequence> sequences)
    : sequences_(std::move(sequences)) {
  for (std::size_t k = 0; k < sequences_.size(); ++k) {
    const RotationSequence& sequence = sequences_[k];
    if (sequence.rotations.empty()) throw Bug("rotation model: a sequence without rotations");
    for (std::size_t i = 1; i < sequence.rotations.size(); ++i) {
      if (sequence.rotations[i].time_ma > sequence.rotations[i - 1].time_ma) continue;
      throw InputError("rotations of plate " + std::to_string(sequence.moving) +
                       ": times must ascend");
    }
    of_plate_[sequence.moving].push_back(k);
  }
  for (auto& [plate, own] : of_plate_) {
    std::stable_sort(own.begin(), own.end(), [&](std::size_t a, std::size_t b) {
      return sequences_[a].rotations.front().time_ma < sequences_[b].rotations.front().time_ma;
    });
  }
  for (const RotationSequence& sequence : sequences_) {
    for (const FiniteRotation& sample : sequence.rotations) {
      static_cast<void>(at(sequence.moving, sample.time_ma));
    }
  }
}

std::vector<int> RotationModel::plates() const {
  std::vector<int> numbers;
  numbers.reserve(of_plate_.size());
  for (const auto& [plate, own] : of_plate_) numbers.push_back(plate);
  return numbers;
}

const RotationSequence* RotationModel::sequence_of(int plate, double time_ma) const {
  const auto found = of_plate_.find(plate);
  if (found == of_plate_.end()) return nullptr;
  for (const std::size_t k : found->second) {
    const RotationSequence& sequence = sequences_[k];
    if (time_ma >= sequence.rotations.front().time_ma - kSameTime_myr &&
        time_ma <= sequence.rotations.back().time_ma + kSameTime_myr) {
      return &sequence;
    }
  }
  return nullptr;
}

std::optional<Quaternion> RotationModel::at(int plate, double time_ma) const {
  return at(plate, time_ma, 0);
}

std::optional<Quaternion> RotationModel::at(int plate, double time_ma, std::size_t depth) const {
  if (plate == 0) return Quaternion{};
  if (depth > of_plate_.size()) {
    throw CircularPlates(plate, time_ma);
  }
  const RotationSequence* const sequence = sequence_of(plate, time_ma);
  if (sequence == nullptr) return {};
  const auto fixed = at(sequence->fixed, time_ma, depth + 1);
  if (!fixed) return {};
  return fixed->after(interpolated(*sequence, time_ma));
}

std::optional<Vector3> RotationModel::stage_rad_myr(int plate, double from_ma, double to_ma) const {
  const auto from = at(plate, from_ma), to = at(plate, to_ma);
  if (!from || !to || from_ma <= to_ma) return {};
  return scaled(rotation_vector(to->after(inverse(*from))), 1.0 / (from_ma - to_ma));
}

namespace {

/// Finite rotations of all plates of a drift, each found from those that its crust became part of.
class Drift {
 public:
  Drift(std::span<const PlateTurn> turns, std::span<const PlateSpan> spans, double begin_myr,
        double end_myr)
      : begin_myr_(begin_myr), end_myr_(end_myr) {
    for (const PlateSpan& span : spans) plates_[span.plate].span = span;
    for (const PlateTurn& turn : turns) {
      const auto plate = plates_.find(turn.plate);
      if (plate == plates_.end()) throw unknown(turn.plate);
      plate->second.turns.push_back(turn);
    }
  }

  std::vector<RotationSequence> sequences(int first_number) {
    std::vector<RotationSequence> all;
    for (auto& [number, plate] : plates_) {
      const double last_myr = last_known_myr(number);
      const double born_myr = own_begin(plate), ended_myr = own_end(plate);
      const auto add = [&, moving = number + first_number](int fixed,
                                                           std::vector<FiniteRotation> rotations) {
        all.push_back({moving, fixed, std::move(rotations)});
      };
      if (plate.span.joined >= 0 && last_myr > ended_myr) {
        add(plate.span.joined + first_number, {{ago(last_myr), {}}, {ago(ended_myr), {}}});
      }
      add(0, solve(number));
      if (plate.span.parent >= 0 && born_myr > begin_myr_) {
        const Quaternion fixed =
            inverse(at(plate.span.parent, born_myr)).after(at(number, born_myr));
        add(plate.span.parent + first_number, {{ago(born_myr), fixed}, {ago(begin_myr_), fixed}});
      }
    }
    return all;
  }

 private:
  struct Plate {
    PlateSpan span;
    std::vector<PlateTurn> turns;
    std::vector<FiniteRotation> rotations;  ///< over its own life, youngest first
  };

  static InputError unknown(int number) {
    return InputError("rotations of plate " + std::to_string(number) +
                      ": it is in no list of plates");
  }
  [[nodiscard]] double ago(double time_myr) const { return end_myr_ - time_myr; }
  [[nodiscard]] double own_begin(const Plate& plate) const {
    return std::clamp(plate.span.born_myr, begin_myr_, own_end(plate));
  }
  [[nodiscard]] double own_end(const Plate& plate) const {
    return std::clamp(plate.span.ended_myr, begin_myr_, end_myr_);
  }
  Plate& plate_of(int number) {
    const auto found = plates_.find(number);
    if (found == plates_.end()) throw unknown(number);
    return found->second;
  }
  /// Until when there is crust that was of a plate.
  double last_known_myr(int number) {
    const Plate& plate = plate_of(number);
    return plate.span.joined < 0 ? own_end(plate) : last_known_myr(plate.span.joined);
  }

  /// Rotations of a plate over its own life: from that at its end back, turn by turn.
  const std::vector<FiniteRotation>& solve(int number) {
    Plate& plate = plate_of(number);
    if (!plate.rotations.empty()) return plate.rotations;
    const double ended_myr = own_end(plate);
    Quaternion rotation = plate.span.joined < 0 ? Quaternion{} : at(plate.span.joined, ended_myr);
    std::vector<FiniteRotation> found{{ago(ended_myr), rotation}};
    for (auto turn = plate.turns.rbegin(); turn != plate.turns.rend(); ++turn) {
      if (turn->to_myr > ended_myr + kSameTime_myr) continue;
      // A plate that the last step has made is told how it would go on: for no time yet.
      if (turn->from_myr >= turn->to_myr) continue;
      const Vector3 whole = scaled(turn->rotation_rad_myr, turn->from_myr - turn->to_myr);
      rotation = Quaternion::about(whole).after(rotation);
      found.push_back({ago(turn->from_myr), rotation});
    }
    plate.rotations = std::move(found);
    return plate.rotations;
  }

  /// The rotation of a plate's crust in the absolute frame, whatever it was part of then.
  Quaternion at(int number, double time_myr) {
    const Plate& plate = plate_of(number);
    if (plate.span.joined >= 0 && time_myr > own_end(plate)) {
      return at(plate.span.joined, time_myr);
    }
    return interpolated({number, 0, solve(number)}, ago(time_myr));
  }

  double begin_myr_, end_myr_;
  std::map<int, Plate> plates_;
};

}  // namespace

RotationModel rotations_of_drift(std::span<const PlateTurn> turns, std::span<const PlateSpan> spans,
                                 double begin_myr, double end_myr, int first_number) {
  return RotationModel(Drift(turns, spans, begin_myr, end_myr).sequences(first_number));
}

}  // namespace geo
