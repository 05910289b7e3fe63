#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "kernels/plates/sphere/sample_sums.hpp"
#include "kernels/plates/sphere/sphere_flood.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

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

/// The crust that a resampling makes.
struct NewCrust {
  SphereCrust crust;
  std::vector<std::int16_t> owner;  // of each sample, what moves as one; -1 in gaps
  std::vector<std::int16_t> body;   // and what has moved as one so far
};

/// Reads the crust of all plates at the places of the lattice.
class CrustReader {
 public:
  explicit CrustReader(const SphereTectonics& model)
      : m_(model), before_(model.state.crust), root_(model.state.plates.size()) {
    const std::int32_t n = m_.mesh->size();
    now_.crust.resize(n);
    now_.owner.assign(n, -1);
    now_.body.assign(n, -1);
    for (int p = 0; p < std::ssize(root_); ++p) root_[p] = m_.state.root(p);
  }

  NewCrust read() {
    const std::int32_t places = m_.partition.coarse().size();
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 16)
    for (std::int32_t g = 0; g < places; ++g) errors.guard([&] { read_around_place(g); });
    errors.rethrow();
    return std::move(now_);
  }

 private:
  /// Samples of two plates at one place, or -1.
  struct Stack {
    std::int32_t top = -1, below = -1;
  };

  void read_around_place(std::int32_t coarse) {
    const std::vector<int> candidates = plates_near(coarse);
    for (const std::int32_t i : m_.partition.samples_at(coarse)) {
      const Stack found = stack_at(m_.mesh->samples().position(i), candidates);
      if (found.top < 0) continue;
      take(i, found.top);
      const int below = found.below < 0 ? -1 : root_[before_.plate[found.below]];
      if (below >= 0 && below != now_.owner[i]) add_root(i, found);
    }
  }
  [[nodiscard]] std::vector<int> plates_near(std::int32_t coarse) const {
    std::vector<int> near;
    for (int p = 0; p < std::ssize(root_); ++p) {
      if (!m_.state.plates[p].alive) continue;
      const Vector3 local = back(m_.frame[p], m_.partition.centre(coarse));
      if (m_.partition.may_hold(p, local)) near.push_back(p);
    }
    return near;
  }
  [[nodiscard]] Stack stack_at(const Vector3& place, const std::vector<int>& candidates) const {
    Stack found;
    for (const int p : candidates) {
      const std::int32_t j = m_.mesh->samples().nearest(back(m_.frame[p], place));
      if (before_.plate[j] != p) continue;
      if (found.top < 0) {
        found.top = j;
      } else if (is_above(p, j, found.top)) {
        found.below = found.top;
        found.top = j;
      } else {
        found.below = j;
      }
    }
    return found;
  }
  /// A body lies below the plate that carries it, as far as both are of one type.
  [[nodiscard]] bool is_above(int plate, std::int32_t sample, std::int32_t top) const {
    const bool is_carried = root_[plate] == root_[before_.plate[top]] &&
                            before_.continental[sample] == before_.continental[top];
    return is_carried ? root_[plate] == plate : is_on_top(m_, sample, top);
  }
  void take(std::int32_t i, std::int32_t top) {
    const int p = before_.plate[top];
    const Matrix3& frame = m_.frame[p];
    const Vector3 local = back(frame, m_.mesh->samples().position(i));
    const Reading reading = read_around(*m_.mesh, before_, local, top);
    SphereCrust& now = now_.crust;
    now_.owner[i] = static_cast<std::int16_t>(root_[p]);
    now_.body[i] = static_cast<std::int16_t>(p);
    now.continental[i] = before_.continental[top];
    now.orogeny[i] = before_.orogeny[top];
    now.thickness_m[i] = reading(before_.thickness_m);
    now.elevation_m[i] = reading(before_.elevation_m);
    now.sediment_m[i] = reading(before_.sediment_m);
    now.age_myr[i] = reading(before_.age_myr);
    now.orogeny_age_myr[i] = reading(before_.orogeny_age_myr);
    now.ridge[i] = turned(frame, reading(before_.ridge));
    now.fold[i] = turned(frame, reading(before_.fold));
  }
  /// Continental crust that was thrust below another continent stays there, as its root.
  void add_root(std::int32_t i, const Stack& found) {
    if (before_.continental[found.below] == 0 || before_.continental[found.top] == 0) return;
    SphereCrust& now = now_.crust;
    const double added_m = before_.thickness_m[found.below];
    now.thickness_m[i] += static_cast<float>(added_m);
    now.sediment_m[i] += before_.sediment_m[found.below];  // folded into the belt above
    now.elevation_m[i] = static_cast<float>(
        std::min(1e3 * m_.settings.law.summit_km,
                 height_after(now.elevation_m[i], added_m, m_.settings.rebound)));
    now.orogeny[i] = static_cast<std::int8_t>(OrogenyType::himalayan);
    now.orogeny_age_myr[i] = 0.0F;
  }

  const SphereTectonics& m_;
  const SphereCrust& before_;
  std::vector<int> root_;  // of each plate
  NewCrust now_;
};

/// Area of all samples of which something holds.
template <class Holds>
double area_km2(const SphereTectonics& model, Holds&& holds) {
  return model.sample_km2() *
         sum_over(model.mesh->size(), [&](std::int32_t i) { return holds(i) ? 1.0 : 0.0; });
}

/// Of floor, with what has sunk since the last resampling.
double ocean_km2(const SphereTectonics& model) {
  return area_km2(model, [&](std::int32_t i) { return model.state.crust.continental[i] == 0; });
}

/// What has opened, and what has gone below other plates or been consumed.
void enter_areas(SphereTectonics& model, const std::vector<std::int16_t>& owner) {
  const SphereCrust& crust = model.state.crust;
  const auto gone_km2 = [&](std::int8_t type) {
    return area_km2(model, [&](std::int32_t i) {
      return crust.continental[i] == type && (crust.plate[i] < 0 || model.margins.hidden[i] != 0);
    });
  };
  model.budget.created_km2 = area_km2(model, [&](std::int32_t i) { return owner[i] < 0; });
  model.budget.consumed_km2 = gone_km2(0);
  model.budget.buried_km2 = gone_km2(1);
}

/// Continents that have subducted below floor, which happens only where plates are ranked.
double sunk_below_floor_km3(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  const SphereMargins& margins = model.margins;
  return 1e-3 * model.sample_km2() * sum_over(model.mesh->size(), [&](std::int32_t i) {
           const bool is_below_floor = crust.plate[i] >= 0 && crust.continental[i] != 0 &&
                                       margins.hidden[i] != 0 &&
                                       crust.continental[margins.partner[i]] == 0;
           return is_below_floor ? static_cast<double>(crust.thickness_m[i]) : 0.0;
         });
}

/// Plates lie as their samples do, and bodies are part of what carried them.
void begin_turning_anew(SphereState& state) {
  for (SpherePlate& plate : state.plates) {
    plate.turn = {};
    plate.past.clear();
    if (plate.carrier >= 0) plate.alive = false;
    plate.carrier = -1;
  }
  state.resampled_myr = state.time_myr;
  state.past_myr.clear();
}

/// The plate with which a piece of another one comes to rest: of those that it borders along a
/// tenth of its edge, the one beside which it moves slowest; -1: it borders none.
int slowest_neighbour(const SphereTectonics& model, std::span<const std::int32_t> piece) {
  constexpr double kBordered = 0.1;
  const auto& plate = model.state.crust.plate;
  const std::int16_t own = plate[piece.front()];
  std::vector<std::int32_t> border(model.state.plates.size(), 0);
  std::int32_t edge = 0;
  Vector3 middle{};
  for (const std::int32_t i : piece) {
    middle = add(middle, model.mesh->samples().position(i));
    for (const std::int32_t j : model.mesh->neighbours(i)) {
      if (plate[j] == own) continue;
      ++border[plate[j]];
      ++edge;
    }
  }
  int slowest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < border.size(); ++p) {
    if (border[p] == 0 || border[p] < kBordered * edge) continue;
    const double speed =
        length(cross(add(model.rotation[p], model.rotation[own], -1.0), normalised(middle)));
    if (speed >= least) continue;
    least = speed;
    slowest = static_cast<int>(p);
  }
  return slowest;
}

/// Connected pieces of plates, and of each plate the number of the largest, or -1.
struct Pieces {
  std::vector<std::vector<std::int32_t>> all;
  std::vector<std::int32_t> largest;
};
Pieces pieces_of_plates(const SphereTectonics& model) {
  const auto& plate = model.state.crust.plate;
  Pieces pieces{{}, std::vector<std::int32_t>(model.state.plates.size(), -1)};
  std::vector<std::uint8_t> seen(plate.size(), 0);
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (seen[i] != 0) continue;
    const auto own = plate[i];
    pieces.all.push_back(
        flooded_from(*model.mesh, i, seen, [&](std::int32_t j) { return plate[j] == own; }));
    std::int32_t& best = pieces.largest[own];
    if (best >= 0 && pieces.all[best].size() >= pieces.all.back().size()) continue;
    best = static_cast<std::int32_t>(pieces.all.size()) - 1;
  }
  return pieces;
}

/// Area by which a plate counts as small: that of its continents more than that of floor.
double counted_km2(const SphereTectonics& model, std::span<const std::int32_t> piece) {
  const auto& continental = model.state.crust.continental;
  const auto land =
      std::ranges::count_if(piece, [&](std::int32_t i) { return continental[i] != 0; });
  return model.sample_km2() * (static_cast<double>(std::ssize(piece) - land) +
                               model.settings.piece_continental_weight * static_cast<double>(land));
}

/// Whether a plate is an arc that still leaves what is behind it.
bool is_young_arc(const SphereState& state, int plate, const SphereSettings& s) {
  return is_back_arc(state, plate) &&
         state.time_myr - state.plates[plate].born_myr < s.back_arc_lasts_myr;
}

/// Detached pieces of plates: small ones join a neighbour, large ones are plates of their own that
/// go on as they did. A plate that is small as a whole joins a neighbour too, unless another one
/// has just joined it: then both are looked at again as one.
void tidy_pieces(SphereTectonics& model) {
  auto& plate = model.state.crust.plate;
  const auto [pieces, largest] = pieces_of_plates(model);
  std::vector<std::uint64_t> parts_of(model.state.plates.size(), 0);
  bool must_go_on = false;
  std::vector<std::uint8_t> has_ended(model.state.plates.size() + pieces.size(), 0);
  std::vector<std::uint8_t> has_grown(model.state.plates.size() + pieces.size(), 0);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const std::vector<std::int32_t>& piece = pieces[k];
    const auto own = plate[piece.front()];
    const bool keeps = largest[own] == static_cast<std::int32_t>(k);
    const double area_km2 =
        keeps ? counted_km2(model, piece) : model.sample_km2() * static_cast<double>(piece.size());
    const bool is_small = area_km2 <= model.settings.smallest_piece_km2;
    if (keeps && (!is_small || pieces.size() < 3 || is_young_arc(model.state, own, model.settings)))
      continue;
    if (keeps && has_grown[own] != 0) {
      must_go_on = true;
      continue;
    }
    if (!is_small) {
      SpherePlate copy = model.state.plates[own];
      copy.id = model.state.begin_life(PlateLife::Origin::piece, copy.id);
      copy.born_myr = model.state.time_myr;
      copy.chances = {.descent = descent_from(model, model.state.plates[own].chances,
                                              Descent::piece, parts_of[own]++)};
      const int fresh = model.state.add_plate(copy);
      for (const std::int32_t i : piece) plate[i] = static_cast<std::int16_t>(fresh);
      derive_motion(model);
      continue;
    }
    const int neighbour = slowest_neighbour(model, piece);
    if (neighbour < 0) continue;
    if (has_ended[neighbour] != 0) {  // what is left of it is still to go
      must_go_on = true;
      continue;
    }
    has_grown[neighbour] = 1;
    if (keeps) {
      has_ended[own] = 1;
      model.state.end_life(model.state.plates[own].id, model.state.plates[neighbour].id);
    }
    for (const std::int32_t i : piece) plate[i] = static_cast<std::int16_t>(neighbour);
  }
  if (must_go_on) tidy_pieces(model);
}

}  // namespace

void join_small_pieces(SphereTectonics& model) {
  const auto [pieces, largest] = pieces_of_plates(model);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto own = model.state.crust.plate[pieces[k].front()];
    if (largest[own] == static_cast<std::int32_t>(k)) continue;
    const double area_km2 = model.sample_km2() * static_cast<double>(pieces[k].size());
    if (area_km2 > model.settings.smallest_piece_km2) continue;
    const int neighbour = slowest_neighbour(model, pieces[k]);
    if (neighbour < 0) continue;
    for (const std::int32_t i : pieces[k]) {
      model.state.crust.plate[i] = static_cast<std::int16_t>(neighbour);
    }
  }
}

void resample(SphereTectonics& model) {
  resample(model, [](SphereTectonics& resampled) {
    tidy_pieces(resampled);
    derive_plates(resampled);
    weld_still_plates(resampled);
    jump_ridges(resampled);
  });
}

void resample(SphereTectonics& model, const std::function<void(SphereTectonics&)>& settle) {
  SphereBudget& budget = model.budget;
  remember_penetration(model);
  measure_volume(model);
  const double volume_before_km3 = budget.continental_km3;
  const double sediment_before_km3 = budget.sediment_km3, ocean_before_km2 = ocean_km2(model);
  const double sunk_km3 = sunk_below_floor_km3(model);
  NewCrust now = CrustReader(model).read();
  enter_areas(model, now.owner);
  fill_gaps(model, now.crust, now.owner, now.body);
  model.state.crust = std::move(now.crust);
  model.state.crust.plate = std::move(now.owner);
  begin_turning_anew(model.state);
  settle(model);
  forget_margins(model);
  const double lost_before_km3 = budget.lost_km3;
  budget.lost_km3 += sunk_km3;
  spread_roots(model);
  measure_volume(model);
  budget.resampling_km3 =
      budget.continental_km3 - volume_before_km3 + budget.lost_km3 - lost_before_km3;
  budget.sediment_resampling_km3 += budget.sediment_km3 - sediment_before_km3;
  budget.ocean_change_km2 = ocean_km2(model) - ocean_before_km2;
  budget.ocean_error_km2 = budget.created_km2 - budget.consumed_km2 - budget.ocean_change_km2;
  budget.resampled = true;
}

}  // namespace geo
