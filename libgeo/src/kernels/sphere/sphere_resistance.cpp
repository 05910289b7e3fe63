#include <Eigen/Dense>
#include <algorithm>

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
    const Vector3 rotation =
        add(scaled(plate.axis, plate.speed_rad_myr), plate.quickening, settings_.law.step_myr);
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
  if (settings_.suture_drag <= 0.0) return;
  const std::size_t plates = state_.plates.size();
  const SphereCrust& crust = state_.crust;
  std::vector<Matrix3> overlap(plates * plates, Matrix3{});
  std::vector<std::uint8_t> rubs(plates, 0);
  for (const std::int32_t i : contacts_) {
    const std::int32_t above = partner_[i];
    if (hidden_[i] == 0 || crust.continental[i] == 0 || crust.continental[above] == 0) continue;
    const int lower = state_.root(crust.plate[i]), upper = state_.root(crust.plate[above]);
    const Vector3 r = times(frame_[crust.plate[i]], mesh_->samples().position(i));
    add_lever(overlap[std::min(lower, upper) * plates + std::max(lower, upper)], r,
              settings_.suture_drag);
    rubs[lower] = rubs[upper] = 1;
  }
  // Of the plates that rub those that are not held are free to yield.
  std::vector<int> place(plates, -1);
  int free = 0;
  for (std::size_t p = 0; p < plates; ++p) {
    if (rubs[p] != 0 && !state_.plates[p].is_held) place[p] = 3 * free++;
  }
  if (free == 0) return;
  Eigen::MatrixXd drag = Eigen::MatrixXd::Zero(3 * free, 3 * free);
  Eigen::VectorXd left = Eigen::VectorXd::Zero(3 * free);
  for (std::size_t p = 0; p < plates; ++p) {
    if (!state_.plates[p].alive) continue;
    const int at = place[state_.root(static_cast<int>(p))];
    if (at < 0) continue;
    drag.block<3, 3>(at, at) +=
        eigen(carried(frame_[p], partition_.cap(static_cast<int>(p)).inertia));
  }
  for (std::size_t a = 0; a < plates; ++a) {
    for (std::size_t b = a + 1; b < plates; ++b) {
      if (rubs[a] == 0 || rubs[b] == 0) continue;
      const Eigen::Matrix3d rub = eigen(overlap[a * plates + b]);
      const Vector3 relative =
          times(overlap[a * plates + b], add(rotation_[b], rotation_[a], -1.0));
      const Eigen::Vector3d torque = Eigen::Map<const Eigen::Vector3d>(relative.data());
      const int first = place[a], second = place[b];
      if (first >= 0) {
        drag.block<3, 3>(first, first) += rub;
        left.segment<3>(first) += torque;
      }
      if (second >= 0) {
        drag.block<3, 3>(second, second) += rub;
        left.segment<3>(second) -= torque;
      }
      if (first >= 0 && second >= 0) {
        drag.block<3, 3>(first, second) -= rub;
        drag.block<3, 3>(second, first) -= rub;
      }
    }
  }
  const Eigen::VectorXd change = drag.ldlt().solve(left);
  for (std::size_t p = 0; p < plates; ++p) {
    if (place[p] < 0) continue;
    for (int c = 0; c < 3; ++c) state_.plates[p].yielding[c] = change[place[p] + c];
  }
  set_frames();
}

}  // namespace geo
