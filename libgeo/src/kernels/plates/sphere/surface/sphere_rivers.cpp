#include <algorithm>
#include <cmath>
#include <functional>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/plates/sphere/surface/sphere_water.hpp"
#include "geo/kernels/water/surface_rivers.hpp"
#include "kernels/plates/sphere/sample_sums.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// Angle between unit vectors that are near each other, by their chord c, to 5 c^7 / 7168:
///   2 asin(c / 2) = c + c^3 / 24 + 3 c^5 / 640 + ...
double short_arc(const Vector3& a, const Vector3& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  const double chord2 = x * x + y * y + z * z;
  return std::sqrt(chord2) * (1.0 + chord2 * (1.0 / 24.0 + chord2 * (3.0 / 640.0)));
}

/// Length of the way between places, unit vectors, m.
float length_m(const Vector3& a, const Vector3& b, double radius_km) {
  return static_cast<float>(1e3 * radius_km * short_arc(a, b));
}

/// A way from a sample across the edge of its plate.
struct Crossing {
  std::int32_t from, to;
  float distance_m;

  auto operator<=>(const Crossing&) const = default;
};

/// The surface as it lies after a step: samples that are not below another plate. Within a plate
/// neighbours are those of the lattice; across its edge, what lies where the lattice would go on.
class MovingSurface {
 public:
  explicit MovingSurface(const SphereTectonics& model) : m_(model), crust_(model.state.crust) {
    const std::int32_t n = m_.mesh->size();
    top_.resize(n);
    graph_.area_m2 = 1e6 * m_.sample_km2();
    graph_.is_there.resize(n);
    graph_.is_open.assign(n, 0);
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < n; ++i) {
      graph_.is_there[i] = crust_.plate[i] >= 0 && m_.margins.hidden[i] == 0 ? 1 : 0;
      top_[i] = graph_.is_there[i] != 0 ? crust_.plate[i] : kNone;
    }
    find_crossings();
    connect();
  }
  [[nodiscard]] const SurfaceGraph& graph() const { return graph_; }

 private:
  static constexpr std::int16_t kNone = -1;

  /// Of a sample that is there.
  [[nodiscard]] bool is_beside(std::int32_t i, std::int32_t j) const { return top_[j] == top_[i]; }
  /// The sample on top at a place of the planet that is of another plate, or -1.
  [[nodiscard]] std::int32_t across(const Vector3& place, int own) const {
    for (int q = 0; q < m_.partition.plates(); ++q) {
      if (q == own || !m_.state.plates[q].alive) continue;
      const Vector3 local = back(m_.frame[q], place);
      if (!m_.partition.may_hold(q, local)) continue;
      const std::int32_t j = m_.mesh->samples().nearest(local);
      if (top_[j] == q) return j;
    }
    return -1;
  }
  void find_crossings() {
    const FibonacciSphere& samples = m_.mesh->samples();
    const std::int32_t n = m_.mesh->size();
    constexpr std::int32_t kChunk = 2048;
    std::vector<std::vector<Crossing>> found((n + kChunk - 1) / kChunk);
    const auto search = [&](std::size_t chunk) {
      const auto from = static_cast<std::int32_t>(chunk) * kChunk;
      for (std::int32_t i = from; i < std::min(n, from + kChunk); ++i) {
        if (graph_.is_there[i] == 0) continue;
        const int own = crust_.plate[i];
        for (const std::int32_t j : m_.mesh->neighbours(i)) {
          if (is_beside(i, j)) continue;
          const std::int32_t other = across(times(m_.frame[own], samples.position(j)), own);
          if (other < 0) {
            graph_.is_open[i] = 1;
            continue;
          }
          const float far_m = length_m(times(m_.frame[own], samples.position(i)),
                                       times(m_.frame[top_[other]], samples.position(other)),
                                       m_.settings.radius_km);
          if (far_m <= 0.0F) continue;
          found[chunk].push_back({i, other, far_m});
          found[chunk].push_back({other, i, far_m});
        }
      }
    };
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
    for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
    errors.rethrow();
    crossings_ = joined(found);
    std::sort(crossings_.begin(), crossings_.end());
    const auto same = [](const Crossing& a, const Crossing& b) {
      return a.from == b.from && a.to == b.to;
    };
    crossings_.erase(std::unique(crossings_.begin(), crossings_.end(), same), crossings_.end());
  }
  void connect() {
    const std::int32_t n = m_.mesh->size();
    graph_.first.assign(static_cast<std::size_t>(n) + 1, 0);
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < n; ++i) {
      if (graph_.is_there[i] == 0) continue;
      std::int32_t ways = 0;
      for (const std::int32_t j : m_.mesh->neighbours(i)) ways += is_beside(i, j) ? 1 : 0;
      graph_.first[i + 1] = ways;
    }
    for (const Crossing& way : crossings_) ++graph_.first[way.from + 1];
    for (std::int32_t i = 0; i < n; ++i) graph_.first[i + 1] += graph_.first[i];
    const std::vector<float> made_m =
        m_.way_m.empty() ? ways_m(*m_.mesh, m_.settings.radius_km) : std::vector<float>();
    const std::vector<float>& lengths_m = m_.way_m.empty() ? made_m : m_.way_m;
    graph_.neighbour.resize(graph_.first[n]);
    graph_.distance_m.resize(graph_.first[n]);
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < n; ++i) {
      if (graph_.is_there[i] == 0) continue;
      std::int32_t at = graph_.first[i];
      const auto add_way = [&](std::int32_t to, float far_m) {
        graph_.neighbour[at] = to;
        graph_.distance_m[at++] = far_m;
      };
      std::int32_t number = m_.mesh->first_way(i);
      for (const std::int32_t j : m_.mesh->neighbours(i)) {
        if (is_beside(i, j)) add_way(j, lengths_m[number]);
        ++number;
      }
      if (at == graph_.first[i + 1]) continue;
      auto way = std::lower_bound(crossings_.begin(), crossings_.end(), Crossing{i, -1, 0.0F});
      for (; way != crossings_.end() && way->from == i; ++way) add_way(way->to, way->distance_m);
    }
  }

  const SphereTectonics& m_;
  const SphereCrust& crust_;
  SurfaceGraph graph_;
  std::vector<std::int16_t> top_;  ///< plate of each sample that is there
  std::vector<Crossing> crossings_;
};

/// Runoff over that of reference where a sample lies now; none where no climate is known.
std::function<double(std::int32_t)> runoff_of_samples(const SphereTectonics& model) {
  if (model.state.runoff.empty()) return {};
  return [&model](std::int32_t i) -> double {
    const FibonacciSphere& samples = model.mesh->samples();
    const Vector3 place = times(model.frame[model.state.crust.plate[i]], samples.position(i));
    return model.state.runoff[samples.nearest(place)];
  };
}

/// Of each sample, over that of a belt that is being folded: rock that has come up from the depth
/// of an old belt is harder, sediment is not.
std::vector<float> erodibility_of_samples(const SphereTectonics& model) {
  const SphereSettings& s = model.settings;
  if (s.old_rock_erodibility == 1.0) return {};
  constexpr float kCover_m = 100.0F;
  const SphereCrust& crust = model.state.crust;
  std::vector<float> erodibility(crust.plate.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    const double young = crust.sediment_m[i] > kCover_m
                             ? 1.0
                             : std::exp(-crust.orogeny_age_myr[i] / s.hardening_myr);
    erodibility[i] =
        static_cast<float>(s.old_rock_erodibility + (1.0 - s.old_rock_erodibility) * young);
  }
  return erodibility;
}

std::vector<float> heights_above_sea(const SphereTectonics& model) {
  std::vector<float> height_m = model.state.crust.elevation_m;
  const auto sea_level_m = static_cast<float>(model.state.sea_level_m);
  for (float& height : height_m) height -= sea_level_m;
  return height_m;
}

}  // namespace

std::vector<float> ways_m(const SphereMesh& mesh, double radius_km) {
  const std::int32_t n = mesh.size();
  std::vector<float> length_of_way_m(static_cast<std::size_t>(mesh.first_way(n)));
  const FibonacciSphere& samples = mesh.samples();
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    std::int32_t way = mesh.first_way(i);
    for (const std::int32_t j : mesh.neighbours(i)) {
      length_of_way_m[way++] = length_m(samples.position(i), samples.position(j), radius_km);
    }
  }
  return length_of_way_m;
}

std::vector<double> drained_km2(const SphereTectonics& model) {
  const SurfaceRivers rivers = route_rivers(MovingSurface(model).graph(), heights_above_sea(model),
                                            runoff_of_samples(model));
  std::vector<double> area_km2(rivers.area_m2.size(), 0.0);
  for (const std::int32_t i : rivers.order) area_km2[i] = 1e-6 * rivers.area_m2[i];
  return area_km2;
}

/// Rivers carve what stands above the sea, plates and all as they lie, and deposit what they carry
/// on plains, in lakes, on shelves and on the sea floor.
void run_rivers(SphereTectonics& model) {
  SphereCrust& crust = model.state.crust;
  const MovingSurface surface(model);
  RiverLaw law = model.settings.rivers;
  law.dt_yr = 1e6 * model.settings.law.step_myr;
  law.rebound = model.settings.rebound;
  std::vector<float> rock_m(crust.plate.size()), above_sea_m = heights_above_sea(model);
  const std::vector<float> before_m = above_sea_m;
  const SurfaceRivers rivers = route_rivers(surface.graph(), above_sea_m, runoff_of_samples(model));
  geo::run_rivers(surface.graph(), rivers, law, crust.continental, above_sea_m, rock_m,
                  erodibility_of_samples(model));
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (rock_m[i] == 0.0F) continue;
    crust.elevation_m[i] += above_sea_m[i] - before_m[i];
    if (crust.continental[i] != 0) {
      rock_m[i] = static_cast<float>(put(crust.thickness_m[i], rock_m[i]));
    } else {
      // Floor is as much thicker as it stands higher: the rest of what it bears has sunk into it.
      crust.thickness_m[i] += above_sea_m[i] - before_m[i];
    }
  }
  const auto sum_km3 = [&](auto&& counts) {
    return samples_km3(
        model, [&](std::int32_t i) { return counts(i) ? static_cast<double>(rock_m[i]) : 0.0; });
  };
  model.budget.eroded_km3 -= sum_km3([&](std::int32_t i) { return rock_m[i] < 0.0F; });
  model.budget.deposited_km3 +=
      sum_km3([&](std::int32_t i) { return rock_m[i] > 0.0F && crust.continental[i] != 0; });
  model.budget.sea_floor_km3 +=
      sum_km3([&](std::int32_t i) { return rock_m[i] > 0.0F && crust.continental[i] == 0; });
  enter_sediment(model, rock_m);
}

}  // namespace geo
