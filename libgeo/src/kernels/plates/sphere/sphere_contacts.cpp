#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "geo/core/parallel_errors.hpp"
#include "sample_sums.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// Samples with another plate at the same place: what is there, continents first.
void find_contacts(SphereTectonics& model) {
  const auto& blocks = model.partition.blocks();
  const auto block_count = static_cast<std::int32_t>(blocks.size());
  const auto plates = static_cast<int>(model.state.plates.size());
  const FibonacciSphere& samples = model.mesh->samples();
  const SphereCrust& crust = model.state.crust;
  std::vector<int> root(plates);
  for (int p = 0; p < plates; ++p) root[p] = model.state.root(p);
  std::vector<std::int32_t>& partner = model.margins.partner;
  std::fill(partner.begin(), partner.end(), -1);
  constexpr std::int32_t kChunk = 64;
  std::vector<std::vector<std::int32_t>> found((block_count + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t b = from; b < std::min(block_count, from + kChunk); ++b) {
      const auto& block = blocks[b];
      const int own = block.plate;
      const Vector3 centre = times(model.frame[own], model.partition.centre(block.coarse));
      for (int other = 0; other < plates; ++other) {
        if (root[other] == root[own] || !model.state.plates[other].alive) continue;
        if (!model.partition.may_hold(other, back(model.frame[other], centre))) continue;
        const Matrix3 to_other = back_times(model.frame[other], model.frame[own]);
        for (const std::int32_t i : model.partition.samples(block)) {
          if (partner[i] >= 0 && crust.continental[partner[i]] != 0) continue;
          const std::int32_t under = samples.nearest(times(to_other, samples.position(i)));
          if (crust.plate[under] != other) continue;
          if (partner[i] < 0) found[chunk].push_back(i);
          if (partner[i] < 0 || crust.continental[under] != 0) partner[i] = under;
        }
      }
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
  errors.rethrow();
  model.margins.contacts = joined(found);
}

/// Area along which plates must have met before it is final whose floor is younger there.
constexpr double kMet_km2 = 2e5;

/// Which plate stays up where two meet anew: of oceans the one with the younger floor there, of
/// continents the one with more of them.
void decide_pairs(SphereTectonics& model) {
  constexpr float kForgotten_myr = 30.0F;
  const SphereCrust& crust = model.state.crust;
  const std::size_t plates = model.state.plates.size();
  struct Ages {
    double own = 0.0, other = 0.0;
    std::int32_t count = 0;
  };
  std::vector<Ages> ages(plates * plates);
  std::vector<std::uint8_t> touching(plates * plates, 0);
  for (const std::int32_t i : model.margins.contacts) {
    const std::int32_t j = model.margins.partner[i];
    const int a = crust.plate[i], b = crust.plate[j];
    if (a > b) continue;  // the other side sees the same
    touching[a * plates + b] = 1;
    if (crust.continental[i] != 0 || crust.continental[j] != 0) continue;
    Ages& pair = ages[a * plates + b];
    pair.own += crust.age_myr[i];
    pair.other += crust.age_myr[j];
    ++pair.count;
  }
  const auto now = static_cast<float>(model.state.time_myr);
  for (std::size_t a = 0; a < plates; ++a) {
    for (std::size_t b = a + 1; b < plates; ++b) {
      if (touching[a * plates + b] == 0) continue;
      PlatePair& pair = model.state.pair(static_cast<int>(a), static_cast<int>(b));
      if (now - pair.last_contact_myr > kForgotten_myr) pair = {.parted_myr = pair.parted_myr};
      pair.last_contact_myr = now;
      const Ages& met = ages[a * plates + b];
      if (!pair.is_ocean_top_final && met.count > 0) {
        pair.ocean_top = met.own <= met.other ? 0 : 1;
        pair.is_ocean_top_final = met.count * model.sample_km2() > kMet_km2;
      }
      if (pair.continent_top < 0) {
        const auto first = model.partition.cap(static_cast<int>(a)).continental;
        const auto second = model.partition.cap(static_cast<int>(b)).continental;
        pair.continent_top = first >= second ? 0 : 1;
      }
    }
  }
}

/// Which of them lie under the other plate: subducted floor and continents thrust below.
void hide_what_is_below(SphereTectonics& model) {
  SphereMargins& margins = model.margins;
  const auto count = static_cast<std::int32_t>(margins.contacts.size());
  std::fill(margins.hidden.begin(), margins.hidden.end(), 0);
#pragma omp parallel for schedule(static)
  for (std::int32_t k = 0; k < count; ++k) {
    const std::int32_t i = margins.contacts[k];
    margins.hidden[i] = is_on_top(model, i, margins.partner[i]) ? 0 : 1;
  }
}

/// Where the edge of a plate overrides another one that comes.
void find_trenches(SphereTectonics& model) {
  const FibonacciSphere& samples = model.mesh->samples();
  const SphereCrust& crust = model.state.crust;
  SphereMargins& margins = model.margins;
  const auto count = static_cast<std::int32_t>(margins.contacts.size());
  constexpr std::int32_t kChunk = 1024;
  std::vector<std::vector<TrenchSample>> found((count + kChunk - 1) / kChunk);
  const auto search = [&](std::size_t chunk) {
    const auto from = static_cast<std::int32_t>(chunk) * kChunk;
    for (std::int32_t k = from; k < std::min(count, from + kChunk); ++k) {
      const std::int32_t i = margins.contacts[k];
      if (margins.hidden[i] != 0) continue;
      const Vector3& here = samples.position(i);
      const std::int16_t own = crust.plate[i];
      const auto star = model.mesh->neighbours(i);
      const auto is_out = [&](std::int32_t j) {
        return crust.plate[j] != own || margins.hidden[j] != 0;
      };
      if (std::ranges::none_of(star, is_out)) continue;
      Vector3 outward{};
      for (const std::int32_t j : star) {
        outward = add(outward, add(samples.position(j), here, -1.0), is_out(j) ? 1.0 : -1.0);
      }
      const std::int32_t below = margins.partner[i];
      const std::int16_t lower = crust.plate[below];
      const Vector3 relative = cross(
          back(model.frame[own], add(model.rotation[lower], model.rotation[own], -1.0)), here);
      if (dot(relative, outward) >= 0.0) continue;  // they part
      found[chunk].push_back({i, lower, crust.elevation_m[below]});
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) errors.guard([&] { search(chunk); });
  errors.rethrow();
  margins.trenches = joined(found);
}

/// The nearest trench to each sample of an overriding plate within the reach of subduction:
/// trenches are handed from sample to sample, each plate by itself.
void find_nearest_trenches(SphereTectonics& model) {
  SphereMargins& margins = model.margins;
  std::vector<TrenchSpot> spots = spots_of_samples(model);
  std::vector<std::vector<std::int32_t>> of_plate(model.state.plates.size());
  for (std::size_t k = 0; k < margins.trenches.size(); ++k) {
    of_plate[model.state.crust.plate[margins.trenches[k].sample]].push_back(
        static_cast<std::int32_t>(k));
  }
  // Those with the longest trenches first, so that no thread is left alone with one of them.
  std::vector<int> turn(of_plate.size());
  std::iota(turn.begin(), turn.end(), 0);
  std::ranges::stable_sort(turn, std::ranges::greater(), [&](int p) { return of_plate[p].size(); });
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < turn.size(); ++k) {
    errors.guard([&] {
      const int p = turn[k];
      hand_on_trenches(model, p, of_plate[p], spots, nullptr);
    });
  }
  errors.rethrow();
  const std::int32_t n = model.mesh->size();
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) margins.nearest_trench[i] = spots[i].trench;
}

}  // namespace

void find_margins(SphereTectonics& model) {
  find_contacts(model);
  decide_pairs(model);
  hide_what_is_below(model);
  find_trenches(model);
  find_nearest_trenches(model);
}

void forget_margins(SphereTectonics& model) {
  SphereMargins& margins = model.margins;
  const std::size_t samples = model.state.crust.plate.size();
  margins.contacts.clear();
  margins.partner.assign(samples, -1);
  margins.hidden.assign(samples, 0);
  margins.trenches.clear();
  margins.nearest_trench.assign(samples, -1);
}

float subduction_chord2(const SphereSettings& settings) {
  const double reach = settings.law.subduction_distance_km / settings.radius_km;
  const double half = std::sin(0.5 * std::min(reach, 3.1));
  return static_cast<float>(4.0 * half * half);
}

std::vector<TrenchSpot> spots_of_samples(const SphereTectonics& model) {
  const float most = subduction_chord2(model.settings);
  const std::int32_t n = model.mesh->size();
  std::vector<TrenchSpot> spots(n);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    const Vector3& at = model.mesh->samples().position(i);
    spots[i] = {static_cast<float>(at[0]),
                static_cast<float>(at[1]),
                static_cast<float>(at[2]),
                most,
                -1,
                model.margins.hidden[i] != 0 ? std::int16_t{-1} : model.state.crust.plate[i]};
  }
  return spots;
}

void hand_on_trenches(const SphereTectonics& model, int plate,
                      std::span<const std::int32_t> trenches, std::vector<TrenchSpot>& spots,
                      std::vector<std::int32_t>* reached) {
  if (trenches.empty()) return;
  std::vector<std::array<float, 3>> source(model.margins.trenches.size());
  std::vector<std::int32_t> queue, next;
  const auto take = [&](std::int32_t i, TrenchSpot& at, std::int32_t trench, float chord2) {
    if (reached != nullptr && at.trench < 0) reached->push_back(i);
    at.trench = trench;
    at.chord2 = chord2;
  };
  for (const std::int32_t k : trenches) {
    const std::int32_t i = model.margins.trenches[k].sample;
    source[k] = {spots[i].x, spots[i].y, spots[i].z};
    take(i, spots[i], k, 0.0F);
    queue.push_back(i);
  }
  while (!queue.empty()) {
    next.clear();
    for (const std::int32_t i : queue) {
      const std::int32_t trench = spots[i].trench;
      const auto [from_x, from_y, from_z] = source[trench];
      for (const std::int32_t j : model.mesh->neighbours(i)) {
        TrenchSpot& at = spots[j];
        if (at.plate != static_cast<std::int16_t>(plate) || at.trench == trench) continue;
        const float x = at.x - from_x, y = at.y - from_y, z = at.z - from_z;
        const float chord2 = x * x + y * y + z * z;
        if (chord2 >= at.chord2) continue;
        take(j, at, trench, chord2);
        next.push_back(j);
      }
    }
    queue.swap(next);
  }
}

void derive_ranks(SphereTectonics& model) {
  model.partition.count_continents(model.state);
  const auto plates = static_cast<int>(model.state.plates.size());
  std::vector<double> own(plates);
  model.score.assign(plates, 0.0);
  for (int p = 0; p < std::min(plates, model.partition.plates()); ++p) {
    const auto& cap = model.partition.cap(p);
    model.score[model.state.root(p)] += 100.0 * cap.continental - (cap.samples - cap.continental);
  }
  for (int p = 0; p < plates; ++p) own[p] = model.score[model.state.root(p)];
  model.score = std::move(own);
}

bool is_on_top(const SphereTectonics& model, std::int32_t sample, std::int32_t other) {
  const SphereCrust& crust = model.state.crust;
  if (model.settings.rank_by_score) {
    const int a = crust.plate[sample], b = crust.plate[other];
    return model.score[a] != model.score[b] ? model.score[a] > model.score[b] : a < b;
  }
  const bool land = crust.continental[sample] != 0;
  if (land != (crust.continental[other] != 0)) return land;
  const int a = crust.plate[sample], b = crust.plate[other];
  const PlatePair& pair = model.state.pair(a, b);
  const std::int8_t top = land ? pair.continent_top : pair.ocean_top;
  return (top == 1) == (a > b);
}

}  // namespace geo
