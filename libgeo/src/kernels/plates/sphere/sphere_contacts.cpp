#include <algorithm>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "sample_sums.hpp"

namespace geo {

void SphereTectonics::find_contacts() {
  const auto& blocks = partition_.blocks();
  const auto block_count = static_cast<std::int32_t>(blocks.size());
  const auto plates = static_cast<int>(state_.plates.size());
  const FibonacciSphere& samples = mesh_->samples();
  const SphereCrust& crust = state_.crust;
  std::vector<int> root(plates);
  for (int p = 0; p < plates; ++p) root[p] = state_.root(p);
  std::fill(partner_.begin(), partner_.end(), -1);
  constexpr std::int32_t kChunk = 64;
  std::vector<std::vector<std::int32_t>> found((block_count + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t b = from; b < std::min(block_count, from + kChunk); ++b) {
      const auto& block = blocks[b];
      const int own = block.plate;
      const Vector3 centre = times(frame_[own], partition_.centre(block.coarse));
      for (int other = 0; other < plates; ++other) {
        if (root[other] == root[own] || !state_.plates[other].alive) continue;
        if (!partition_.may_hold(other, back(frame_[other], centre))) continue;
        const Matrix3 to_other = back_times(frame_[other], frame_[own]);
        for (const std::int32_t i : partition_.samples(block)) {
          if (partner_[i] >= 0 && crust.continental[partner_[i]] != 0) continue;
          const std::int32_t under = samples.nearest(times(to_other, samples.position(i)));
          if (crust.plate[under] != other) continue;
          if (partner_[i] < 0) found[chunk].push_back(i);
          if (partner_[i] < 0 || crust.continental[under] != 0) partner_[i] = under;
        }
      }
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
  errors.rethrow();
  contacts_ = joined(found);
}

/// Which plate stays up where two meet anew: of oceans the one with the younger floor there, of
/// continents the one with more of them.
void SphereTectonics::decide_pairs() {
  constexpr float kForgotten_myr = 30.0F;
  const SphereCrust& crust = state_.crust;
  const std::size_t plates = state_.plates.size();
  struct Ages {
    double own = 0.0, other = 0.0;
    std::int32_t count = 0;
  };
  std::vector<Ages> ages(plates * plates);
  std::vector<std::uint8_t> touching(plates * plates, 0);
  for (const std::int32_t i : contacts_) {
    const std::int32_t j = partner_[i];
    const int a = crust.plate[i], b = crust.plate[j];
    if (a > b) continue;  // the other side sees the same
    touching[a * plates + b] = 1;
    if (crust.continental[i] != 0 || crust.continental[j] != 0) continue;
    Ages& pair = ages[a * plates + b];
    pair.own += crust.age_myr[i];
    pair.other += crust.age_myr[j];
    ++pair.count;
  }
  const auto now = static_cast<float>(state_.time_myr);
  for (std::size_t a = 0; a < plates; ++a) {
    for (std::size_t b = a + 1; b < plates; ++b) {
      if (touching[a * plates + b] == 0) continue;
      PlatePair& pair = state_.pair(static_cast<int>(a), static_cast<int>(b));
      if (now - pair.last_contact_myr > kForgotten_myr) pair = {.parted_myr = pair.parted_myr};
      pair.last_contact_myr = now;
      const Ages& met = ages[a * plates + b];
      if (pair.ocean_top < 0 && met.count > 0) pair.ocean_top = met.own <= met.other ? 0 : 1;
      if (pair.continent_top < 0) {
        const auto first = partition_.cap(static_cast<int>(a)).continental;
        const auto second = partition_.cap(static_cast<int>(b)).continental;
        pair.continent_top = first >= second ? 0 : 1;
      }
    }
  }
}

void SphereTectonics::rank_plates() {
  const auto plates = static_cast<int>(state_.plates.size());
  std::vector<double> own(plates);
  score_.assign(plates, 0.0);
  for (int p = 0; p < std::min(plates, partition_.plates()); ++p) {
    const auto& cap = partition_.cap(p);
    score_[state_.root(p)] += 100.0 * cap.continental - (cap.samples - cap.continental);
  }
  for (int p = 0; p < plates; ++p) own[p] = score_[state_.root(p)];
  score_ = std::move(own);
}

bool SphereTectonics::is_on_top(std::int32_t sample, std::int32_t other) const {
  const SphereCrust& crust = state_.crust;
  if (settings_.rank_by_score) {
    const int a = crust.plate[sample], b = crust.plate[other];
    return score_[a] != score_[b] ? score_[a] > score_[b] : a < b;
  }
  const bool land = crust.continental[sample] != 0;
  if (land != (crust.continental[other] != 0)) return land;
  const int a = crust.plate[sample], b = crust.plate[other];
  const PlatePair& pair = state_.pair(a, b);
  const std::int8_t top = land ? pair.continent_top : pair.ocean_top;
  return (top == 1) == (a > b);
}

void SphereTectonics::find_trenches() {
  const FibonacciSphere& samples = mesh_->samples();
  const SphereCrust& crust = state_.crust;
  const auto count = static_cast<std::int32_t>(contacts_.size());
  std::fill(hidden_.begin(), hidden_.end(), 0);
#pragma omp parallel for schedule(static)
  for (std::int32_t k = 0; k < count; ++k) {
    const std::int32_t i = contacts_[k];
    hidden_[i] = is_on_top(i, partner_[i]) ? 0 : 1;
  }
  constexpr std::int32_t kChunk = 1024;
  std::vector<std::vector<TrenchSample>> found((count + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t k = from; k < std::min(count, from + kChunk); ++k) {
      const std::int32_t i = contacts_[k];
      if (hidden_[i] != 0) continue;
      const Vector3& here = samples.position(i);
      const std::int16_t own = crust.plate[i];
      Vector3 outward{};
      bool is_edge = false;
      for (const std::int32_t j : mesh_->neighbours(i)) {
        const bool out = crust.plate[j] != own || hidden_[j] != 0;
        is_edge = is_edge || out;
        outward = add(outward, add(samples.position(j), here, -1.0), out ? 1.0 : -1.0);
      }
      if (!is_edge) continue;
      const std::int32_t below = partner_[i];
      const std::int16_t lower = crust.plate[below];
      const Vector3 relative =
          cross(back(frame_[own], add(rotation_[lower], rotation_[own], -1.0)), here);
      if (dot(relative, outward) >= 0.0) continue;  // they part
      found[chunk].push_back({i, lower, crust.elevation_m[below]});
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
  errors.rethrow();
  trenches_ = joined(found);
}

/// The square of the chord that spans the reach of subduction.
float SphereTectonics::farthest_chord2() const {
  const double reach = settings_.law.subduction_distance_km / settings_.radius_km;
  const double half = std::sin(0.5 * std::min(reach, 3.1));
  return static_cast<float>(4.0 * half * half);
}

/// The nearest trench to each sample of an overriding plate within the reach of subduction:
/// trenches are handed from sample to sample, each plate by itself.
void SphereTectonics::spread_trenches() {
  const FibonacciSphere& samples = mesh_->samples();
  const SphereCrust& crust = state_.crust;
  const float most = farthest_chord2();
  const std::int32_t n = mesh_->size();
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    const Vector3& at = samples.position(i);
    spots_[i] = {static_cast<float>(at[0]),
                 static_cast<float>(at[1]),
                 static_cast<float>(at[2]),
                 most,
                 -1,
                 hidden_[i] != 0 ? std::int16_t{-1} : crust.plate[i]};
  }
  std::vector<std::vector<std::int32_t>> of_plate(state_.plates.size());
  for (std::size_t k = 0; k < trenches_.size(); ++k) {
    of_plate[crust.plate[trenches_[k].sample]].push_back(static_cast<std::int32_t>(k));
  }
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t p = 0; p < of_plate.size(); ++p) {
    errors.guard([&] {
      if (!of_plate[p].empty()) spread(static_cast<int>(p), of_plate[p], nullptr);
    });
  }
  errors.rethrow();
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) trench_of_[i] = spots_[i].trench;
}

/// Hands trenches of a plate on within it and tells whom they reach.
void SphereTectonics::spread(int plate, std::span<const std::int32_t> trenches,
                             std::vector<std::int32_t>* reached) {
  std::vector<std::int32_t> queue, next;
  const auto take = [&](std::int32_t i, Spot& at, std::int32_t trench, float chord2) {
    if (reached != nullptr && at.trench < 0) reached->push_back(i);
    at.trench = trench;
    at.chord2 = chord2;
  };
  for (const std::int32_t k : trenches) {
    const std::int32_t i = trenches_[k].sample;
    take(i, spots_[i], k, 0.0F);
    queue.push_back(i);
  }
  while (!queue.empty()) {
    next.clear();
    for (const std::int32_t i : queue) {
      const std::int32_t trench = spots_[i].trench;
      const Spot source = spots_[trenches_[trench].sample];
      for (const std::int32_t j : mesh_->neighbours(i)) {
        Spot& at = spots_[j];
        if (at.plate != static_cast<std::int16_t>(plate) || at.trench == trench) continue;
        const float x = at.x - source.x, y = at.y - source.y, z = at.z - source.z;
        const float chord2 = x * x + y * y + z * z;
        if (chord2 >= at.chord2) continue;
        take(j, at, trench, chord2);
        next.push_back(j);
      }
    }
    queue.swap(next);
  }
}

}  // namespace geo
