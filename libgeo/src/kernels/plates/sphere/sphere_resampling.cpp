#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "sample_sums.hpp"
#include "sphere_flood.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

using Float3 = std::array<float, 3>;

Float3 turned(const Matrix3& frame, const Float3& v) {
  const Vector3 r = times(frame, {v[0], v[1], v[2]});
  return {static_cast<float>(r[0]), static_cast<float>(r[1]), static_cast<float>(r[2])};
}

/// One sample of a plate and the corners of its triangle that are of the same plate and type, with
/// weights of sum 1.
struct Reading {
  std::array<std::int32_t, 3> corner;
  std::array<double, 3> weight;

  [[nodiscard]] float operator()(const std::vector<float>& values) const {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += weight[k] * values[corner[k]];
    return static_cast<float>(sum);
  }
  [[nodiscard]] Float3 operator()(const std::vector<Float3>& values) const {
    std::array<double, 3> sum{};
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) sum[c] += weight[k] * values[corner[k]][c];
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
  }
};

Reading read_around(const SphereMesh& mesh, const SphereCrust& crust, const Vector3& at,
                    std::int32_t nearest) {
  const auto place = mesh.locate(at, nearest);
  Reading reading{place.corner, {}};
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const std::int32_t corner = place.corner[k];
    const bool same = crust.plate[corner] == crust.plate[nearest] &&
                      crust.continental[corner] == crust.continental[nearest];
    reading.weight[k] = same ? place.weight[k] : 0.0;
    sum += reading.weight[k];
  }
  if (sum < 1e-6) return {{nearest, nearest, nearest}, {1.0, 0.0, 0.0}};
  for (double& weight : reading.weight) weight /= sum;
  return reading;
}

/// Detached pieces of plates: small ones join the neighbour they border most, large ones are plates
/// of their own that go on as they did.
void tidy_pieces(SphereTectonics& model) {
  auto& plate = model.state.crust.plate;
  std::vector<std::uint8_t> seen(plate.size(), 0);
  std::vector<std::vector<std::int32_t>> pieces;
  std::vector<std::int32_t> largest(model.state.plates.size(), -1);
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (seen[i] != 0) continue;
    const auto own = plate[i];
    pieces.push_back(
        flooded_from(*model.mesh, i, seen, [&](std::int32_t j) { return plate[j] == own; }));
    std::int32_t& best = largest[own];
    if (best >= 0 && pieces[best].size() >= pieces.back().size()) continue;
    best = static_cast<std::int32_t>(pieces.size()) - 1;
  }
  const double small = model.settings.smallest_piece_km2 / model.sample_km2();
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const std::vector<std::int32_t>& piece = pieces[k];
    const auto own = plate[piece.front()];
    const auto size = static_cast<double>(piece.size());
    const bool keeps = largest[own] == static_cast<std::int32_t>(k);
    if (keeps && (size > small || pieces.size() < 3)) continue;
    if (size > small) {
      SpherePlate copy = model.state.plates[own];
      copy.id = model.state.begin_life(PlateLife::Origin::piece, copy.id);
      copy.born_myr = model.state.time_myr;
      const int fresh = model.state.add_plate(copy);
      for (const std::int32_t i : piece) plate[i] = static_cast<std::int16_t>(fresh);
      continue;
    }
    std::vector<std::int32_t> border(model.state.plates.size(), 0);
    for (const std::int32_t i : piece) {
      for (const std::int32_t j : model.mesh->neighbours(i)) {
        if (plate[j] != own) ++border[plate[j]];
      }
    }
    const auto best = std::max_element(border.begin(), border.end());
    if (*best == 0) continue;
    if (keeps) {
      model.state.end_life(model.state.plates[own].id,
                           model.state.plates[best - border.begin()].id);
    }
    for (const std::int32_t i : piece) plate[i] = static_cast<std::int16_t>(best - border.begin());
  }
}

}  // namespace

void resample(SphereTectonics& model) {
  remember_penetration(model);
  const FibonacciSphere& samples = model.mesh->samples();
  const std::int32_t n = model.mesh->size();
  const SphereCrust before = std::move(model.state.crust);
  model.state.crust = before;  // is_on_top and the partition ask for it while the new one grows
  SphereCrust now;
  now.resize(n);
  std::vector<std::int16_t> owner(n, -1), body(n, -1);  // what moves as one, and what has so far
  const auto plates = static_cast<int>(model.state.plates.size());
  std::vector<int> root(plates);
  for (int p = 0; p < plates; ++p) root[p] = model.state.root(p);
  const std::int32_t places = model.partition.coarse().size();
  const auto resample_place = [&](std::int32_t g) {
    std::vector<int> candidates;
    for (int p = 0; p < plates; ++p) {
      if (!model.state.plates[p].alive) continue;
      if (model.partition.may_hold(p, back(model.frame[p], model.partition.centre(g))))
        candidates.push_back(p);
    }
    for (const std::int32_t i : model.partition.samples_at(g)) {
      std::int32_t top = -1, below = -1;
      for (const int p : candidates) {
        const std::int32_t j = samples.nearest(back(model.frame[p], samples.position(i)));
        if (before.plate[j] != p) continue;
        if (top < 0) {
          top = j;
          continue;
        }
        const int q = before.plate[top];
        // A body lies below the plate that carries it, as far as both are of one type.
        const bool carried = root[p] == root[q] && before.continental[j] == before.continental[top];
        const bool above = carried ? root[p] == p : is_on_top(model, j, top);
        if (above) std::swap(top, below);
        (above ? top : below) = j;
      }
      if (top < 0) continue;
      const int p = before.plate[top];
      const auto reading =
          read_around(*model.mesh, before, back(model.frame[p], samples.position(i)), top);
      owner[i] = static_cast<std::int16_t>(root[p]);
      body[i] = static_cast<std::int16_t>(p);
      now.continental[i] = before.continental[top];
      now.orogeny[i] = before.orogeny[top];
      now.thickness_m[i] = reading(before.thickness_m);
      now.elevation_m[i] = reading(before.elevation_m);
      now.age_myr[i] = reading(before.age_myr);
      now.orogeny_age_myr[i] = reading(before.orogeny_age_myr);
      now.ridge[i] = turned(model.frame[p], reading(before.ridge));
      now.fold[i] = turned(model.frame[p], reading(before.fold));
      if (below < 0 || root[before.plate[below]] == root[p]) continue;
      // Continental crust that was thrust below another continent stays there, as its root.
      if (before.continental[below] != 0 && before.continental[top] != 0) {
        const double added = before.thickness_m[below];
        now.thickness_m[i] += static_cast<float>(added);
        now.elevation_m[i] = static_cast<float>(
            std::min(1e3 * model.settings.law.summit_km,
                     height_after(now.elevation_m[i], added, model.settings.rebound)));
        now.orogeny[i] = static_cast<std::int8_t>(OrogenyType::himalayan);
        now.orogeny_age_myr[i] = 0.0F;
      }
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 16)
  for (std::int32_t g = 0; g < places; ++g) errors.guard([&] { resample_place(g); });
  errors.rethrow();
  const auto oceanic = [&](const SphereCrust& crust) {
    return model.sample_km2() * sum_over(n, [&](std::int32_t i) {
             return crust.plate[i] >= 0 && crust.continental[i] == 0 ? 1.0 : 0.0;
           });
  };
  const double ocean_before_km2 = oceanic(before);
  measure_volume(model);
  const double volume_before_km3 = model.budget.continental_km3;
  model.budget.created_km2 =
      model.sample_km2() * sum_over(n, [&](std::int32_t i) { return owner[i] < 0 ? 1.0 : 0.0; });
  // Only where plates are ranked does a continent subduct below floor.
  const double sunk_km3 =
      1e-3 * model.sample_km2() * sum_over(n, [&](std::int32_t i) {
        const bool is_below_floor = before.plate[i] >= 0 && before.continental[i] != 0 &&
                                    model.margins.hidden[i] != 0 &&
                                    before.continental[model.margins.partner[i]] == 0;
        return is_below_floor ? static_cast<double>(before.thickness_m[i]) : 0.0;
      });
  const auto gone_km2 = [&](std::int8_t type) {
    return model.sample_km2() * sum_over(n, [&](std::int32_t i) {
             return before.continental[i] == type &&
                            (before.plate[i] < 0 || model.margins.hidden[i] != 0)
                        ? 1.0
                        : 0.0;
           });
  };
  model.budget.consumed_km2 = gone_km2(0);
  model.budget.buried_km2 = gone_km2(1);
  fill_gaps(model, now, owner, body);
  model.state.crust = std::move(now);
  model.state.crust.plate = std::move(owner);
  for (SpherePlate& plate : model.state.plates) {
    plate.turn = {};
    plate.past.clear();
    if (plate.carrier >= 0) plate.alive = false;
    plate.carrier = -1;
  }
  model.state.resampled_myr = model.state.time_myr;
  model.state.past_myr.clear();
  tidy_pieces(model);
  derive_plates(model);
  forget_margins(model);
  const double lost_before_km3 = model.budget.lost_km3;
  model.budget.lost_km3 += sunk_km3;
  spread_roots(model);
  measure_volume(model);
  model.budget.resampling_km3 =
      model.budget.continental_km3 - volume_before_km3 + model.budget.lost_km3 - lost_before_km3;
  model.budget.ocean_change_km2 = oceanic(model.state.crust) - ocean_before_km2;
  model.budget.ocean_error_km2 =
      model.budget.created_km2 - model.budget.consumed_km2 - model.budget.ocean_change_km2;
  model.budget.resampled = true;
}

}  // namespace geo
