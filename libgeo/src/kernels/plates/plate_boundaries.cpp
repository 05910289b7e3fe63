#include "geo/kernels/plates/plate_boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/plates/plate_motion.hpp"

namespace geo {
namespace {

/// Cells within some steps of a cell, for one thread.
class Surroundings {
 public:
  Surroundings(const CubedSphere& mesh, int rings)
      : mesh_(mesh), rings_(rings), seen_(mesh.size(), 0) {}

  /// The cell itself, then ring by ring, each in the order of the mesh.
  std::span<const std::int32_t> of(std::int32_t cell) {
    cells_.assign(1, cell);
    seen_[cell] = ++visit_;
    std::size_t begin = 0;
    for (int ring = 0; ring < rings_; ++ring) {
      const std::size_t end = cells_.size();
      for (std::size_t at = begin; at < end; ++at) {
        for (const std::int32_t next : mesh_.neighbours(cells_[at])) {
          if (seen_[next] == visit_) continue;
          seen_[next] = visit_;
          cells_.push_back(next);
        }
      }
      std::sort(cells_.begin() + static_cast<std::ptrdiff_t>(end), cells_.end());
      begin = end;
    }
    return cells_;
  }

 private:
  const CubedSphere& mesh_;
  int rings_;
  std::int32_t visit_ = 0;
  std::vector<std::int32_t> seen_;  // the last visit to each cell
  std::vector<std::int32_t> cells_;
};

/// The plate that most neighbours of a boundary cell belong to, its own aside.
std::int16_t opposite_plate(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                            std::int32_t cell) {
  std::int16_t most = -1;
  int best = 0;
  for (const std::int32_t next : mesh.neighbours(cell)) {
    if (plate[next] == plate[cell]) continue;
    int count = 0;
    for (const std::int32_t other : mesh.neighbours(cell)) count += plate[other] == plate[next];
    if (count > best || (count == best && plate[next] < most)) {
      best = count;
      most = plate[next];
    }
  }
  return most;
}

double dominant(const RelativeMotion& motion, BoundaryType type) {
  switch (type) {
    case BoundaryType::convergent:
      return motion.closing;
    case BoundaryType::divergent:
      return motion.opening;
    case BoundaryType::transform:
      return motion.shear;
    default:
      return 0.0;
  }
}

}  // namespace

RelativeMotion relative_motion(const Vector3& own_mm_yr, const Vector3& other_mm_yr,
                               const Vector3& towards, const Vector3& at) {
  const Vector3 relative = add(other_mm_yr, own_mm_yr, -1.0);
  const double away = dot(relative, towards);
  const double along = dot(relative, cross(at, towards));
  return {std::max(0.0, -away), std::max(0.0, away), std::abs(along)};
}

BoundaryType classify(const RelativeMotion& motion, double plate_speed_cm_yr) {
  const double scale = 10.0 * std::max(1.2, 1.25 * plate_speed_cm_yr);
  const auto leads = [&](double one, double opposite) {
    return one > 0.14 * scale && one >= 0.95 * opposite && one >= 0.75 * motion.shear;
  };
  if (leads(motion.closing, motion.opening)) return BoundaryType::convergent;
  if (leads(motion.opening, motion.closing)) return BoundaryType::divergent;
  return motion.shear > 0.18 * scale ? BoundaryType::transform : BoundaryType::interior;
}

namespace {

/// The direction of a boundary over the cells around a point, and how its plates move there.
void take_motion(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                 std::span<const std::int32_t> around, std::span<const Vector3> rotation_rad_myr,
                 double radius_km, BoundaryPoint& point) {
  const Vector3& here = mesh.position(point.cell);
  Vector3 towards{};
  for (const std::int32_t cell : around) {
    const double side = plate[cell] == point.other ? 1.0 : plate[cell] == point.plate ? -1.0 : 0.0;
    towards = add(towards, add(mesh.position(cell), here, -1.0), side);
  }
  point.towards = normalised(tangent(towards, here));
  point.motion = relative_motion(velocity_mm_yr(rotation_rad_myr[point.plate], here, radius_km),
                                 velocity_mm_yr(rotation_rad_myr[point.other], here, radius_km),
                                 point.towards, here);
}

/// The mean motion over points of the same two plates around one.
RelativeMotion mean_motion(const BoundaryPoint& point, std::span<const std::int32_t> around,
                           std::span<const std::int32_t> point_of,
                           std::span<const BoundaryPoint> points) {
  double away = 0.0, shear = 0.0;
  int count = 0;
  for (const std::int32_t cell : around) {
    if (point_of[cell] < 0) continue;
    const BoundaryPoint& near = points[point_of[cell]];
    const bool same = (near.plate == point.plate && near.other == point.other) ||
                      (near.plate == point.other && near.other == point.plate);
    if (!same) continue;
    away += near.motion.opening - near.motion.closing;
    shear += near.motion.shear;
    ++count;
  }
  away /= count;
  return {std::max(0.0, -away), std::max(0.0, away), shear / count};
}

}  // namespace

std::vector<BoundaryPoint> find_boundaries(const CubedSphere& mesh,
                                           std::span<const std::int16_t> plate,
                                           std::span<const Vector3> rotation_rad_myr,
                                           double plate_speed_cm_yr, double smoothing_km,
                                           double radius_km) {
  check_sizes("find_boundaries", mesh.size(), {{"plate", plate.size()}});
  std::vector<BoundaryPoint> points;
  std::vector<std::int32_t> point_of(mesh.size(), -1);
  for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
    const std::int16_t other = opposite_plate(mesh, plate, cell);
    if (other < 0) continue;
    point_of[cell] = static_cast<std::int32_t>(points.size());
    points.push_back({cell, plate[cell], other, {}, {}, BoundaryType::interior, 0.0});
  }
  const double smoothing_rad = std::min(smoothing_km / radius_km, kWidestSmoothing_rad);
  const int rings = std::max(1, static_cast<int>(std::lround(smoothing_rad / mesh.spacing())));
  std::vector<BoundaryPoint> raw(points.size());
  ParallelErrors errors;
#pragma omp parallel
  {
    auto made = errors.make<Surroundings>(mesh, rings);
#pragma omp for schedule(dynamic, 64)
    for (std::size_t k = 0; k < points.size(); ++k) {
      errors.guard([&] {
        take_motion(mesh, plate, made->of(points[k].cell), rotation_rad_myr, radius_km, points[k]);
        raw[k] = points[k];
      });
    }
#pragma omp for schedule(dynamic, 64)
    for (std::size_t k = 0; k < points.size(); ++k) {
      errors.guard([&] {
        BoundaryPoint& point = points[k];
        point.motion = mean_motion(point, made->of(point.cell), point_of, raw);
        point.type = classify(point.motion, plate_speed_cm_yr);
        point.strength = dominant(point.motion, point.type);
      });
    }
  }
  errors.rethrow();
  double strongest = 0.0;
  for (const BoundaryPoint& point : points) strongest = std::max(strongest, point.strength);
  for (BoundaryPoint& point : points) {
    if (strongest > 0.0) point.strength /= strongest;
  }
  return points;
}

CrustBudget crust_budget(const CubedSphere& mesh, std::span<const std::int16_t> plate,
                         std::span<const BoundaryPoint> boundaries,
                         std::span<const Vector3> rotation_rad_myr, double radius_km) {
  check_sizes("crust_budget", mesh.size(), {{"plate", plate.size()}});
  std::vector<double> away(mesh.size(), 0.0);
  for (const BoundaryPoint& point : boundaries) {
    away[point.cell] = point.motion.opening - point.motion.closing;
  }
  CrustBudget budget{0.0, 0.0};
  const double km2_yr = 1e-6 * radius_km * radius_km;
  for (const BoundaryPoint& point : boundaries) {
    for (const auto& side : mesh.sides(point.cell)) {
      const std::int16_t other = plate[side.beyond];
      if (other <= point.plate) continue;  // each side once
      const Vector3 relative = add(rotation_rad_myr[other], rotation_rad_myr[point.plate], -1.0);
      const double flux = km2_yr * dot(relative, add(side.to, side.from, -1.0));
      if (away[point.cell] + away[side.beyond] > 0.0) {
        budget.created += flux;
      } else {
        budget.consumed -= flux;
      }
    }
  }
  return budget;
}

NearestCells nearest_cells(const CubedSphere& mesh, std::span<const std::int32_t> sources,
                           double reach_rad) {
  NearestCells nearest;
  nearest.source.assign(mesh.size(), -1);
  nearest.angle.assign(mesh.size(), std::numeric_limits<float>::infinity());
  using Entry = std::tuple<float, std::int32_t, std::int32_t>;  // angle, source, cell
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::vector<double> chord2(mesh.size(), std::numeric_limits<double>::infinity());
  const auto offer = [&](std::int32_t source, std::int32_t cell) {
    if (nearest.source[cell] == source) return;
    const Vector3& from = mesh.position(sources[source]);
    const Vector3& to = mesh.position(cell);
    const Vector3 way = add(to, from, -1.0);
    const double far2 = dot(way, way);
    constexpr double kSafe = 1.0 + 1e-6;  // by so much more, and the angle is larger too
    if (far2 > kSafe * chord2[cell]) return;
    const auto angle = static_cast<float>(angle_between(from, to));
    if (angle >= nearest.angle[cell] || angle > reach_rad) return;
    chord2[cell] = far2;
    nearest.angle[cell] = angle;
    nearest.source[cell] = source;
    front.emplace(angle, source, cell);
  };
  for (std::size_t k = 0; k < sources.size(); ++k) {
    offer(static_cast<std::int32_t>(k), sources[k]);
  }
  while (!front.empty()) {
    const auto [angle, source, cell] = front.top();
    front.pop();
    if (nearest.source[cell] != source) continue;
    for (const std::int32_t next : mesh.neighbours(cell)) offer(source, next);
  }
  return nearest;
}

}  // namespace geo
