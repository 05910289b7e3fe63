#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "sample_sums.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// Whether plates have gone so far that the crust must be resampled.
bool is_due(const SphereTectonics& model) {
  const double since_myr = model.state.time_myr - model.state.resampled_myr;
  const auto steps =
      static_cast<std::int64_t>(std::lround(since_myr / model.settings.law.step_myr));
  double fastest = 0.0;
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    if (model.state.plates[p].alive) fastest = std::max(fastest, length(model.rotation[p]));
  }
  const double share =
      model.settings.law.speed_mm_yr / std::max(1e-9, fastest * model.settings.radius_km);
  const double wanted = std::clamp(share * static_cast<double>(model.settings.least_steps),
                                   static_cast<double>(model.settings.least_steps),
                                   static_cast<double>(model.settings.most_steps));
  return steps >= std::lround(wanted);
}

}  // namespace

void end_step(SphereTectonics& model) {
  model.state.time_myr += model.settings.law.step_myr;
  ++model.state.steps;
  model.budget.time_myr = model.state.time_myr;
  model.has_begun = false;
}

SphereTectonics::SphereTectonics(const SphereMesh& with, const SphereSettings& by, SphereState from,
                                 std::uint64_t random_seed)
    : mesh(&with), settings(by), seed(random_seed), state(std::move(from)), partition(with) {
  if (state.crust.size() != with.size()) throw Bug("sphere model: the crust does not fit the mesh");
  if (state.lives.empty()) {
    for (SpherePlate& plate : state.plates) {
      plate.id = state.begin_life(PlateLife::Origin::first, -1);
    }
  }
  if (settings.by_rivers) way_m = ways_m(with, settings.radius_km);
  forget_margins(*this);
  derive_plates(*this);
}

double SphereTectonics::sample_km2() const {
  return mesh->samples().area_sr() * settings.radius_km * settings.radius_km;
}

double SphereTectonics::distance_km(std::int32_t a, std::int32_t b) const {
  return settings.radius_km *
         angle_between(mesh->samples().position(a), mesh->samples().position(b));
}

void derive_plates(SphereTectonics& model) {
  model.partition.rebuild(model.state);
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    SpherePlate& plate = model.state.plates[p];
    if (model.partition.cap(static_cast<int>(p)).samples > 0 || !plate.alive) continue;
    plate.alive = false;
    model.state.end_life(plate.id, -1);
  }
  // What was carried by a plate that is no more goes on alone.
  for (SpherePlate& plate : model.state.plates) {
    if (!plate.alive || plate.carrier < 0 || model.state.plates[plate.carrier].alive) continue;
    const std::int16_t carrier = model.state.plates[plate.carrier].id;
    plate.carrier = -1;
    if (plate.id < 0) {
      plate.id = model.state.begin_life(PlateLife::Origin::terrane, carrier);
    } else {
      model.state.lives[plate.id].ended_myr = PlateLife::kLives;
      model.state.lives[plate.id].joined = -1;
    }
  }
  derive_motion(model);
  derive_ranks(model);
}

void derive_followed_plates(SphereTectonics& model) {
  model.partition.rebuild(model.state);
  derive_motion(model);
  derive_ranks(model);
}

void measure_volume(SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  SphereBudget& budget = model.budget;
  budget.continental_km3 = samples_km3(model, [&](std::int32_t i) {
    return crust.plate[i] >= 0 && crust.continental[i] != 0
               ? static_cast<double>(crust.thickness_m[i])
               : 0.0;
  });
  budget.sediment_km3 =
      samples_km3(model, [&](std::int32_t i) { return static_cast<double>(crust.sediment_m[i]); });
  double samples = 0.0;
  budget.plates = 0;
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    samples += model.partition.cap(static_cast<int>(p)).samples;
    budget.plates += model.state.plates[p].alive && model.state.plates[p].carrier < 0 ? 1 : 0;
  }
  budget.area_error = samples / model.mesh->size() - 1.0;
}

void begin_step(SphereTectonics& model) {
  if (model.has_begun) return;
  model.budget = {};
  model.step = {};
  if (model.settings.no_net_rotation) subtract_net_rotation(model);
  model.has_begun = true;
}

void shape_crust(SphereTectonics& model) {
  exchange_water(model);
  keep_water(model);
  raise_crust(model);
  erupt(model);
  if (!model.settings.by_rivers) return;
  scrape_sediment(model);
  run_rivers(model);
}

void advance(SphereTectonics& model) {
  const SphereSettings& s = model.settings;
  begin_step(model);
  derive_ranks(model);
  move_plates(model);
  find_margins(model);
  model.step.met = model.state.pairs;
  shape_crust(model);
  if (!s.by_forces) pull_slabs(model);
  yield_to_links(model, s.by_forces ? balance_forces(model) : drag_below(model));
  end_step(model);
  collide_continents(model);
  flow_lower_crust(model);
  spread_roots(model);
  rift_by_chance(model);
  initiate_subduction_by_chance(model);
  open_back_arcs_by_chance(model);
  break_blocks_by_chance(model);
  if (sink_slabs(model)) derive_plates(model);
  model.step.plates = model.state.plates;
  model.step.pairs = model.state.pairs;
  if (is_due(model)) {
    resample(model);
  } else {
    measure_volume(model);
  }
}

void finish(SphereTectonics& model) {
  model.budget = {};
  model.budget.time_myr = model.state.time_myr;
  if (model.state.resampled_myr < model.state.time_myr) {
    resample(model);
  } else {
    measure_volume(model);
  }
}

}  // namespace geo
