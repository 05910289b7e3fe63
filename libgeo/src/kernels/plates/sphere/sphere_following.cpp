#include <algorithm>

#include "sphere_flood.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// Plates and what is remembered of them, as the leader has them.
void take_plates(SphereTectonics& follower, const SphereTectonics& leader) {
  SphereState& state = follower.state;
  state.plates = leader.state.plates;
  state.pairs = leader.state.pairs;
  state.lives = leader.state.lives;
  state.past_myr = leader.state.past_myr;
  state.resampled_myr = leader.state.resampled_myr;
  state.kept_rotation_rad_myr = leader.state.kept_rotation_rad_myr;
  follower.events = leader.events;
}

/// Plates turn or move otherwise, their samples are the same.
void derive_plates_of_same_samples(SphereTectonics& model) {
  derive_motion(model);
  derive_ranks(model);
}

/// A part of a plate goes on as another one for the rest of the step, and lies as the plate does.
void make_part(SphereTectonics& model, int plate, int part) {
  SphereState& state = model.state;
  if (part == plate) return;
  state.plates[part] = state.plates[plate];
  state.plates[part].carrier = -1;
}

void split(SphereTectonics& model, const PlateChange& change) {
  auto& of = model.state.crust.plate;
  for (const int part : change.becomes) {
    if (part >= 0) make_part(model, change.plate, part);
  }
  const std::int32_t n = model.mesh->size();
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    if (of[i] != change.plate) continue;
    const bool is_land = model.state.crust.continental[i] != 0;
    const int part = change.becomes[change.part_at(model.mesh->samples().position(i), is_land)];
    if (part >= 0) of[i] = static_cast<std::int16_t>(part);
  }
}

void collide(SphereTectonics& model, const PlateChange& change) {
  SphereCrust& crust = model.state.crust;
  std::vector<std::int32_t> terrane;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.plate[i] != change.plate || crust.continental[i] == 0) continue;
    if (change.part_at(model.mesh->samples().position(i), true) == 1) terrane.push_back(i);
  }
  if (!terrane.empty()) {
    collide_terrane(model, change.plate, change.upper, terrane, change.speed_mm_yr);
  }
  const int carried = change.becomes[1];
  if (carried >= 0) {
    make_part(model, change.plate, carried);
    for (const std::int32_t i : terrane) {
      if (crust.plate[i] >= 0) crust.plate[i] = static_cast<std::int16_t>(carried);
    }
  }
  const int body = carried >= 0 ? carried : change.plate;
  model.state.plates[body].carrier = static_cast<std::int16_t>(change.upper);
}

/// Repeats changes from one of them on, after which there are those pairs of plates.
void repeat(SphereTectonics& follower, const std::vector<PlateChange>& changes, std::size_t from,
            std::size_t plates, const std::vector<PlatePair>& pairs) {
  SpherePlate none;
  none.alive = false;
  follower.state.plates.resize(std::max(plates, follower.state.plates.size()), none);
  follower.state.pairs = pairs;
  for (std::size_t k = from; k < changes.size(); ++k) {
    if (changes[k].kind == PlateChange::Kind::split) {
      split(follower, changes[k]);
    } else {
      collide(follower, changes[k]);
    }
    derive_followed_plates(follower);
  }
}

/// The plate that holds the place of each sample of the follower on the leader's samples, and
/// whether it does so well within its borders.
struct LeadersPlates {
  std::vector<std::int16_t> plate;
  std::vector<std::uint8_t> is_inside;
};
LeadersPlates leaders_plates(const SphereTectonics& follower, const SphereTectonics& leader) {
  const std::int32_t n = follower.mesh->size();
  const auto& plate = leader.state.crust.plate;
  LeadersPlates found{std::vector<std::int16_t>(n), std::vector<std::uint8_t>(n)};
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t there = leader.mesh->samples().nearest(follower.mesh->samples().position(i));
    found.plate[i] = plate[there];
    found.is_inside[i] = std::ranges::all_of(
        leader.mesh->neighbours(there), [&](std::int32_t j) { return plate[j] == plate[there]; });
  }
  return found;
}

/// Each connected piece of a type of crust comes to the plate that holds most of it.
void vote(SphereTectonics& follower, const SphereTectonics& leader,
          const std::vector<std::int16_t>& wanted) {
  const std::int32_t n = follower.mesh->size();
  SphereCrust& crust = follower.state.crust;
  const std::vector<std::int16_t> before = crust.plate;
  std::vector<std::uint8_t> seen(n, 0);
  std::vector<std::int32_t> votes(leader.state.plates.size());
  for (std::int32_t i = 0; i < n; ++i) {
    if (seen[i] != 0) continue;
    const auto piece = flooded_from(*follower.mesh, i, seen, [&](std::int32_t j) {
      return before[j] == before[i] && crust.continental[j] == crust.continental[i];
    });
    std::ranges::fill(votes, 0);
    for (const std::int32_t j : piece) ++votes[wanted[j]];
    const auto best = std::ranges::max_element(votes);
    const auto own = static_cast<std::size_t>(before[i]);
    if (own < votes.size() && votes[own] == *best) continue;
    for (const std::int32_t j : piece) {
      crust.plate[j] = static_cast<std::int16_t>(best - votes.begin());
    }
  }
}

}  // namespace

void follow(SphereTectonics& follower, const SphereTectonics& leader) {
  take_plates(follower, leader);
  derive_motion(follower);
  const LeadersPlates leaders = leaders_plates(follower, leader);
  vote(follower, leader, leaders.plate);
  SphereCrust& crust = follower.state.crust;
  for (std::int32_t i = 0; i < crust.size(); ++i) {
    if (crust.continental[i] == 0 && leaders.is_inside[i] != 0) crust.plate[i] = leaders.plate[i];
  }
  join_small_pieces(follower);
  derive_followed_plates(follower);
}

void begin_step_of_both(SphereTectonics& follower, SphereTectonics& leader) {
  begin_step(leader);
  if (follower.has_begun) return;
  follower.budget = {};
  follower.has_begun = true;
}

void advance_both(SphereTectonics& follower, SphereTectonics& leader) {
  begin_step_of_both(follower, leader);
  repeat(follower, leader.step.changes, 0, leader.state.plates.size(), leader.state.pairs);
  const std::size_t repeated = leader.step.changes.size();
  take_plates(follower, leader);
  derive_plates_of_same_samples(follower);
  advance(leader);
  move_plates(follower);
  follower.state.pairs = leader.step.met;
  find_margins(follower);
  shape_crust(follower);
  end_step(follower);
  repeat(follower, leader.step.changes, repeated, leader.step.plates.size(), leader.step.pairs);
  follower.state.plates = leader.step.plates;
  follower.state.pairs = leader.step.pairs;
  follower.state.lives = leader.state.lives;
  derive_plates_of_same_samples(follower);
  if (sink_slabs(follower)) derive_followed_plates(follower);
  flow_lower_crust(follower);
  spread_roots(follower);
  if (leader.budget.resampled) {
    resample(follower, [&](SphereTectonics& resampled) { follow(resampled, leader); });
  } else {
    measure_volume(follower);
  }
  take_plates(follower, leader);
  derive_plates_of_same_samples(follower);
  follower.budget.collisions = leader.budget.collisions;
  follower.budget.rifts = leader.budget.rifts;
  follower.budget.subduction_initiations = leader.budget.subduction_initiations;
}

void finish_both(SphereTectonics& follower, SphereTectonics& leader) {
  const bool resamples = leader.state.resampled_myr < leader.state.time_myr;
  finish(leader);
  follower.budget = {};
  follower.budget.time_myr = follower.state.time_myr;
  if (resamples) {
    resample(follower, [&](SphereTectonics& resampled) { follow(resampled, leader); });
  } else {
    measure_volume(follower);
  }
}

}  // namespace geo
