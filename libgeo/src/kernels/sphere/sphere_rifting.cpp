#include <algorithm>
#include <cmath>

#include "geo/core/random.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {
namespace {

/// A line of great circles that parts a sphere.
class SplittingLine {
 public:
  explicit SplittingLine(std::vector<Vector3> line) {
    const Vector3 first = line.front(), last = line.back();
    const double half = 0.5 * length_of(line);
    double gone = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) {
      const double step = angle_between(line[k - 1], line[k]);
      if (gone <= half && gone + step >= half) {
        const Vector3 normal = normalised(cross(line[k - 1], line[k]));
        middle_ = rotated(line[k - 1], scaled(normal, half - gone));
        along_ = cross(normal, middle_);
      }
      gone += step;
    }
    // Beyond its ends, so that it parts whatever plate it lies on.
    constexpr double kBeyond = 1.0;  // radians
    const Vector3 before = scaled(normalised(cross(line[0], line[1])), -kBeyond);
    const Vector3 behind = scaled(normalised(cross(line[line.size() - 2], last)), kBeyond);
    line.insert(line.begin(), rotated(first, before));
    line.push_back(rotated(last, behind));
    for (std::size_t k = 1; k < line.size(); ++k) {
      arcs_.push_back({line[k - 1], line[k], normalised(cross(line[k - 1], line[k]))});
    }
  }
  [[nodiscard]] const Vector3& middle() const { return middle_; }

  /// 0 left of the line, 1 right of it; of three and four parts also 2 right and 3 left of it
  /// beyond its middle.
  [[nodiscard]] int part_of(const Vector3& at, int parts) const {
    const bool is_left = side(at) >= 0.0, is_beyond = dot(at, along_) > 0.0;
    if (is_beyond && parts > 2 && !is_left) return 2;
    if (is_beyond && parts > 3 && is_left) return 3;
    return is_left ? 0 : 1;
  }

 private:
  struct Arc {
    Vector3 from, to, normal;  // the normal points to the left
  };
  static double length_of(const std::vector<Vector3>& line) {
    double sum = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) sum += angle_between(line[k - 1], line[k]);
    return sum;
  }
  /// Above 0 on the left: of the nearest arc, or of both that meet in the nearest corner.
  [[nodiscard]] double side(const Vector3& at) const {
    double least = 9.0, value = 0.0;
    for (std::size_t k = 0; k < arcs_.size(); ++k) {
      const auto& [from, to, normal] = arcs_[k];
      const double over = dot(at, normal);
      const bool beside = dot(cross(normal, from), at) >= 0.0 && dot(cross(to, normal), at) >= 0.0;
      const double far = beside ? std::asin(std::min(1.0, std::abs(over))) : angle_between(at, to);
      if (far >= least) continue;
      least = far;
      value = beside || k + 1 == arcs_.size() ? over : dot(at, add(normal, arcs_[k + 1].normal));
    }
    return value;
  }

  std::vector<Arc> arcs_;
  Vector3 middle_{}, along_{};
};

}  // namespace

void SphereTectonics::rift_by_chance() {
  const RandomStream random(seed_, "plates.rifts");
  const auto step = static_cast<std::uint64_t>(state_.steps) << 10U;
  const auto plates = static_cast<int>(state_.plates.size());
  for (int p = 0; p < plates; ++p) {
    if (!state_.plates[p].alive || state_.plates[p].carrier >= 0) continue;
    const auto& cap = partition_.cap(p);
    const double ratio = sample_km2() * cap.samples / settings_.mean_area_km2;
    if (ratio < settings_.rift_smallest) continue;
    // Continents break more easily than the floor of oceans.
    const double weight = 0.2 + 0.8 * cap.continental / std::max(1, cap.samples);
    const std::uint64_t index = step + static_cast<std::uint64_t>(p);
    const double chance =
        rift_probability(settings_.rift_per_myr * settings_.law.step_myr, weight, ratio);
    if (random.uniform(index) >= chance) continue;
    const double draw = random.uniform(index, 1);
    const int fragments = draw < 0.6 ? 2 : draw < 0.9 ? 3 : 4;
    // Places drawn on the sphere until enough lie on the plate.
    std::vector<Vector3> places;
    for (std::uint64_t k = 0; k < 4000 && std::ssize(places) < fragments; ++k) {
      const Vector3 at = random.direction((index << 12U) + k);
      if (state_.crust.plate[mesh_->samples().nearest(back(frame_[p], at))] == p) {
        places.push_back(at);
      }
    }
    if (std::ssize(places) < 2) continue;
    rift(p, places, settings_.rift_speed_mm_yr * random.uniform(index, 2, 0.6, 1.4));
  }
}

void SphereTectonics::rift(int plate, std::span<const Vector3> places, double speed_mm_yr) {
  const FibonacciSphere& samples = mesh_->samples();
  const auto& of = state_.crust.plate;
  const Vector3 centre = times(frame_[plate], partition_.cap(plate).centre);
  std::vector<Vector3> local;
  for (const Vector3& place : places) local.push_back(back(frame_[plate], place));
  const double most = 2.2 * settings_.rift_warp_km / settings_.radius_km;
  constexpr double kWavelength_km = 1500.0;
  std::vector<std::int8_t> fragment(of.size(), -1);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh_->size(); ++i) {
    if (of[i] != plate) continue;
    Vector3 at = samples.position(i);
    const Vector3 straight = at;
    for (int c = 0; c < 3; ++c) {
      const Vector3 shifted{straight[0] + 3.1 * c, straight[1] - 1.7 * c, straight[2] + 0.9 * c};
      at[c] += most * warp_.fbm(shifted, settings_.radius_km / kWavelength_km, 5);
    }
    double least = 9.0;
    for (std::size_t k = 0; k < local.size(); ++k) {
      const double far = length(add(at, local[k], -1.0));
      if (far < least) {
        least = far;
        fragment[i] = static_cast<std::int8_t>(k);
      }
    }
  }
  // Away from the middle of the plate that was.
  std::vector<Vector3> away;
  for (const Vector3& place : places) away.push_back(normalised(cross(centre, place)));
  part(plate, fragment, away, speed_mm_yr);
}

void SphereTectonics::rift_along(int plate, std::span<const Vector3> line, int fragments,
                                 double speed_mm_yr) {
  const FibonacciSphere& samples = mesh_->samples();
  std::vector<Vector3> local;
  for (const Vector3& place : line) local.push_back(back(frame_[plate], place));
  const SplittingLine split(local);
  std::vector<std::int8_t> fragment(state_.crust.plate.size(), -1);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh_->size(); ++i) {
    if (state_.crust.plate[i] != plate) continue;
    fragment[i] = static_cast<std::int8_t>(split.part_of(samples.position(i), fragments));
  }
  std::vector<Vector3> sum(fragments, Vector3{}), away;
  for (std::int32_t i = 0; i < mesh_->size(); ++i) {
    if (fragment[i] >= 0) sum[fragment[i]] = add(sum[fragment[i]], samples.position(i));
  }
  for (const Vector3& of : sum) {
    away.push_back(times(frame_[plate], normalised(cross(split.middle(), of))));
  }
  part(plate, fragment, away, speed_mm_yr);
}

/// Fragments of a plate become plates, each turned about an axis on top of the old motion. One that
/// has no samples comes to nothing.
void SphereTectonics::part(int plate, std::span<const std::int8_t> fragment,
                           std::span<const Vector3> away, double speed_mm_yr) {
  auto& of = state_.crust.plate;
  const auto& cap = partition_.cap(plate);
  const Vector3 centre = times(frame_[plate], cap.centre);
  const double area_km2 = sample_km2() * cap.samples;
  const SpherePlate whole = state_.plates[plate];
  const Vector3 drift = scaled(whole.axis, whole.speed_rad_myr);
  for (std::size_t k = 0; k < away.size(); ++k) {
    SpherePlate part = whole;
    part.born_myr = state_.time_myr;
    const Vector3 rotation = add(drift, away[k], speed_mm_yr / settings_.radius_km);
    part.speed_rad_myr =
        std::min(length(rotation), settings_.law.speed_mm_yr / settings_.radius_km);
    if (part.speed_rad_myr > 0.0) part.axis = normalised(rotation);
    int number = plate;
    if (k == 0) {
      state_.plates[plate] = part;
    } else {
      number = state_.add_plate(part);
    }
    for (std::int32_t i = 0; i < mesh_->size(); ++i) {
      if (fragment[i] == static_cast<std::int8_t>(k)) of[i] = static_cast<std::int16_t>(number);
    }
  }
  ++budget_.rifts;
  events_.push_back({SphereEvent::Kind::rift, state_.time_myr, plate, -1, centre, area_km2});
  repartition();
}

}  // namespace geo
