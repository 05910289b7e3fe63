#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {
namespace {

Eigen::Matrix3d eigen(const Matrix3& m) {
  Eigen::Matrix3d out;
  for (int c = 0; c < 3; ++c) out.row(c) = Eigen::Map<const Eigen::RowVector3d>(m[c].data());
  return out;
}

/// Adds `scale` (1 - r r^T): times a rotation, r x (rotation x r).
void add_lever(Matrix3& sum, const Vector3& r, double scale) {
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) sum[c][d] += scale * ((c == d ? 1.0 : 0.0) - r[c] * r[d]);
  }
}

/// Torques on plates that are linked by what acts between two of them: linear in the changes of
/// their rotations, three unknowns each. Plates that are not free do not change.
class LinkedPlates {
 public:
  explicit LinkedPlates(const std::vector<std::uint8_t>& is_free) : place_(is_free.size(), -1) {
    int free = 0;
    for (std::size_t p = 0; p < is_free.size(); ++p) {
      if (is_free[p] != 0) place_[p] = 3 * free++;
    }
    drag_ = Eigen::MatrixXd::Zero(3 * free, 3 * free);
    torque_ = Eigen::VectorXd::Zero(3 * free);
  }
  /// Drag on a plate where its rotation changes.
  void hold_back(int plate, const Matrix3& drag) {
    if (const int at = place_[plate]; at >= 0) drag_.block<3, 3>(at, at) += eigen(drag);
  }
  /// Drag between two plates, where the second moves by `relative` beside the first so far.
  void link(std::size_t first, std::size_t second, const Matrix3& drag, const Vector3& relative) {
    const Eigen::Matrix3d rub = eigen(drag);
    const Vector3 now = times(drag, relative);
    const Eigen::Vector3d torque = Eigen::Map<const Eigen::Vector3d>(now.data());
    const int a = place_[first], b = place_[second];
    if (a >= 0) {
      drag_.block<3, 3>(a, a) += rub;
      torque_.segment<3>(a) += torque;
    }
    if (b >= 0) {
      drag_.block<3, 3>(b, b) += rub;
      torque_.segment<3>(b) -= torque;
    }
    if (a >= 0 && b >= 0) {
      drag_.block<3, 3>(a, b) -= rub;
      drag_.block<3, 3>(b, a) -= rub;
    }
  }
  /// The change of rotation of each plate with which no torque is left.
  [[nodiscard]] std::vector<Vector3> balance() const {
    std::vector<Vector3> changes(place_.size(), Vector3{});
    if (torque_.size() == 0) return changes;
    const Eigen::VectorXd change = drag_.ldlt().solve(torque_);
    for (std::size_t p = 0; p < place_.size(); ++p) {
      for (int c = 0; c < 3 && place_[p] >= 0; ++c) changes[p][c] = change[place_[p] + c];
    }
    return changes;
  }

 private:
  std::vector<int> place_;  // of a plate in the system, or -1
  Eigen::MatrixXd drag_;
  Eigen::VectorXd torque_;
};

}  // namespace

/// Lets a fragment gain a rotation over the onset, beside what it has still to gain from a rift
/// before.
void SphereTectonics::quicken(SpherePlate& fragment, const Vector3& gained) const {
  const double rest_myr = std::max(0.0, fragment.quickens_until_myr - state_.time_myr);
  const Vector3 whole = add(gained, fragment.quickening, rest_myr);
  fragment.quickening = scaled(whole, 1.0 / settings_.rift_onset_myr);
  fragment.quickens_until_myr = state_.time_myr + settings_.rift_onset_myr;
}

/// Fragments of a rifted plate come to their speed at a steady rate.
void SphereTectonics::quicken_rifts() {
  for (SpherePlate& plate : state_.plates) {
    if (!plate.alive || plate.is_held || state_.time_myr >= plate.quickens_until_myr) continue;
    const double for_myr =
        std::min(settings_.law.step_myr, plate.quickens_until_myr - state_.time_myr);
    const Vector3 rotation =
        add(scaled(plate.axis, plate.speed_rad_myr), plate.quickening, for_myr);
    plate.speed_rad_myr =
        std::min(length(rotation), settings_.law.speed_mm_yr / settings_.radius_km);
    if (plate.speed_rad_myr > 0.0) plate.axis = normalised(rotation);
  }
  set_frames();
}

/// Continents of which one has gone below the other rub. On every plate the drag of the mantle on
/// what it moves beside the motion that drives it, int (1 - r r^T) (W - w) dA, and k times the same
/// of the motion of the one continent over the other, where they overlap, come to nothing.
void SphereTectonics::yield_to_continents() {
  for (SpherePlate& plate : state_.plates) plate.yielding = {};
  set_frames();
  if (settings_.suture_drag <= 0.0 || settings_.by_forces) return;
  const std::size_t plates = state_.plates.size();
  const SphereCrust& crust = state_.crust;
  std::vector<Matrix3> overlap(plates * plates, Matrix3{});
  std::vector<std::uint8_t> rubs(plates, 0), yields(plates, 0);
  for (const std::int32_t i : contacts_) {
    const std::int32_t above = partner_[i];
    if (hidden_[i] == 0 || crust.continental[i] == 0 || crust.continental[above] == 0) continue;
    const int lower = state_.root(crust.plate[i]), upper = state_.root(crust.plate[above]);
    const Vector3 r = times(frame_[crust.plate[i]], mesh_->samples().position(i));
    add_lever(overlap[std::min(lower, upper) * plates + std::max(lower, upper)], r,
              settings_.suture_drag);
    rubs[lower] = rubs[upper] = 1;
  }
  // Of the plates that rub those that are not held yield.
  for (std::size_t p = 0; p < plates; ++p)
    yields[p] = rubs[p] != 0 && !state_.plates[p].is_held ? 1 : 0;
  LinkedPlates linked(yields);
  for (std::size_t p = 0; p < plates; ++p) {
    if (!state_.plates[p].alive) continue;
    const int own = static_cast<int>(p);
    linked.hold_back(state_.root(own), carried(frame_[p], partition_.cap(own).inertia));
  }
  for (std::size_t a = 0; a < plates; ++a) {
    for (std::size_t b = a + 1; b < plates; ++b) {
      if (rubs[a] == 0 || rubs[b] == 0) continue;
      linked.link(a, b, overlap[a * plates + b], add(rotation_[b], rotation_[a], -1.0));
    }
  }
  const std::vector<Vector3> changes = linked.balance();
  for (std::size_t p = 0; p < plates; ++p) state_.plates[p].yielding = changes[p];
  set_frames();
}

}  // namespace geo
