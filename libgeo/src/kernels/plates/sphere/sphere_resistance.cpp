#include <Eigen/Dense>
#include <algorithm>
#include <numbers>
#include <vector>

#include "sphere_steps.hpp"

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

/// What holds two plates together: a drag on how they move beside each other, in units of that
/// below one sample.
struct Link {
  int first, second;
  Matrix3 drag;
};

/// Lithosphere that has begun to part is whole at first: fragments leave each other at a share
/// s = (t / onset)^n of what drives them apart. A drag of (1 - s) / s (A^-1 + B^-1)^-1 between
/// plates that A and B hold back does that to any motion.
std::vector<Link> links_of_rifts(const SphereTectonics& model, const std::vector<Matrix3>& drag) {
  std::vector<Link> links;
  for (int a = 0; a < std::ssize(drag); ++a) {
    for (int b = a + 1; b < std::ssize(drag); ++b) {
      const int first = model.state.root(a), second = model.state.root(b);
      if (!model.state.plates[a].alive || !model.state.plates[b].alive || first == second) continue;
      const double since_myr =
          model.state.time_myr + model.settings.law.step_myr - model.state.pair(a, b).parted_myr;
      if (since_myr >= model.settings.rift_onset_myr) continue;
      const double share =
          std::pow(since_myr / model.settings.rift_onset_myr, model.settings.rift_onset_power);
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
/// they overlap, and as far as they did when the crust was resampled, which has made a root of
/// that.
std::vector<Link> links_of_continents(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  const std::size_t plates = model.state.plates.size();
  std::vector<Matrix3> overlap(plates * plates, Matrix3{});
  std::vector<std::uint8_t> rubs(plates * plates, 0);
  // What `samples` of them add that overlap at one of a plate.
  const auto add_overlap = [&](int lower, int upper, std::int32_t at, double samples) {
    const Vector3 r = times(model.frame[crust.plate[at]], model.mesh->samples().position(at));
    const std::size_t pair = std::min(lower, upper) * plates + std::max(lower, upper);
    rubs[pair] = 1;
    for (int c = 0; c < 3; ++c) {
      for (int d = 0; d < 3; ++d) {
        overlap[pair][c][d] +=
            samples * model.settings.suture_drag * ((c == d ? 1.0 : 0.0) - r[c] * r[d]);
      }
    }
  };
  for (const std::int32_t i : model.margins.contacts) {
    const std::int32_t above = model.margins.partner[i];
    if (model.margins.hidden[i] == 0 || crust.continental[i] == 0 || crust.continental[above] == 0)
      continue;
    const int lower = model.state.root(crust.plate[i]),
              upper = model.state.root(crust.plate[above]);
    add_overlap(lower, upper, i, 1.0);
  }
  const double spacing_km = model.settings.radius_km * model.mesh->samples().spacing();
  for (const TrenchSample& front : model.margins.trenches) {
    const std::int32_t below = model.margins.partner[front.sample];
    if (below < 0 || crust.plate[front.sample] < 0 || crust.plate[below] < 0) continue;
    if (crust.continental[front.sample] == 0 || crust.continental[below] == 0) continue;
    const int upper = model.state.root(crust.plate[front.sample]),
              lower = model.state.root(crust.plate[below]);
    const double remembered = model.state.pair(lower, upper).under_km / spacing_km;
    if (lower == upper || remembered <= 0.0) continue;
    add_overlap(lower, upper, front.sample, remembered);
  }
  std::vector<Link> links;
  for (std::size_t at = 0; at < rubs.size(); ++at) {
    if (rubs[at] != 0) {
      links.push_back({static_cast<int>(at / plates), static_cast<int>(at % plates), overlap[at]});
    }
  }
  return links;
}

}  // namespace

/// The sum of 1 - r r^T over a plate's samples. As each covers some ground, also a plate of one
/// resists a spin about itself: by s / 2 pi about the middle of a disc of s steradians.
Matrix3 drag_below(const SphereTectonics& model, int plate) {
  const auto& cap = model.partition.cap(plate);
  Matrix3 drag = carried(model.frame[plate], cap.inertia);
  const double spin = cap.samples * model.mesh->samples().area_sr() / (2.0 * std::numbers::pi);
  for (int c = 0; c < 3; ++c) drag[c][c] += spin;
  return drag;
}

/// What holds each plate back with all that it carries.
std::vector<Matrix3> drag_below(const SphereTectonics& model) {
  std::vector<Matrix3> drag(model.state.plates.size(), Matrix3{});
  for (std::size_t p = 0; p < drag.size(); ++p) {
    if (!model.state.plates[p].alive) continue;
    const Matrix3 own = drag_below(model, static_cast<int>(p));
    Matrix3& sum = drag[model.state.root(static_cast<int>(p))];
    for (int c = 0; c < 3; ++c) sum[c] = add(sum[c], own[c]);
  }
  return drag;
}

/// Plates that are linked yield. On each the drag of the mantle on what it moves beside the motion
/// that drives it and that of its links on how it moves beside other plates come to nothing.
void yield_to_links(SphereTectonics& model, const std::vector<Matrix3>& drag) {
  for (SpherePlate& plate : model.state.plates) plate.yielding = {};
  derive_motion(model);
  std::vector<Link> links;
  if (model.settings.rift_onset_myr > 0.0) links = links_of_rifts(model, drag);
  if (model.settings.suture_drag > 0.0) {
    const std::vector<Link> more = links_of_continents(model);
    links.insert(links.end(), more.begin(), more.end());
  }
  std::vector<std::uint8_t> yields(model.state.plates.size(), 0);
  for (const Link& link : links) {
    for (const int p : {link.first, link.second}) yields[p] = model.state.plates[p].is_held ? 0 : 1;
  }
  LinkedPlates linked(yields);
  for (int p = 0; p < std::ssize(drag); ++p) linked.hold_back(p, eigen(drag[p]));
  for (const Link& link : links) {
    linked.link(link.first, link.second, eigen(link.drag),
                eigen(add(model.rotation[link.second], model.rotation[link.first], -1.0)));
  }
  const std::vector<Vector3> changes = linked.balance();
  for (std::size_t p = 0; p < changes.size(); ++p) model.state.plates[p].yielding = changes[p];
  derive_motion(model);
}

}  // namespace geo
