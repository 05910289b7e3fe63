#include <cmath>

#include "sphere_steps.hpp"

namespace geo {

Vector3 driven_rotation(const SphereState& state, int plate) {
  const SpherePlate& root = state.plates[state.root(plate)];
  return scaled(root.axis, root.speed_rad_myr);
}

void derive_motion(SphereTectonics& model) {
  model.frame.resize(model.state.plates.size());
  model.rotation.resize(model.state.plates.size());
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    const SpherePlate& root = model.state.plates[model.state.root(static_cast<int>(p))];
    model.frame[p] = model.state.plates[p].turn.matrix();
    model.rotation[p] = add(driven_rotation(model.state, static_cast<int>(p)), root.yielding);
  }
}

/// The rotation whose angular momentum is that of all plates that are not held together, as if all
/// crust weighed the same: the sums of 1 - r r^T over the samples take the place of the integral's
/// 8 pi / 3. Zero where all are held.
Vector3 net_rotation(const SphereTectonics& model) {
  Vector3 momentum{};
  Matrix3 inertia{};
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    const bool is_held = model.state.plates[model.state.root(static_cast<int>(p))].is_held;
    if (!model.state.plates[p].alive || is_held) continue;
    const Matrix3& own = model.partition.cap(static_cast<int>(p)).inertia;
    momentum =
        add(momentum, times(model.frame[p], times(own, back(model.frame[p], model.rotation[p]))));
    const Matrix3 whole = carried(model.frame[p], own);
    for (int c = 0; c < 3; ++c) inertia[c] = add(inertia[c], whole[c]);
  }
  // The tensor is symmetric: its rows are its columns.
  const Vector3 first = cross(inertia[1], inertia[2]);
  const double determinant = dot(inertia[0], first);
  const double trace = inertia[0][0] + inertia[1][1] + inertia[2][2];
  constexpr double kNothing = 1e-12;
  if (determinant <= kNothing * trace * trace * trace) return {};
  return scaled(Vector3{dot(momentum, first), dot(momentum, cross(inertia[2], inertia[0])),
                        dot(momentum, cross(inertia[0], inertia[1]))},
                1.0 / determinant);
}

void subtract_net_rotation(SphereTectonics& model) {
  const Vector3 net = add(net_rotation(model), model.state.kept_rotation_rad_myr, -1.0);
  for (SpherePlate& plate : model.state.plates) {
    if (plate.is_held) continue;
    const Vector3 rotation = add(scaled(plate.axis, plate.speed_rad_myr), net, -1.0);
    plate.speed_rad_myr = length(rotation);
    if (plate.speed_rad_myr > 0.0) plate.axis = normalised(rotation);
  }
  derive_motion(model);
}

void move_plates(SphereTectonics& model) {
  model.state.past_myr.push_back(model.state.time_myr);
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    SpherePlate& plate = model.state.plates[p];
    if (!plate.alive) continue;
    plate.past.push_back(plate.turn);
    plate.turn =
        Quaternion::about(scaled(model.rotation[p], model.settings.law.step_myr)).after(plate.turn);
  }
  derive_motion(model);
}

void pull_slabs(SphereTectonics& model) {
  // Trenches stand in the order of their samples, so the sums have one shape.
  const double per_trench = model.settings.slab_pull * model.settings.law.step_myr *
                            model.mesh->samples().spacing() * model.settings.radius_km / 1000.0;
  std::vector<Vector3> pull(model.state.plates.size(), Vector3{});
  for (const TrenchSample& trench : model.margins.trenches) {
    const int lower = model.state.root(trench.lower);
    const int upper = model.state.crust.plate[trench.sample];
    const Vector3 at = times(model.frame[upper], model.mesh->samples().position(trench.sample));
    const Vector3 centre = times(model.frame[lower], model.partition.cap(lower).centre);
    pull[lower] = add(pull[lower], slab_pull(centre, at));
  }
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    if (model.state.plates[p].is_held) continue;
    model.state.plates[p].axis = normalised(add(model.state.plates[p].axis, pull[p], per_trench));
  }
  derive_motion(model);
}

}  // namespace geo
