#include "geo/kernels/plates/growth/plate_growth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <tuple>

#include "geo/core/random.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/plates/growth/plate_pieces.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// A unit vector `angle` away from `from`, towards `bearing` (radians, from an arbitrary zero).
Vector3 step_from(const Vector3& from, double bearing, double angle) {
  const Vector3 helper = std::abs(from[2]) < 0.9 ? Vector3{0, 0, 1} : Vector3{1, 0, 0};
  const Vector3 across = normalised(cross(helper, from));
  const Vector3 along = cross(from, across);
  const Vector3 heading = add(scaled(across, std::cos(bearing)), along, std::sin(bearing));
  return normalised(add(scaled(from, std::cos(angle)), heading, std::sin(angle)));
}

/// The cells from which one plate grows.
std::vector<Vector3> nuclei_of(const Plate& plate, std::uint64_t number, std::int64_t count,
                               const RandomStream& random) {
  const std::uint64_t key = number << 16;
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) {
    return random.uniform(key + draw++, 0, low, high);
  };
  const double reach = std::sqrt(4.0 / static_cast<double>(count)) *
                       std::sqrt(plate.size_bias);  // radius of its share
  std::vector<Vector3> nuclei{plate.centre};
  const int secondary = 2 + static_cast<int>(uniform(0.0, 6.0));
  for (int k = 0; k < secondary; ++k) {
    nuclei.push_back(step_from(plate.centre, uniform(0.0, 2.0 * kPi), reach * uniform(0.15, 0.65)));
  }
  const int path = 6 + static_cast<int>(uniform(0.0, 13.0));
  double bearing = uniform(0.0, 2.0 * kPi);
  const double bend = uniform(-0.35, 0.35);
  Vector3 at = plate.centre;
  for (int k = 0; k < path; ++k) {
    at = step_from(at, bearing, reach * uniform(0.05, 0.12));
    bearing += bend + uniform(-0.3, 0.3);
    nuclei.push_back(at);
  }
  return nuclei;
}

/// Factors of eq. 2.2 that belong to a place.
struct Terrain {
  std::vector<float> structure, leaving, entering;  // f_structure; parts of f_rough
};

Terrain terrain_of(const PlateGrowth& model, const CubedSphere& mesh, std::uint64_t seed) {
  const Noise structure(seed, "plates.structure"), phase(seed, "plates.roughness");
  const double frequency = model.radius_km / model.structure_km;
  const auto weakness = fbm_at(structure, mesh.positions(), frequency, 4, 0.6);
  const auto phases = fbm_at(phase, mesh.positions(), 3.0 * frequency, 2);
  Terrain terrain;
  for (auto* values : {&terrain.structure, &terrain.leaving, &terrain.entering}) {
    values->resize(mesh.size());
  }
#pragma omp parallel for schedule(static)
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    const Vector3& p = mesh.position(cell);
    const double weak = 1.8 * weakness[cell];
    terrain.structure[cell] = static_cast<float>(
        std::clamp(0.62 + 0.98 * weak + 0.36 - model.roughness * 0.17, 0.45, 1.9));
    const double xi = 4.0 * kPi * phases[cell];
    const double polar = 1.0 + model.polar_resistance *
                                   std::abs(std::asin(std::clamp(p[2], -1.0, 1.0))) / (0.5 * kPi);
    terrain.leaving[cell] = static_cast<float>(0.22 * model.roughness * std::sin(xi));
    terrain.entering[cell] = static_cast<float>(0.18 * model.roughness * std::cos(xi));
    terrain.structure[cell] *= static_cast<float>(polar);
  }
  return terrain;
}

}  // namespace

std::vector<Plate> draw_plates(const PlateGrowth& model, std::uint64_t seed) {
  const RandomStream random(seed, "plates.specification"), place(seed, "plates.centres"),
      pole(seed, "plates.poles");
  std::vector<Plate> plates(model.count);
  const auto candidates = static_cast<std::uint64_t>(model.centre_candidates);
  for (std::size_t k = 0; k < plates.size(); ++k) {
    double farthest = -1.0;
    for (std::uint64_t c = 0; c < candidates; ++c) {
      const Vector3 candidate = place.direction(k * candidates + c);
      double nearest = kPi;
      for (std::size_t other = 0; other < k; ++other) {
        nearest = std::min(nearest, angle_between(candidate, plates[other].centre));
      }
      if (nearest <= farthest) continue;
      farthest = nearest;
      plates[k].centre = candidate;
    }
    const std::uint64_t key = k;
    const double speed_km_myr = 10.0 * model.speed_cm_yr * random.uniform(key, 0, 0.5, 1.5);
    const double rate = speed_km_myr / model.radius_km * random.uniform(key, 1, 0.82, 1.24);
    plates[k].rotation_rad_myr = scaled(pole.direction(key), rate);
    plates[k].buoyancy = random.uniform(key, 2, -1.0, 1.0);
    plates[k].heat = 0.5 + model.mantle_heat * random.uniform(key, 3) * 2.5;
    plates[k].size_bias = std::exp(model.size_spread * random.normal(key, 4));
  }
  return plates;
}

std::vector<std::int16_t> grow_plates(const PlateGrowth& model, const CubedSphere& mesh,
                                      const std::vector<Plate>& plates, std::uint64_t seed) {
  const Terrain terrain = terrain_of(model, mesh, seed);
  const RandomStream nuclei(seed, "plates.nuclei"), spreads(seed, "plates.spread");
  std::vector<std::int16_t> plate(mesh.size(), -1);
  std::vector<double> cost(mesh.size(), std::numeric_limits<double>::infinity());
  using Entry = std::tuple<double, std::int32_t, std::int16_t>;  // cost, cell, plate
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::vector<double> spread(plates.size());
  for (std::size_t k = 0; k < plates.size(); ++k) {
    spread[k] = spreads.uniform(k, 0, 0.82, 1.22) / std::pow(plates[k].size_bias, 0.36);
    for (const Vector3& nucleus : nuclei_of(plates[k], k, model.count, nuclei)) {
      front.emplace(0.0, mesh.locate(nucleus), static_cast<std::int16_t>(k));
    }
  }
  while (!front.empty()) {
    const auto [reached, cell, owner] = front.top();
    front.pop();
    if (plate[cell] >= 0) continue;
    plate[cell] = owner;
    cost[cell] = reached;
    const Vector3& here = mesh.position(cell);
    const Vector3 drift = normalised(cross(plates[owner].rotation_rad_myr, here));
    for (const std::int32_t next : mesh.neighbours(cell)) {
      if (plate[next] >= 0) continue;
      const Vector3 step = add(mesh.position(next), here, -1.0);
      const double distance = length(step);
      const double rough = 1.0 + terrain.leaving[cell] + terrain.entering[next];
      const double along = 1.03 - 0.12 * dot(step, drift) / distance;
      const double total =
          reached + distance * spread[owner] * rough * along * terrain.structure[next];
      if (total >= cost[next]) continue;
      cost[next] = total;
      front.emplace(total, next, owner);
    }
  }
  merge_small_pieces(mesh, model.smallest_part_km2 / (model.radius_km * model.radius_km), plate);
  return plate;
}

}  // namespace geo
