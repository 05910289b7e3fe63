#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "kernels/plates/sphere/sphere_flood.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// A plume that is nearer to a ridge than this, in spacings of samples, is as good as below it.
constexpr double kBesideSpacings = 2.0;
/// Plates that part more slowly have no ridge between them, mm/yr.
constexpr double kOpening_mm_yr = 5.0;

/// A ridge beside a plume, as the plume sees it.
struct RidgeBeside {
  int own, beyond;    ///< plates above the plume and on the other side of the ridge
  Vector3 plume;      ///< unit vector
  Vector3 ahead;      ///< unit vector on the surface: the way on which the other plate leaves
  Vector3 along;      ///< and the one across it
  double spacing_km;  ///< of samples
  std::vector<std::int32_t> floor;  ///< young floor of the own plate around the plume

  /// Distances of a sample from the plume on both ways, km.
  [[nodiscard]] double ahead_km(const SphereTectonics& model, std::int32_t sample) const {
    return model.settings.radius_km * dot(model.mesh->samples().position(sample), ahead);
  }
  [[nodiscard]] double along_km(const SphereTectonics& model, std::int32_t sample) const {
    return model.settings.radius_km * dot(model.mesh->samples().position(sample), along);
  }
};

/// Floor of the plate above a plume, around it, that is young enough to break; nearest first.
std::vector<std::int32_t> young_floor(const SphereTectonics& model, std::int32_t above) {
  const SphereCrust& crust = model.state.crust;
  std::vector<std::uint8_t> seen(crust.plate.size(), 0);
  return flooded_from(*model.mesh, above, seen, [&](std::int32_t i) {
    return crust.plate[i] == crust.plate[above] && crust.continental[i] == 0 &&
           crust.age_myr[i] <= model.settings.ridge_jump_age_myr &&
           model.distance_km(i, above) <= model.settings.ridge_jump_km;
  });
}

/// Of a sample at a plate's edge another plate's floor beside it, or -1.
std::int32_t floor_beyond(const SphereTectonics& model, std::int32_t edge) {
  const SphereCrust& crust = model.state.crust;
  for (const std::int32_t j : model.mesh->neighbours(edge)) {
    if (crust.plate[j] != crust.plate[edge] && crust.continental[j] == 0) return j;
  }
  return -1;
}

/// The nearest ridge of the plate above a plume, if it has one within reach, but not below itself.
std::optional<RidgeBeside> ridge_beside(const SphereTectonics& model, const SpherePlume& plume) {
  const SphereCrust& crust = model.state.crust;
  const double radius_km = model.settings.radius_km;
  const std::int32_t above = model.mesh->samples().nearest(plume.place);
  if (crust.continental[above] != 0 || crust.age_myr[above] > model.settings.ridge_jump_age_myr) {
    return {};
  }
  const int own = crust.plate[above];
  RidgeBeside ridge{own,
                    -1,
                    model.mesh->samples().position(above),
                    {},
                    {},
                    radius_km * model.mesh->samples().spacing(),
                    young_floor(model, above)};
  for (const std::int32_t edge : ridge.floor) {
    const std::int32_t over = floor_beyond(model, edge);
    if (over < 0) continue;
    const int beyond = crust.plate[over];
    const Vector3& at = model.mesh->samples().position(over);
    const Vector3 parting = cross(add(model.rotation[beyond], model.rotation[own], -1.0), at);
    const Vector3 way = add(at, ridge.plume, -dot(at, ridge.plume));
    if (dot(parting, normalised(way)) * radius_km < kOpening_mm_yr) continue;
    if (model.distance_km(over, above) < kBesideSpacings * ridge.spacing_km) return {};
    const Vector3 level = add(parting, ridge.plume, -dot(parting, ridge.plume));
    ridge.beyond = beyond;
    ridge.ahead = normalised(level);
    ridge.along = cross(ridge.plume, ridge.ahead);
    return ridge;
  }
  return {};
}

/// How far the ridge reaches without a gap on both sides of the plume, km.
std::pair<double, double> extent_km(const SphereTectonics& model, const RidgeBeside& ridge) {
  const auto bin_of = [&](std::int32_t sample) {
    return static_cast<int>(std::lround(ridge.along_km(model, sample) / ridge.spacing_km));
  };
  std::set<int> with_ridge;
  for (const std::int32_t edge : ridge.floor) {
    if (ridge.ahead_km(model, edge) <= 0.0) continue;
    const std::int32_t over = floor_beyond(model, edge);
    if (over >= 0 && model.state.crust.plate[over] == ridge.beyond) with_ridge.insert(bin_of(edge));
  }
  int first = 0, last = 0;
  while (with_ridge.contains(first - 1)) --first;
  while (with_ridge.contains(last + 1)) ++last;
  return {(first - 0.5) * ridge.spacing_km, (last + 0.5) * ridge.spacing_km};
}

/// Floor between a plume and the ridge.
std::vector<std::int32_t> strip_before(const SphereTectonics& model, const RidgeBeside& ridge) {
  const auto [first_km, last_km] = extent_km(model, ridge);
  std::vector<std::int32_t> strip;
  for (const std::int32_t i : ridge.floor) {
    const double along_km = ridge.along_km(model, i);
    if (ridge.ahead_km(model, i) > 0.0 && along_km >= first_km && along_km <= last_km) {
      strip.push_back(i);
    }
  }
  return strip;
}

}  // namespace

/// The plate breaks where a plume has heated it: what lies between there and the ridge comes to the
/// plate beyond, and new floor grows above the plume from then on.
void jump_ridges(SphereTectonics& model) {
  if (!(model.settings.ridge_jump_km > 0.0)) return;
  SphereState& state = model.state;
  for (const SpherePlume& plume : state.plumes) {
    if (!(plume.growth_mm_yr > 0.0)) continue;
    const auto ridge = ridge_beside(model, plume);
    if (!ridge || !is_free(state.plates[ridge->own]) || !is_free(state.plates[ridge->beyond])) {
      continue;
    }
    const std::vector<std::int32_t> strip = strip_before(model, *ridge);
    if (strip.empty() || 2 * std::ssize(strip) > model.partition.cap(ridge->own).samples) continue;
    for (const std::int32_t i : strip) {
      state.crust.plate[i] = static_cast<std::int16_t>(ridge->beyond);
    }
    model.events.push_back({SphereEvent::Kind::ridge_jump, state.time_myr, ridge->own,
                            ridge->beyond, ridge->plume,
                            model.sample_km2() * static_cast<double>(strip.size())});
    derive_plates(model);
  }
}

}  // namespace geo
