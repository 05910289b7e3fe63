#include <Eigen/Dense>
#include <algorithm>
#include <numbers>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {
namespace {

Eigen::Matrix3d eigen(const Matrix3& m) {
  Eigen::Matrix3d out;
  for (int c = 0; c < 3; ++c) out.row(c) = Eigen::Map<const Eigen::RowVector3d>(m[c].data());
  return out;
}

Eigen::Vector3d eigen(const Vector3& v) { return Eigen::Map<const Eigen::Vector3d>(v.data()); }

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
  void hold_back(int plate, const Eigen::Matrix3d& drag) {
    if (const int at = place_[plate]; at >= 0) drag_.block<3, 3>(at, at) += drag;
  }
  /// Drag between two plates, where the second moves by `relative` beside the first so far.
  void link(int first, int second, const Eigen::Matrix3d& drag, const Eigen::Vector3d& relative) {
    const Eigen::Vector3d torque = drag * relative;
    const int a = place_[first], b = place_[second];
    if (a >= 0) {
      drag_.block<3, 3>(a, a) += drag;
      torque_.segment<3>(a) += torque;
    }
    if (b >= 0) {
      drag_.block<3, 3>(b, b) += drag;
      torque_.segment<3>(b) -= torque;
    }
    if (a >= 0 && b >= 0) {
      drag_.block<3, 3>(a, b) -= drag;
      drag_.block<3, 3>(b, a) -= drag;
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

/// The sum of 1 - r r^T over a plate's samples. As each covers some ground, also a plate of one
/// resists a spin about itself: by s / 2 pi about the middle of a disc of s steradians.
Matrix3 SphereTectonics::drag_below(int plate) const {
  const auto& cap = partition_.cap(plate);
  Matrix3 drag = carried(frame_[plate], cap.inertia);
  const double spin = cap.samples * mesh_->samples().area_sr() / (2.0 * std::numbers::pi);
  for (int c = 0; c < 3; ++c) drag[c][c] += spin;
  return drag;
}

/// What holds each plate back with all that it carries.
std::vector<Matrix3> SphereTectonics::drag_below() const {
  std::vector<Matrix3> drag(state_.plates.size(), Matrix3{});
  for (std::size_t p = 0; p < drag.size(); ++p) {
    if (!state_.plates[p].alive) continue;
    const Matrix3 own = drag_below(static_cast<int>(p));
    Matrix3& sum = drag[state_.root(static_cast<int>(p))];
    for (int c = 0; c < 3; ++c) sum[c] = add(sum[c], own[c]);
  }
  return drag;
}

/// Lithosphere that has begun to part is whole at first: fragments leave each other at a share
/// s = t / onset of what drives them apart. A drag of (1 - s) / s (A^-1 + B^-1)^-1 between plates
/// that A and B hold back does that to any motion.
std::vector<SphereTectonics::Link> SphereTectonics::links_of_rifts(
    const std::vector<Matrix3>& drag) const {
  std::vector<Link> links;
  for (int a = 0; a < std::ssize(drag); ++a) {
    for (int b = a + 1; b < std::ssize(drag); ++b) {
      const int first = state_.root(a), second = state_.root(b);
      if (!state_.plates[a].alive || !state_.plates[b].alive || first == second) continue;
      const double since_myr =
          state_.time_myr + settings_.law.step_myr - state_.pair(a, b).parted_myr;
      if (since_myr >= settings_.rift_onset_myr) continue;
      const double share = since_myr / settings_.rift_onset_myr;
      const Eigen::Matrix3d below = eigen(drag[first]), beside = eigen(drag[second]);
      const Eigen::Matrix3d both = below * (below + beside).inverse() * beside;
      Matrix3 rub;
      for (int c = 0; c < 3; ++c) {
        for (int d = 0; d < 3; ++d) {
          rub[c][d] = (1.0 - share) / share * 0.5 * (both(c, d) + both(d, c));
        }
      }
      links.push_back({first, second, rub});
    }
  }
  return links;
}

/// Continents of which one is thrust below the other rub: k times the drag of the mantle, as far as
/// they overlap.
std::vector<SphereTectonics::Link> SphereTectonics::links_of_continents() const {
  const SphereCrust& crust = state_.crust;
  const std::size_t plates = state_.plates.size();
  std::vector<Matrix3> overlap(plates * plates, Matrix3{});
  std::vector<std::uint8_t> rubs(plates * plates, 0);
  for (const std::int32_t i : contacts_) {
    const std::int32_t above = partner_[i];
    if (hidden_[i] == 0 || crust.continental[i] == 0 || crust.continental[above] == 0) continue;
    const int lower = state_.root(crust.plate[i]), upper = state_.root(crust.plate[above]);
    const Vector3 r = times(frame_[crust.plate[i]], mesh_->samples().position(i));
    const std::size_t at = std::min(lower, upper) * plates + std::max(lower, upper);
    rubs[at] = 1;
    for (int c = 0; c < 3; ++c) {
      for (int d = 0; d < 3; ++d) {
        overlap[at][c][d] += settings_.suture_drag * ((c == d ? 1.0 : 0.0) - r[c] * r[d]);
      }
    }
  }
  std::vector<Link> links;
  for (std::size_t at = 0; at < rubs.size(); ++at) {
    if (rubs[at] != 0) {
      links.push_back({static_cast<int>(at / plates), static_cast<int>(at % plates), overlap[at]});
    }
  }
  return links;
}

/// Plates that are linked yield. On each the drag of the mantle on what it moves beside the motion
/// that drives it and that of its links on how it moves beside other plates come to nothing.
void SphereTectonics::yield(const std::vector<Matrix3>& drag) {
  for (SpherePlate& plate : state_.plates) plate.yielding = {};
  set_frames();
  std::vector<Link> links;
  if (settings_.rift_onset_myr > 0.0) links = links_of_rifts(drag);
  if (settings_.suture_drag > 0.0) {
    const std::vector<Link> more = links_of_continents();
    links.insert(links.end(), more.begin(), more.end());
  }
  std::vector<std::uint8_t> yields(state_.plates.size(), 0);
  for (const Link& link : links) {
    for (const int p : {link.first, link.second}) yields[p] = state_.plates[p].is_held ? 0 : 1;
  }
  LinkedPlates linked(yields);
  for (int p = 0; p < std::ssize(drag); ++p) linked.hold_back(p, eigen(drag[p]));
  for (const Link& link : links) {
    linked.link(link.first, link.second, eigen(link.drag),
                eigen(add(rotation_[link.second], rotation_[link.first], -1.0)));
  }
  const std::vector<Vector3> changes = linked.balance();
  for (std::size_t p = 0; p < changes.size(); ++p) state_.plates[p].yielding = changes[p];
  set_frames();
}

}  // namespace geo
