#include <algorithm>
#include <cmath>

#include "geo/core/random.hpp"
#include "geo/kernels/great_circle_line.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {

int SphereTectonics::largest_plate() const {
  int largest = 0;
  for (int p = 1; p < partition_.plates(); ++p) {
    if (state_.plates[p].carrier >= 0) continue;
    if (partition_.cap(p).samples > partition_.cap(largest).samples) largest = p;
  }
  return largest;
}

void SphereTectonics::rift_by_chance() {
  const RandomStream random(seed_, "plates.rifts");
  const auto step = static_cast<std::uint64_t>(state_.steps) << 10U;
  const auto plates = static_cast<int>(state_.plates.size());
  const int largest = settings_.rift_largest ? largest_plate() : -1;
  for (int p = 0; p < plates; ++p) {
    if (!state_.plates[p].alive || state_.plates[p].carrier >= 0) continue;
    if (settings_.rift_largest && p != largest) continue;
    const auto& cap = partition_.cap(p);
    const double ratio = sample_km2() * cap.samples / settings_.mean_area_km2;
    if (ratio < settings_.rift_smallest) continue;
    // Continents break more easily than the floor of oceans.
    const double weight =
        settings_.rift_largest ? 1.0 : 0.2 + 0.8 * cap.continental / std::max(1, cap.samples);
    const std::uint64_t index = step + static_cast<std::uint64_t>(p);
    const double chance =
        rift_probability(settings_.rift_per_myr * settings_.law.step_myr, weight, ratio);
    if (random.uniform(index) >= chance) continue;
    const double draw = random.uniform(index, 1);
    const int fragments = settings_.rift_largest || draw < 0.6 ? 2 : draw < 0.9 ? 3 : 4;
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
  part(plate, fragment, away, speed_mm_yr, SphereEvent::Kind::rift);
  ++budget_.rifts;
}

void SphereTectonics::rift_along(int plate, const GreatCircleLine& line, int fragments,
                                 double speed_mm_yr) {
  const std::int32_t n = mesh_->size();
  std::vector<std::int8_t> fragment(n, -1);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    if (state_.crust.plate[i] != plate) continue;
    const Vector3 at = times(frame_[plate], mesh_->samples().position(i));
    const bool is_left = line.is_left(at), is_cut = line.is_beyond_middle(at);
    fragment[i] = is_left ? (is_cut && fragments > 3 ? 3 : 0) : (is_cut && fragments > 2 ? 2 : 1);
  }
  std::vector<Vector3> sum(fragments, Vector3{}), away;
  for (std::int32_t i = 0; i < n; ++i) {
    if (fragment[i] >= 0) sum[fragment[i]] = add(sum[fragment[i]], mesh_->samples().position(i));
  }
  for (const Vector3& of : sum) {
    away.push_back(normalised(cross(line.middle(), times(frame_[plate], of))));
  }
  part(plate, fragment, away, speed_mm_yr, SphereEvent::Kind::rift);
  ++budget_.rifts;
}

/// Fragments of a plate become plates, each turned about an axis on top of the old motion. One that
/// has no samples comes to nothing.
void SphereTectonics::part(int plate, std::span<const std::int8_t> fragment,
                           std::span<const Vector3> away, double speed_mm_yr,
                           SphereEvent::Kind kind) {
  auto& of = state_.crust.plate;
  const auto& cap = partition_.cap(plate);
  const Vector3 centre = times(frame_[plate], cap.centre);
  const double area_km2 = sample_km2() * cap.samples;
  const SpherePlate whole = state_.plates[plate];
  const Vector3 drift = scaled(whole.axis, whole.speed_rad_myr);
  std::vector<int> numbers;
  for (std::size_t k = 0; k < away.size(); ++k) {
    SpherePlate part = whole;
    part.born_myr = state_.time_myr;
    const Vector3 gained = scaled(away[k], speed_mm_yr / settings_.radius_km);
    const Vector3 rotation = add(drift, gained);
    part.speed_rad_myr =
        std::min(length(rotation), settings_.law.speed_mm_yr / settings_.radius_km);
    if (part.speed_rad_myr > 0.0) part.axis = normalised(rotation);
    const bool is_gradual = kind == SphereEvent::Kind::rift && settings_.rift_onset_myr > 0.0;
    if (is_gradual && !whole.is_held) {  // at first they move as the whole did
      part.yielding = add(add(whole.yielding, drift), part.axis, -part.speed_rad_myr);
    }
    int number = plate;
    if (k == 0) {
      state_.plates[plate] = part;
    } else {
      number = state_.add_plate(part);
    }
    for (std::int32_t i = 0; i < mesh_->size(); ++i) {
      if (fragment[i] == static_cast<std::int8_t>(k)) of[i] = static_cast<std::int16_t>(number);
    }
    if (kind == SphereEvent::Kind::rift) {
      for (const int other : numbers) {
        state_.pair(number, other).parted_myr = static_cast<float>(state_.time_myr);
      }
    }
    numbers.push_back(number);
  }
  events_.push_back({kind, state_.time_myr, plate, -1, centre, area_km2});
  repartition();
}

}  // namespace geo
