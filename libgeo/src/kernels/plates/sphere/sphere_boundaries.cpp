#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"

#include <algorithm>
#include <cmath>

#include "geo/kernels/plates/plate_motion.hpp"

namespace geo {
namespace {

/// The foreign plate that most neighbours of a sample belong to, or -1.
std::int16_t foreign_plate(const SphereMesh& mesh, std::span<const std::int16_t> plate,
                           std::int32_t sample) {
  std::int16_t best = -1;
  int most = 0;
  const auto star = mesh.neighbours(sample);
  for (const std::int32_t j : star) {
    if (plate[j] == plate[sample]) continue;
    int votes = 0;
    for (const std::int32_t k : star) votes += plate[k] == plate[j];
    if (votes > most || (votes == most && plate[j] < best)) {
      most = votes;
      best = plate[j];
    }
  }
  return best;
}

double strongest(const RelativeMotion& motion) {
  return std::max({motion.closing, motion.opening, motion.shear});
}

/// Boundaries where they lie, each with the direction to the other plate.
std::vector<SphereBoundary> places_of_boundaries(const SphereMesh& mesh,
                                                 std::span<const std::int16_t> plate) {
  const FibonacciSphere& samples = mesh.samples();
  std::vector<SphereBoundary> all;
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    const std::int16_t other = foreign_plate(mesh, plate, i);
    if (other < 0) continue;
    Vector3 towards{};
    for (const std::int32_t j : mesh.neighbours(i)) {
      if (plate[j] == other)
        towards = add(towards, add(samples.position(j), samples.position(i), -1.0));
    }
    all.push_back({i,
                   plate[i],
                   other,
                   normalised(tangent(towards, samples.position(i))),
                   {},
                   BoundaryType::interior,
                   0.0});
  }
  return all;
}

/// A mean of a boundary's direction and those beside it; its other side looks the opposite way.
Vector3 mean_direction(const SphereMesh& mesh, std::span<const SphereBoundary> all,
                       std::span<const std::int32_t> number, const SphereBoundary& here) {
  Vector3 sum = here.towards;
  for (const std::int32_t j : mesh.neighbours(here.sample)) {
    if (number[j] < 0) continue;
    const SphereBoundary& beside = all[number[j]];
    if (beside.plate == here.plate && beside.other == here.other) {
      sum = add(sum, beside.towards);
    } else if (beside.plate == here.other && beside.other == here.plate) {
      sum = add(sum, beside.towards, -1.0);
    }
  }
  return normalised(tangent(sum, mesh.samples().position(here.sample)));
}

void smooth_directions(const SphereMesh& mesh, double smoothing_km, double radius_km,
                       std::vector<SphereBoundary>& all) {
  std::vector<std::int32_t> number(mesh.size(), -1);
  for (std::size_t k = 0; k < all.size(); ++k) {
    number[all[k].sample] = static_cast<std::int32_t>(k);
  }
  // A mean over the neighbours spreads by about 0.7 of the spacing.
  const double step_km = 0.7 * mesh.samples().spacing() * radius_km;
  const auto passes = static_cast<int>(std::lround(std::pow(smoothing_km / step_km, 2)));
  std::vector<Vector3> next(all.size());
  for (int pass = 0; pass < std::min(passes, 400); ++pass) {
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < all.size(); ++k) {
      next[k] = mean_direction(mesh, all, number, all[k]);
    }
    for (std::size_t k = 0; k < all.size(); ++k) all[k].towards = next[k];
  }
}

}  // namespace

std::vector<SphereBoundary> find_sphere_boundaries(const SphereMesh& mesh,
                                                   std::span<const std::int16_t> plate,
                                                   std::span<const Vector3> rotation_rad_myr,
                                                   double plate_speed_cm_yr, double smoothing_km,
                                                   double radius_km) {
  std::vector<SphereBoundary> all = places_of_boundaries(mesh, plate);
  smooth_directions(mesh, smoothing_km, radius_km, all);
  double most = 0.0;
  for (SphereBoundary& point : all) {
    const Vector3& at = mesh.samples().position(point.sample);
    point.motion = relative_motion(velocity_mm_yr(rotation_rad_myr[point.plate], at, radius_km),
                                   velocity_mm_yr(rotation_rad_myr[point.other], at, radius_km),
                                   point.towards, at);
    point.type = classify(point.motion, plate_speed_cm_yr);
    most = std::max(most, strongest(point.motion));
  }
  for (SphereBoundary& point : all) {
    point.strength = most > 0.0 ? strongest(point.motion) / most : 0.0;
  }
  return all;
}

std::vector<std::int32_t> nearest_samples(const SphereMesh& mesh,
                                          std::span<const std::int32_t> sources, double reach_rad) {
  const FibonacciSphere& samples = mesh.samples();
  const double half = std::sin(0.5 * std::min(reach_rad, 3.14159));
  const double most = 4.0 * half * half;
  std::vector<std::int32_t> nearest(mesh.size(), -1), queue, next;
  std::vector<float> chord2(mesh.size(), 9.0F);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    nearest[sources[k]] = static_cast<std::int32_t>(k);
    chord2[sources[k]] = 0.0F;
    queue.push_back(sources[k]);
  }
  while (!queue.empty()) {
    next.clear();
    for (const std::int32_t i : queue) {
      const std::int32_t source = nearest[i];
      for (const std::int32_t j : mesh.neighbours(i)) {
        if (nearest[j] == source) continue;
        const Vector3 way = add(samples.position(j), samples.position(sources[source]), -1.0);
        const double far = dot(way, way);
        if (far > most || static_cast<float>(far) >= chord2[j]) continue;
        chord2[j] = static_cast<float>(far);
        nearest[j] = source;
        next.push_back(j);
      }
    }
    queue.swap(next);
  }
  return nearest;
}

}  // namespace geo
