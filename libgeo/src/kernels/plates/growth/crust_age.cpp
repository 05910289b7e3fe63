#include "geo/kernels/plates/growth/crust_age.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"
#include "kernels/numerics/wide.hpp"

namespace geo {
namespace {

constexpr std::size_t kLanes = 8;

/// Points of a ridge near each other: where, in what reach of their middle, and the least time any
/// of them takes for a radian.
struct Stretch {
  Vector3 middle;
  double reach, rad_per_myr;
  std::size_t begin, end;

  /// Whether some point could be less than a time away; yes if in doubt by round-off.
  [[nodiscard]] bool within(double time_myr, const Vector3& here) const {
    constexpr double kSafe = 1.0 + 1e-9;
    const Vector3 way = add(here, middle, -1.0);
    const double far = kSafe * (time_myr * rad_per_myr + reach);
    return dot(way, way) < far * far;
  }
};

/// The ridges of one plate: where their points are, the way the plate leaves each, and how long it
/// takes for a radian, stretch by stretch; each is filled up to whole lanes with points that are
/// never the nearest.
class Ridges {
 public:
  struct Point {
    std::int64_t patch;  ///< of the mesh; points of one patch make a stretch
    Vector3 at, away;
    double myr_per_rad;
  };
  std::array<std::vector<double>, 3> at, away;
  std::vector<double> myr_per_rad;
  std::vector<Stretch> stretches;

  explicit Ridges(std::vector<Point> points) {
    std::stable_sort(points.begin(), points.end(),
                     [](const Point& a, const Point& b) { return a.patch < b.patch; });
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
      while (end < points.size() && points[end].patch == points[begin].patch) ++end;
      add_stretch(std::span(points).subspan(begin, end - begin));
    }
  }
  [[nodiscard]] Vector3 position(std::size_t k) const { return {at[0][k], at[1][k], at[2][k]}; }
  [[nodiscard]] Vector3 leaving(std::size_t k) const {
    return {away[0][k], away[1][k], away[2][k]};
  }

 private:
  void add_stretch(std::span<const Point> points) {
    constexpr double kNever = 1e200;
    Stretch stretch{{}, 0.0, 0.0, myr_per_rad.size(), 0};
    for (const Point& point : points) {
      stretch.middle = geo::add(stretch.middle, point.at, 1.0 / static_cast<double>(points.size()));
    }
    for (const Point& point : points) {
      stretch.reach = std::max(stretch.reach, length(geo::add(point.at, stretch.middle, -1.0)));
      stretch.rad_per_myr = std::max(stretch.rad_per_myr, 1.0 / point.myr_per_rad);
      add_point(point);
    }
    while (myr_per_rad.size() % kLanes != 0) add_point({0, {}, {}, kNever});
    stretch.end = myr_per_rad.size();
    stretches.push_back(stretch);
  }
  void add_point(const Point& point) {
    for (int c = 0; c < 3; ++c) {
      at[c].push_back(point.at[c]);
      away[c].push_back(point.away[c]);
    }
    myr_per_rad.push_back(point.myr_per_rad);
  }
};

/// Time against the straight flight: floor moves along the spreading direction; what lies aside
/// was made by another part of the ridge, or before this one was there.
double detour(const Vector3& position, const Vector3& away, const Vector3& here) {
  constexpr double kAside = 0.4;
  const Vector3 heading = tangent(here, position);
  const double size2 = dot(heading, heading);
  if (size2 <= 0.0) return 1.0;
  const double along = std::max(0.0, dot(away, heading));
  return 1.0 / (kAside + (1.0 - kAside) * along * along / size2);
}

/// The square patch of cells that a cell of the mesh lies in.
std::int64_t patch_of(const CubedSphere& mesh, std::int32_t cell) {
  constexpr std::int32_t kPatch = 10;
  const std::int32_t n = mesh.cells_per_edge(), per_edge = (n + kPatch - 1) / kPatch;
  const std::int32_t face = cell / (n * n), j = cell / n % n, i = cell % n;
  return (std::int64_t{face} * per_edge + j / kPatch) * per_edge + i / kPatch;
}

/// Squares of the times of straight flight from kLanes points, Myr2, and the least of them.
TERRANE_WIDE double straight_times2(const Ridges& ridges, std::size_t begin, double x, double y,
                                    double z, double* __restrict times2) {
  const double* __restrict at_x = &ridges.at[0][begin];
  const double* __restrict at_y = &ridges.at[1][begin];
  const double* __restrict at_z = &ridges.at[2][begin];
  const double* __restrict slowness = &ridges.myr_per_rad[begin];
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const double cosine = x * at_x[lane] + y * at_y[lane] + z * at_z[lane];
    const double chord2 = 2.0 - 2.0 * cosine;
    times2[lane] = (chord2 > 0.0 ? chord2 : 0.0) * slowness[lane] * slowness[lane];
  }
  return *std::min_element(times2, times2 + kLanes);
}

/// Square of the least time from any point of the ridges, Myr2. The stretch to begin with, `first`,
/// becomes the one where that point lies; it decides how much can be left out, not the result.
double least_time2(const Ridges& ridges, const Vector3& here, std::size_t& first) {
  double least2 = 1e30;
  std::array<double, kLanes> times2;
  const auto look_along = [&](std::size_t number) {
    const Stretch& stretch = ridges.stretches[number];
    for (std::size_t begin = stretch.begin; begin < stretch.end; begin += kLanes) {
      if (straight_times2(ridges, begin, here[0], here[1], here[2], times2.data()) >= least2) {
        continue;
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (times2[lane] >= least2) continue;
        const std::size_t k = begin + lane;
        const double factor = detour(ridges.position(k), ridges.leaving(k), here);
        const double time2 = times2[lane] * factor * factor;
        if (time2 >= least2) continue;
        least2 = time2;
        first = number;
      }
    }
  };
  if (ridges.stretches.empty()) return least2;
  look_along(first);
  double least = std::sqrt(least2);
  for (std::size_t number = 0; number < ridges.stretches.size(); ++number) {
    if (!ridges.stretches[number].within(least, here)) continue;
    look_along(number);
    least = std::sqrt(least2);
  }
  return least2;
}

}  // namespace

std::vector<float> ocean_age_myr(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                                 std::span<const BoundaryPoint> boundaries,
                                 std::span<const Vector3> rotation_rad_myr, double oldest_myr,
                                 double radius_km) {
  check_sizes("ocean_age_myr", mesh.size(), {{"plate", plate.size()}});
  constexpr double kSlowest_mm_yr = 4.0;
  const auto plates = 1 + *std::max_element(plate.begin(), plate.end());
  std::vector<std::vector<Ridges::Point>> points(plates);
  for (const BoundaryPoint& point : boundaries) {
    if (point.type != BoundaryType::divergent) continue;
    const double half_rate_km_myr = std::max(kSlowest_mm_yr, 0.5 * point.motion.opening);
    const Vector3& at = mesh.position(point.cell);
    const Vector3 relative =
        cross(add(rotation_rad_myr[point.plate], rotation_rad_myr[point.other], -1.0), at);
    points[point.plate].push_back(
        {patch_of(mesh, point.cell), at, normalised(relative), radius_km / half_rate_km_myr});
  }
  std::vector<Ridges> ridges;
  for (auto& own : points) ridges.emplace_back(std::move(own));
  std::vector<float> age(mesh.size());
  ParallelErrors errors;
#pragma omp parallel
  {
    // Where the floor of the cell before came from: a guess that leaves out most of the rest.
    auto origin = errors.make<std::vector<std::size_t>>(plates, 0);
#pragma omp for schedule(dynamic, 1024)
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      if (errors.any()) continue;
      const Ridges& own = ridges[plate[cell]];
      const double time = std::sqrt(least_time2(own, mesh.position(cell), origin[plate[cell]]));
      age[cell] = static_cast<float>(oldest_myr * std::tanh(time / oldest_myr));
    }
  }
  errors.rethrow();
  return age;
}

}  // namespace geo
