#include "geo/kernels/plates/growth/continents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>

#include "geo/core/array_sizes.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/noise/noise.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

struct Craton {
  Vector3 centre;
  double radius;  // radians
};

std::vector<double> plate_areas_sr(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                                   std::size_t plates) {
  check_sizes("continental_plates", mesh.size(), {{"plate", plate.size()}});
  std::vector<double> area(plates, 0.0);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) area[plate[cell]] += mesh.area_sr(cell);
  return area;
}

std::vector<int> by_falling_buoyancy(const std::vector<Plate>& plates) {
  std::vector<int> order(plates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return plates[a].buoyancy > plates[b].buoyancy; });
  return order;
}

/// Cratons of one plate: the first anywhere on it, each other one beside an elder, not too near.
void place_cratons(const Cratons& model, const CubedSphere& mesh,
                   std::span<const std::int16_t> plate, int number, int count,
                   const RandomStream& random, std::vector<Craton>& cratons) {
  const auto key = static_cast<std::uint64_t>(number) << 20;
  std::uint64_t draw = 0;
  const double spread = 2200.0 / model.radius_km, clearance = 1250.0 / model.radius_km;
  const std::size_t first = cratons.size();
  const auto radius = [&] {
    return random.uniform(key + draw++, 0, model.smallest_km, model.largest_km) / model.radius_km;
  };
  constexpr int kTries = 200;
  for (int attempt = 0; attempt < kTries && cratons.size() == first; ++attempt) {
    const Vector3 candidate = random.direction(key + draw++);
    if (plate[mesh.locate(candidate)] == number) cratons.push_back({candidate, radius()});
  }
  if (cratons.size() == first) {  // a plate too small to be hit at random
    const auto cell = std::find(plate.begin(), plate.end(), number) - plate.begin();
    cratons.push_back({mesh.position(static_cast<std::int32_t>(cell)), radius()});
  }
  for (int k = 1; k < count; ++k) {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const auto elders = static_cast<double>(cratons.size() - first);
      const auto elder = first + static_cast<std::size_t>(random.uniform(key + draw++) * elders);
      const Vector3 jump = random.direction(key + draw++);
      const double far = spread * std::abs(random.normal(key + draw++));
      const Vector3 candidate = normalised(add(cratons[elder].centre, jump, far));
      const bool apart = std::all_of(
          cratons.begin() + static_cast<std::ptrdiff_t>(first), cratons.end(),
          [&](const Craton& c) { return angle_between(c.centre, candidate) > clearance; });
      if (!apart || plate[mesh.locate(candidate)] != number) continue;
      cratons.push_back({candidate, radius()});
      break;
    }
  }
}

/// By how much sea floor lowers the potential at some distance from where it is made or taken down.
double lowered(double share, double distance_km, double clearance_km) {
  constexpr double kDeep = 6.0;
  if (!(clearance_km > 0.0)) return 0.0;
  return kDeep * std::clamp(share, 0.0, 1.0) * std::exp(-distance_km / clearance_km);
}

double lowered_by_ridges(const Cratons& model, const Oceans& oceans, double rifting,
                         std::int32_t cell) {
  return lowered(0.65 + 3.0 * rifting, oceans.to_ridge.angle[cell] * model.radius_km,
                 model.ridge_clearance_km);
}

double lowered_before_trenches(const Cratons& model, const Oceans& oceans, double rifting,
                               std::span<const std::int16_t> plate, std::int32_t cell) {
  const std::int32_t trench = oceans.to_trench.source[cell];
  if (trench < 0 || oceans.subducting[trench] != plate[cell]) return 0.0;
  return lowered(0.5 + 15.0 * (0.03 - rifting), oceans.to_trench.angle[cell] * model.radius_km,
                 model.trench_clearance_km);
}

/// The highest of each place and those around it.
std::vector<float> highest_around(const CubedSphere& mesh, std::span<const float> values) {
  std::vector<float> highest(values.begin(), values.end());
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    for (const std::int32_t next : mesh.neighbours(cell)) {
      if (next >= 0) highest[cell] = std::max(highest[cell], values[next]);
    }
  }
  return highest;
}

/// The ways from the deepest place to all others that climb least.
struct Ways {
  std::vector<float> strait;       ///< the highest potential on the way to a place
  std::vector<std::int32_t> from;  ///< the place before, -1 at the deepest
};

Ways lowest_ways(const CubedSphere& mesh, std::span<const float> potential) {
  using Strait = std::pair<float, std::int32_t>;
  std::priority_queue<Strait, std::vector<Strait>, std::greater<>> shore;
  Ways ways{std::vector<float>(potential.size()), std::vector<std::int32_t>(potential.size(), -1)};
  std::vector<std::uint8_t> reached(potential.size(), 0);
  const auto reach = [&](std::int32_t cell, float passed, std::int32_t from) {
    if (reached[cell] != 0) return;
    reached[cell] = 1;
    ways.strait[cell] = std::max(potential[cell], passed);
    ways.from[cell] = from;
    shore.emplace(ways.strait[cell], cell);
  };
  const auto deepest = std::min_element(potential.begin(), potential.end()) - potential.begin();
  reach(static_cast<std::int32_t>(deepest), potential[deepest], -1);
  while (!shore.empty()) {
    const auto [passed, cell] = shore.top();
    shore.pop();
    for (const std::int32_t next : mesh.neighbours(cell)) {
      if (next >= 0) reach(next, passed, cell);
    }
  }
  return ways;
}

/// Deepens straits that what frays coasts may close: seas that are joined below the level `coast`
/// are so at `deep` and three cells wide.
void deepen_straits(const CubedSphere& mesh, std::span<float> potential, float coast, float deep) {
  const std::vector<float> narrowed = highest_around(mesh, potential);
  const Ways ways = lowest_ways(mesh, narrowed);
  std::vector<std::uint8_t> passed(potential.size(), 0);
  for (std::size_t sea = 0; sea < potential.size(); ++sea) {
    if (narrowed[sea] >= deep || ways.strait[sea] >= coast) continue;
    for (auto at = static_cast<std::int32_t>(sea); ways.strait[at] > deep && passed[at] == 0;
         at = ways.from[at]) {
      passed[at] = 1;
      potential[at] = std::min(potential[at], deep);
      for (const std::int32_t next : mesh.neighbours(at)) {
        if (next >= 0) potential[next] = std::min(potential[next], deep);
      }
    }
  }
}

/// Raises the potential of every basin to that of the strait by which it is joined to the deepest
/// one and `above` it. Straits are three cells wide at least. Whether there was one.
bool fill_basins(const CubedSphere& mesh, std::span<float> potential, float above) {
  const std::vector<float> narrowed = highest_around(mesh, potential);
  const Ways ways = lowest_ways(mesh, narrowed);
  bool filled = false;
  for (std::size_t cell = 0; cell < potential.size(); ++cell) {
    if (ways.strait[cell] <= narrowed[cell]) continue;
    potential[cell] = std::max(potential[cell], ways.strait[cell] + above);
    filled = true;
  }
  return filled;
}

/// A sea without a strait has closed; what is left of it around what has been filled closes too.
void close_inland_seas(const CubedSphere& mesh, std::span<float> potential) {
  constexpr float kAbove = 0.25F;
  bool filled = fill_basins(mesh, potential, kAbove);
  while (filled) filled = fill_basins(mesh, potential, 0.0F);
}

/// The level above which the potential covers a share of the sphere.
float level_above_which(const CubedSphere& mesh, std::span<const float> potential, double share) {
  std::vector<std::int32_t> falling(potential.size());
  std::iota(falling.begin(), falling.end(), 0);
  std::stable_sort(falling.begin(), falling.end(),
                   [&](std::int32_t a, std::int32_t b) { return potential[a] > potential[b]; });
  double area_sr = 0.0;
  for (const std::int32_t cell : falling) {
    area_sr += mesh.area_sr(cell);
    if (area_sr >= 4.0 * kPi * share) return potential[cell];
  }
  return potential[falling.back()];
}

}  // namespace

std::vector<std::uint8_t> continental_plates(const CubedSphere& mesh,
                                             std::span<const std::int16_t> plate,
                                             const std::vector<Plate>& plates, double share) {
  const auto area_sr = plate_areas_sr(mesh, plate, plates.size());
  std::vector<std::uint8_t> continental(plates.size(), 0);
  double missing = 4.0 * kPi * share;
  for (const int k : by_falling_buoyancy(plates)) {
    if (missing <= 0.5 * area_sr[k]) continue;  // too large to bring it nearer
    continental[k] = 1;
    missing -= area_sr[k];
  }
  return continental;
}

std::vector<std::uint8_t> continental_plates_reaching(const CubedSphere& mesh,
                                                      std::span<const std::int16_t> plate,
                                                      const std::vector<Plate>& plates,
                                                      double share) {
  const auto area_sr = plate_areas_sr(mesh, plate, plates.size());
  std::vector<std::uint8_t> continental(plates.size(), 0);
  double missing = 4.0 * kPi * share;
  for (const int k : by_falling_buoyancy(plates)) {
    if (missing <= 0.0) break;
    continental[k] = 1;
    missing -= area_sr[k];
  }
  return continental;
}

CratonNoise craton_noise(const CubedSphere& mesh, std::uint64_t seed) {
  constexpr double kFrequency = 1.6;
  const std::array<Noise, 3> bend{Noise(seed, "plates.craton_bend_x"),
                                  Noise(seed, "plates.craton_bend_y"),
                                  Noise(seed, "plates.craton_bend_z")};
  CratonNoise noise;
  for (int c = 0; c < 3; ++c) {
    noise.bend[c] = fbm_at(bend[c], mesh.positions(), kFrequency, 6, 0.55);
  }
  noise.rifting = fbm_at(Noise(seed, "plates.rifting"), mesh.positions(), 1.2, 3);
  return noise;
}

Oceans find_oceans(const Cratons& model, const CubedSphere& mesh,
                   std::span<const BoundaryPoint> boundaries, const std::vector<Plate>& plates) {
  std::vector<std::int32_t> ridge, trench;
  Oceans oceans;
  const auto speed = [&](std::int16_t plate, std::int32_t cell) {
    return length(cross(plates[plate].rotation_rad_myr, mesh.position(cell)));
  };
  for (const BoundaryPoint& point : boundaries) {
    if (point.type == BoundaryType::divergent) ridge.push_back(point.cell);
    if (point.type != BoundaryType::convergent) continue;
    if (speed(point.plate, point.cell) < speed(point.other, point.cell)) continue;
    trench.push_back(point.cell);
    oceans.subducting.push_back(point.plate);
  }
  const auto within = [&](const std::vector<std::int32_t>& sources, double clearance_km) {
    return nearest_cells(mesh, sources, 4.0 * clearance_km / model.radius_km);
  };
  oceans.to_ridge = within(ridge, model.ridge_clearance_km);
  oceans.to_trench = within(trench, model.trench_clearance_km);
  return oceans;
}

std::vector<float> craton_potential(const Cratons& model, const CubedSphere& mesh,
                                    std::span<const std::int16_t> plate,
                                    const std::vector<Plate>& plates, const Oceans& oceans,
                                    const CratonNoise& noise, std::uint64_t seed) {
  const auto area_sr = plate_areas_sr(mesh, plate, plates.size());
  const auto carries = continental_plates(mesh, plate, plates, model.plate_share);
  const RandomStream random(seed, "plates.cratons");
  std::vector<Craton> cratons;
  for (std::size_t k = 0; k < plates.size(); ++k) {
    if (carries[k] == 0 || area_sr[k] == 0.0) continue;  // some plates are all consumed
    const double count = model.per_sphere * area_sr[k] / (4.0 * kPi);
    place_cratons(model, mesh, plate, static_cast<int>(k),
                  std::max(1, static_cast<int>(std::lround(count))), random, cratons);
  }
  constexpr double kNormal = 3.2;  // fbm to a deviation of one half
  std::vector<float> potential(mesh.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    Vector3 bent = mesh.position(cell);
    for (int c = 0; c < 3; ++c) bent[c] += model.warp * kNormal * noise.bend[c][cell];
    bent = normalised(bent);
    double sum = 0.0;
    for (const Craton& craton : cratons) {
      const double far = length(add(craton.centre, bent, -1.0)) / craton.radius;
      sum += std::exp(-far * far);
    }
    potential[cell] = static_cast<float>(
        std::log(sum + 1e-26) - lowered_by_ridges(model, oceans, noise.rifting[cell], cell) -
        lowered_before_trenches(model, oceans, noise.rifting[cell], plate, cell));
  }
  constexpr float kFrays = 0.7F;  // what the noise of coasts seldom exceeds
  const float coast = level_above_which(mesh, potential, model.share);
  deepen_straits(mesh, potential, coast, coast - kFrays);
  close_inland_seas(mesh, potential);
  return potential;
}

}  // namespace geo
