#include <algorithm>
#include <cmath>
#include <vector>

#include "sphere_behind.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// How much of a trench retreats at once, km, and the least of an arc that can, samples.
constexpr double kTrench_km = 2000.0;
constexpr std::size_t kLeast = 8;
/// Floor that is farther behind the trench above it is no longer part of its plate.
constexpr double kSunk_km = 100.0;
/// A plate that advances on its trench faster than this is shortened instead, mm/yr.
constexpr double kAdvance_mm_yr = 10.0;

/// Whether floor below an edge is old enough to sink away from it.
bool is_old_below(const SphereTectonics& model, std::int32_t edge) {
  const SphereCrust& crust = model.state.crust;
  const std::int32_t below = model.margins.partner[edge];
  return below >= 0 && crust.continental[below] == 0 &&
         crust.age_myr[below] >= model.settings.back_arc_age_myr;
}

/// Axis, in the frame of the planet, about which an arc moves on its trench, or zero.
Vector3 towards_trench(const SphereTectonics& model, std::span<const std::int32_t> arc) {
  Vector3 middle{}, edge{};
  for (const std::int32_t i : arc) {
    const std::int32_t trench = model.margins.nearest_trench[i];
    middle = add(middle, model.mesh->samples().position(i));
    edge = add(edge, model.mesh->samples().position(model.margins.trenches[trench].sample));
  }
  const Vector3 axis = cross(normalised(middle), normalised(edge));
  if (length(axis) <= 0.0) return {};
  return times(model.frame[model.state.crust.plate[arc.front()]], normalised(axis));
}

/// The slab below a stretch of trench sinks, the trench retreats, and the arc above follows it.
void open_back_arc(SphereTectonics& model, int plate, std::int32_t trench) {
  // As wide as arcs are.
  const std::vector<std::int32_t> arc =
      behind_trench(model, trench, kTrench_km, model.settings.back_arc_km,
                    [](std::int32_t /*sample*/) { return true; });
  if (arc.size() < kLeast ||
      2 * std::ssize(arc) > static_cast<std::ptrdiff_t>(model.partition.cap(plate).samples))
    return;
  const Vector3 axis = towards_trench(model, arc);
  if (length(axis) <= 0.0) return;
  const double advance = dot(model.rotation[plate], axis) * model.settings.radius_km;
  if (advance > kAdvance_mm_yr) return;
  std::vector<std::int8_t> fragment(model.mesh->size(), -1);
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (model.state.crust.plate[i] == plate) fragment[i] = 0;
  }
  for (const std::int32_t i : arc) fragment[i] = 1;
  const std::vector<Vector3> away{Vector3{}, axis};
  part_plate(model, plate, fragment, away, model.settings.back_arc_mm_yr,
             SphereEvent::Kind::back_arc);
}

/// The plate of a number, or that which it has become part of; -1: it has gone down.
int plate_of_life(const SphereState& state, std::int16_t id) {
  // Numbers are given again in the end: no life is followed farther than there are lives.
  for (std::size_t k = 0; k < state.lives.size() && id >= 0; ++k) {
    if (state.lives[id].ended_myr == PlateLife::kLives) break;
    id = state.lives[id].joined;
  }
  for (int p = 0; id >= 0 && p < std::ssize(state.plates); ++p) {
    if (state.plates[p].alive && state.plates[p].id == id) return state.root(p);
  }
  return -1;
}

/// An arc that leaves the plate behind it.
struct Basin {
  int arc, behind;
  Vector3 centre;  ///< of the arc, unit vector
};
std::vector<Basin> opening_basins(const SphereTectonics& model) {
  std::vector<Basin> basins;
  const int plates = std::min<int>(model.partition.plates(), std::ssize(model.state.plates));
  for (int p = 0; p < plates; ++p) {
    const SpherePlate& plate = model.state.plates[p];
    if (!plate.alive || plate.carrier >= 0 || !is_back_arc(model.state, p)) continue;
    const Vector3 centre = times(model.frame[p], model.partition.cap(p).centre);
    basins.push_back({p, plate_of_life(model.state, model.state.lives[plate.id].parent), centre});
  }
  return basins;
}

/// Whether a sample is of an arc or near it on the plate behind.
bool is_beside(const SphereTectonics& model, std::span<const Basin> basins, std::int32_t sample) {
  const std::int16_t own = model.state.crust.plate[sample];
  const int root = model.state.root(own);
  const double is_near = std::cos(kTrench_km / model.settings.radius_km);
  const Vector3 at = times(model.frame[own], model.mesh->samples().position(sample));
  return std::ranges::any_of(basins, [&](const Basin& basin) {
    return basin.arc == root || (basin.behind == root && dot(at, basin.centre) > is_near);
  });
}

}  // namespace

bool is_back_arc(const SphereState& state, int plate) {
  const std::int16_t id = state.plates[plate].id;
  return id >= 0 && state.lives[id].origin == PlateLife::Origin::back_arc;
}

/// Plates lie flat over each other: without this a basin would open onto the floor that has gone
/// below the arc, and below what is behind it, since the crust was resampled.
bool sink_slabs(SphereTectonics& model) {
  const std::vector<Basin> basins = opening_basins(model);
  if (basins.empty()) return false;
  SphereCrust& crust = model.state.crust;
  const SphereMargins& margins = model.margins;
  bool has_sunk = false;
  for (const std::int32_t i : margins.contacts) {
    if (margins.hidden[i] == 0 || crust.continental[i] != 0 || crust.plate[i] < 0) continue;
    const std::int32_t above = margins.partner[i], trench = margins.nearest_trench[above];
    if (crust.plate[above] < 0 || !is_beside(model, basins, above)) continue;
    if (trench >= 0 && model.distance_km(above, margins.trenches[trench].sample) < kSunk_km) {
      continue;
    }
    crust.plate[i] = -1;
    has_sunk = true;
  }
  return has_sunk;
}

/// Each length of trench above old floor begins to retreat at a rate.
void open_back_arcs_by_chance(SphereTectonics& model) {
  if (model.settings.back_arc_per_myr <= 0.0) return;
  act_by_chance(
      model, trenches_where(model, [&](std::int32_t edge) { return is_old_below(model, edge); }),
      model.settings.back_arc_per_myr, "plates.back_arcs",
      [&](int plate) { return !is_back_arc(model.state, plate); },
      [&](int plate, std::int32_t trench) { open_back_arc(model, plate, trench); });
}

/// An arc follows its trench no faster than the slab sinks away below it.
void hold_back_arcs(SphereTectonics& model) {
  const double most = model.settings.back_arc_mm_yr / model.settings.radius_km;
  for (int p = 0; p < std::ssize(model.state.plates); ++p) {
    SpherePlate& arc = model.state.plates[p];
    if (!arc.alive || arc.carrier >= 0 || arc.is_held || !is_back_arc(model.state, p)) continue;
    const int behind = plate_of_life(model.state, model.state.lives[arc.id].parent);
    if (behind < 0 || behind == p) continue;
    const Vector3 own = scaled(arc.axis, arc.speed_rad_myr);
    const Vector3 opening = add(own, driven_rotation(model.state, behind), -1.0);
    if (length(opening) <= most) continue;
    const Vector3 held = add(driven_rotation(model.state, behind), opening, most / length(opening));
    arc.speed_rad_myr = length(held);
    if (arc.speed_rad_myr > 0.0) arc.axis = normalised(held);
  }
  derive_motion(model);
}

}  // namespace geo
