#include <algorithm>
#include <cmath>
#include <limits>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "sample_sums.hpp"

namespace geo {

void SphereCrust::resize(std::size_t samples) {
  plate.assign(samples, -1);
  continental.assign(samples, 0);
  orogeny.assign(samples, 0);
  thickness_m.assign(samples, 0.0F);
  elevation_m.assign(samples, 0.0F);
  age_myr.assign(samples, 0.0F);
  orogeny_age_myr.assign(samples, 0.0F);
  ridge.assign(samples, {});
  fold.assign(samples, {});
}

int SphereState::add_plate(const SpherePlate& plate) {
  for (std::size_t k = 0; k < plates.size(); ++k) {
    if (plates[k].alive) continue;
    plates[k] = plate;
    for (std::size_t other = 0; other < plates.size(); ++other) {
      if (other != k) pair(static_cast<int>(k), static_cast<int>(other)) = {};
    }
    return static_cast<int>(k);
  }
  const std::size_t count = plates.size();
  std::vector<PlatePair> grown((count + 1) * (count + 1));
  for (std::size_t a = 0; a < count && !pairs.empty(); ++a) {
    for (std::size_t b = 0; b < count; ++b) grown[a * (count + 1) + b] = pairs[a * count + b];
  }
  pairs = std::move(grown);
  plates.push_back(plate);
  return static_cast<int>(count);
}

std::int16_t SphereState::begin_life(PlateLife::Origin origin, std::int16_t parent) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<std::int16_t>::max()) + 1;
  const PlateLife life{.origin = origin, .parent = parent, .born_myr = time_myr};
  if (lives.size() < kMost) {
    lives.push_back(life);
    return static_cast<std::int16_t>(lives.size() - 1);
  }
  const auto first = std::min_element(
      lives.begin(), lives.end(),
      [](const PlateLife& a, const PlateLife& b) { return a.ended_myr < b.ended_myr; });
  *first = life;
  return static_cast<std::int16_t>(first - lives.begin());
}

void SphereState::end_life(std::int16_t id, std::int16_t joined) {
  if (id < 0 || lives[id].ended_myr < PlateLife::kLives) return;
  lives[id].ended_myr = time_myr;
  lives[id].joined = joined;
}

SphereTectonics::SphereTectonics(const SphereMesh& mesh, const SphereSettings& settings,
                                 SphereState state, std::uint64_t seed)
    : mesh_(&mesh),
      settings_(settings),
      state_(std::move(state)),
      seed_(seed),
      warp_(seed, "plates.rift_warp"),
      coasts_(seed, "plates.changed_coasts"),
      partition_(mesh) {
  if (state_.crust.size() != mesh.size())
    throw Bug("sphere model: the crust does not fit the mesh");
  if (state_.lives.empty()) {
    for (SpherePlate& plate : state_.plates) {
      plate.id = state_.begin_life(PlateLife::Origin::first, -1);
    }
  }
  const std::size_t n = state_.crust.plate.size();
  partner_.assign(n, -1);
  trench_of_.assign(n, -1);
  hidden_.assign(n, 0);
  chord2_.resize(n);
  spots_.resize(n);
  repartition();
}

void SphereTectonics::repartition() {
  partition_.rebuild(state_);
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    SpherePlate& plate = state_.plates[p];
    if (partition_.cap(static_cast<int>(p)).samples > 0 || !plate.alive) continue;
    plate.alive = false;
    state_.end_life(plate.id, -1);
  }
  // What was carried by a plate that is no more goes on alone.
  for (SpherePlate& plate : state_.plates) {
    if (!plate.alive || plate.carrier < 0 || state_.plates[plate.carrier].alive) continue;
    const std::int16_t carrier = state_.plates[plate.carrier].id;
    plate.carrier = -1;
    if (plate.id < 0) {
      plate.id = state_.begin_life(PlateLife::Origin::terrane, carrier);
    } else {
      state_.lives[plate.id].ended_myr = PlateLife::kLives;
      state_.lives[plate.id].joined = -1;
    }
  }
  set_frames();
  rank_plates();
}

void SphereTectonics::set_frames() {
  frame_.resize(state_.plates.size());
  rotation_.resize(state_.plates.size());
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    const SpherePlate& root = state_.plates[state_.root(static_cast<int>(p))];
    frame_[p] = state_.plates[p].turn.matrix();
    rotation_[p] = add(driven_rotation(static_cast<int>(p)), root.yielding);
  }
}

Vector3 SphereTectonics::driven_rotation(int plate) const {
  const SpherePlate& root = state_.plates[state_.root(plate)];
  return scaled(root.axis, root.speed_rad_myr);
}

double SphereTectonics::sample_km2() const {
  return mesh_->samples().area_sr() * settings_.radius_km * settings_.radius_km;
}

double SphereTectonics::distance_km(std::int32_t a, std::int32_t b) const {
  return settings_.radius_km *
         angle_between(mesh_->samples().position(a), mesh_->samples().position(b));
}

/// The rotation whose angular momentum is that of all plates that are not held together, as if all
/// crust weighed the same: the sums of 1 - r r^T over the samples take the place of the integral's
/// 8 pi / 3. Zero where all are held.
Vector3 SphereTectonics::net_rotation() const {
  Vector3 momentum{};
  Matrix3 inertia{};
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    const bool is_held = state_.plates[state_.root(static_cast<int>(p))].is_held;
    if (!state_.plates[p].alive || is_held) continue;
    const Matrix3& own = partition_.cap(static_cast<int>(p)).inertia;
    momentum = add(momentum, times(frame_[p], times(own, back(frame_[p], rotation_[p]))));
    const Matrix3 whole = carried(frame_[p], own);
    for (int c = 0; c < 3; ++c) inertia[c] = add(inertia[c], whole[c]);
  }
  // The tensor is symmetric: its rows are its columns.
  const Vector3 first = cross(inertia[1], inertia[2]);
  const double determinant = dot(inertia[0], first);
  const double trace = inertia[0][0] + inertia[1][1] + inertia[2][2];
  constexpr double kNothing = 1e-12;
  if (determinant <= kNothing * trace * trace * trace) return {};
  return scaled(Vector3{dot(momentum, first), dot(momentum, cross(inertia[2], inertia[0])),
                        dot(momentum, cross(inertia[0], inertia[1]))},
                1.0 / determinant);
}

void SphereTectonics::subtract_net_rotation() {
  const Vector3 net = add(net_rotation(), state_.kept_rotation_rad_myr, -1.0);
  for (SpherePlate& plate : state_.plates) {
    if (plate.is_held) continue;
    const Vector3 rotation = add(scaled(plate.axis, plate.speed_rad_myr), net, -1.0);
    plate.speed_rad_myr = length(rotation);
    if (plate.speed_rad_myr > 0.0) plate.axis = normalised(rotation);
  }
  set_frames();
}

void SphereTectonics::move() {
  state_.past_myr.push_back(state_.time_myr);
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    SpherePlate& plate = state_.plates[p];
    if (!plate.alive) continue;
    plate.past.push_back(plate.turn);
    plate.turn = Quaternion::about(scaled(rotation_[p], settings_.law.step_myr)).after(plate.turn);
  }
  set_frames();
}

void SphereTectonics::pull_slabs() {
  // Trenches stand in the order of their samples, so the sums have one shape.
  const double per_front = settings_.slab_pull * settings_.law.step_myr *
                           mesh_->samples().spacing() * settings_.radius_km / 1000.0;
  std::vector<Vector3> pull(state_.plates.size(), Vector3{});
  for (const TrenchSample& trench : trenches_) {
    const int lower = state_.root(trench.lower);
    const int upper = state_.crust.plate[trench.sample];
    const Vector3 at = times(frame_[upper], mesh_->samples().position(trench.sample));
    const Vector3 centre = times(frame_[lower], partition_.cap(lower).centre);
    pull[lower] = add(pull[lower], slab_pull(centre, at));
  }
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    if (state_.plates[p].is_held) continue;
    state_.plates[p].axis = normalised(add(state_.plates[p].axis, pull[p], per_front));
  }
  set_frames();
}

bool SphereTectonics::is_due() const {
  const double since_myr = state_.time_myr - state_.resampled_myr;
  const auto steps = static_cast<std::int64_t>(std::lround(since_myr / settings_.law.step_myr));
  double fastest = 0.0;
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    if (state_.plates[p].alive) fastest = std::max(fastest, length(rotation_[p]));
  }
  const double share = settings_.law.speed_mm_yr / std::max(1e-9, fastest * settings_.radius_km);
  const double wanted = std::clamp(share * static_cast<double>(settings_.least_steps),
                                   static_cast<double>(settings_.least_steps),
                                   static_cast<double>(settings_.most_steps));
  return steps >= std::lround(wanted);
}

void SphereTectonics::measure_volume() {
  const SphereCrust& crust = state_.crust;
  budget_.continental_km3 = 1e-3 * sample_km2() * sum_over(crust.size(), [&](std::int32_t i) {
                              return crust.plate[i] >= 0 && crust.continental[i] != 0
                                         ? static_cast<double>(crust.thickness_m[i])
                                         : 0.0;
                            });
  double samples = 0.0;
  budget_.plates = 0;
  for (std::size_t p = 0; p < state_.plates.size(); ++p) {
    samples += partition_.cap(static_cast<int>(p)).samples;
    budget_.plates += state_.plates[p].alive && state_.plates[p].carrier < 0 ? 1 : 0;
  }
  budget_.area_error = samples / mesh_->size() - 1.0;
}

void SphereTectonics::finish() {
  budget_ = {};
  budget_.time_myr = state_.time_myr;
  if (state_.resampled_myr < state_.time_myr) {
    resample();
  } else {
    measure_volume();
  }
}

void SphereTectonics::begin_step() {
  if (has_begun_) return;
  budget_ = {};
  if (settings_.no_net_rotation) subtract_net_rotation();
  has_begun_ = true;
}

void SphereTectonics::advance() {
  begin_step();
  has_begun_ = false;
  partition_.count_continents(state_);
  rank_plates();
  move();
  find_contacts();
  decide_pairs();
  find_trenches();
  spread_trenches();
  raise();
  erupt();
  if (settings_.by_rivers) run_rivers();
  if (!settings_.by_forces) pull_slabs();
  yield(settings_.by_forces ? balance_forces() : drag_below());
  state_.time_myr += settings_.law.step_myr;
  ++state_.steps;
  budget_.time_myr = state_.time_myr;
  collide();
  spread_roots();
  rift_by_chance();
  initiate_subduction_by_chance();
  if (is_due()) {
    resample();
  } else {
    measure_volume();
  }
}

}  // namespace geo
