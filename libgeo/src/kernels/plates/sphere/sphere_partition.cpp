#include "geo/kernels/plates/sphere/sphere_partition.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

constexpr std::int32_t kSamplesPerBlock = 32, kMostBlocks = 30000;

std::int32_t blocks_for(std::int32_t samples) {
  return std::clamp(samples / kSamplesPerBlock, FibonacciSphere::kPolar / 3, kMostBlocks);
}

}  // namespace

SpherePartition::SpherePartition(const SphereMesh& mesh)
    : mesh_(&mesh), coarse_(blocks_for(mesh.size())) {
  const FibonacciSphere& samples = mesh.samples();
  const std::int32_t n = mesh.size(), m = coarse_.size();
  coarse_of_.resize(n);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    coarse_of_[i] = static_cast<std::int16_t>(coarse_.nearest(samples.position(i)));
  }
  place_first_.assign(static_cast<std::size_t>(m) + 1, 0);
  for (const std::int16_t place : coarse_of_) ++place_first_[place + 1];
  for (std::int32_t g = 0; g < m; ++g) place_first_[g + 1] += place_first_[g];
  by_place_.resize(n);
  std::vector<std::int32_t> fill(place_first_.begin(), place_first_.end() - 1);
  for (std::int32_t i = 0; i < n; ++i) by_place_[fill[coarse_of_[i]]++] = i;

  // A block's samples are within one cell's radius of its centre, the centre within one of the
  // coarse place it is found at, and a plate's sample within one of its own place.
  const double cell = 0.72 * coarse_.spacing();
  reach_ = 3.0 * cell + samples.spacing();
  std::vector<std::vector<std::int32_t>> around(m);
  const auto look_around = [&](std::int32_t g) {
    const double lowest = std::cos(std::min(reach_, 3.0));
    // Indices of the lattice descend in z.
    const double z = coarse_.position(g)[2], colatitude = std::acos(std::clamp(z, -1.0, 1.0));
    const auto index_at = [&](double angle) {
      const double c = std::cos(std::clamp(angle, 0.0, 3.14159265358979));
      return static_cast<std::int32_t>(std::clamp(0.5 * m * (1.0 - c), 0.0, m - 1.0));
    };
    const std::int32_t from = std::max(0, index_at(colatitude - reach_) - 2);
    const std::int32_t to = std::min(m - 1, index_at(colatitude + reach_) + 2);
    for (std::int32_t h = from; h <= to; ++h) {
      if (dot(coarse_.position(g), coarse_.position(h)) >= lowest) around[g].push_back(h);
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 64)
  for (std::int32_t g = 0; g < m; ++g) errors.guard([&] { look_around(g); });
  errors.rethrow();
  around_first_.assign(1, 0);
  for (const auto& places : around) {
    around_.insert(around_.end(), places.begin(), places.end());
    around_first_.push_back(static_cast<std::int32_t>(around_.size()));
  }
}

void SpherePartition::rebuild(const SphereState& state) {
  const std::int32_t m = coarse_.size();
  const auto plates = static_cast<std::int32_t>(state.plates.size());
  const auto key = [&](std::int32_t i) {
    return static_cast<std::size_t>(state.crust.plate[i]) * m + coarse_of_[i];
  };
  std::vector<std::int32_t> first(static_cast<std::size_t>(plates) * m + 1, 0);
  // Samples of one place have keys of their own: places do not meet.
#pragma omp parallel for schedule(static)
  for (std::int32_t g = 0; g < m; ++g) {
    for (const std::int32_t i : samples_at(g)) {
      if (state.crust.plate[i] >= 0) ++first[key(i) + 1];
    }
  }
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  order_.resize(first.back());
  blocks_.clear();
  near_.assign(static_cast<std::size_t>(plates) * m, 0);
  for (std::int32_t p = 0; p < plates; ++p) {
    for (std::int32_t g = 0; g < m; ++g) {
      const std::size_t at = static_cast<std::size_t>(p) * m + g;
      if (first[at + 1] == first[at]) continue;
      blocks_.push_back({static_cast<std::int16_t>(p), static_cast<std::int16_t>(g), first[at],
                         first[at + 1] - first[at]});
    }
  }
#pragma omp parallel for schedule(static)
  for (std::int32_t g = 0; g < m; ++g) {
    for (const std::int32_t i : samples_at(g)) {
      if (state.crust.plate[i] >= 0) order_[first[key(i)]++] = i;
    }
  }
  cap_.assign(plates, {});
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int32_t p = 0; p < plates; ++p) measure(p);
  count_continents(state);
}

std::span<const SpherePartition::Block> SpherePartition::blocks_of(int plate) const {
  const auto by_plate = [](const Block& block, int number) { return block.plate < number; };
  const auto from = std::lower_bound(blocks_.begin(), blocks_.end(), plate, by_plate);
  const auto to = std::lower_bound(from, blocks_.end(), plate + 1, by_plate);
  return {from, to};
}

/// Sums over a plate and the places near it.
void SpherePartition::measure(int plate) {
  const FibonacciSphere& samples = mesh_->samples();
  Cap& cap = cap_[plate];
  const std::size_t row = static_cast<std::size_t>(plate) * coarse_.size();
  for (const Block& block : blocks_of(plate)) {
    cap.samples += block.count;
    for (const std::int32_t i : this->samples(block)) {
      const Vector3& r = samples.position(i);
      cap.centre = add(cap.centre, r);
      for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) cap.inertia[a][b] += (a == b ? 1.0 : 0.0) - r[a] * r[b];
      }
    }
    for (std::int32_t k = around_first_[block.coarse]; k < around_first_[block.coarse + 1]; ++k) {
      near_[row + around_[k]] = 1;
    }
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < a; ++b) cap.inertia[a][b] = cap.inertia[b][a];
  }
  cap.centre = normalised(cap.centre);
  if (cap.samples == 0) return;
  cap.cos_radius = 1.0;
  for (const Block& block : blocks_of(plate)) {
    cap.cos_radius = std::min(cap.cos_radius, dot(cap.centre, centre(block.coarse)));
  }
  const double radius = std::acos(std::clamp(cap.cos_radius, -1.0, 1.0)) + reach_;
  cap.cos_radius = radius >= 3.14159 ? -2.0 : std::cos(radius);
}

void SpherePartition::count_continents(const SphereState& state) {
#pragma omp parallel for schedule(dynamic, 1)
  for (int p = 0; p < plates(); ++p) {
    std::int32_t continental = 0;
    for (const Block& block : blocks_of(p)) {
      for (const std::int32_t i : samples(block)) continental += state.crust.continental[i];
    }
    cap_[p].continental = continental;
  }
}

}  // namespace geo
