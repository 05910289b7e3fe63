#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// The solution of a symmetric system of three equations.
Vector3 solved(const Matrix3& m, const Vector3& right) {
  const Vector3 a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
  return scaled(Vector3{dot(a, right), dot(b, right), dot(c, right)}, 1.0 / dot(m[0], a));
}

/// A rotation that is nowhere faster than a speed. Spin about the plate's own centre, which moves
/// it least, gives way first.
Vector3 limited(const Vector3& rotation, const Vector3& centre, double most) {
  Vector3 drift = tangent(rotation, centre);
  const double speed = length(drift);
  if (speed > most) return scaled(drift, most / speed);
  const double room = std::sqrt(most * most - speed * speed);
  return add(drift, centre, std::clamp(dot(rotation, centre), -room, room));
}

/// Sums over a block, in the frame of its plate.
struct Part {
  Matrix3 continental{};  // of 1 - r r^T over continents
  Vector3 line{};         // integral of force dl, N
  std::vector<std::pair<std::int16_t, Vector3>> on_others;
};

/// The force of ridges is a gradient, so that by Stokes' theorem its torque on a plate is an
/// integral along the edge of the plate's sea floor, int r x grad F dA = closed int F dl, as that
/// of slabs is from the start: both are sums over the edges of triangles, exact for any outline.
class EdgeForces {
 public:
  EdgeForces(const SphereTectonics& model, int plate)
      : m_(model),
        crust_(model.state.crust),
        force_(model.settings.force),
        plate_(plate),
        root_(model.state.root(plate)),
        still_(kStill_mm_yr / model.settings.radius_km) {}

  /// Adds what acts along the edges that leave a sample with the plate on their left.
  void add_edges_at(std::int32_t i, Part& sum) const {
    if (!is_surface(i)) return;
    const auto star = m_.mesh->neighbours(i);
    for (std::size_t s = 0; s < star.size(); ++s) {
      const std::int32_t j = star[s], k = star[(s + 1) % star.size()];
      if (!is_surface(j)) continue;
      const bool is_floor = crust_.continental[i] == 0 && crust_.continental[j] == 0;
      if (is_surface(k)) {
        if (is_floor && crust_.continental[k] != 0) add_force(push_of(i, j), i, j, sum);
        continue;
      }
      const bool is_own = crust_.plate[k] == plate_;
      if (is_own) {
        add_trench(i, j, k, sum);
      } else if (crust_.plate[k] >= 0 && m_.state.root(crust_.plate[k]) != root_) {
        if (parts(i, j, k)) continue;  // there is younger floor up to the ridge
        if (meets(i, j, k) && goes_below(i, k)) {
          add_slab(mean_age(i, j), crust_.plate[k], i, j, sum);
        }
      }
      if (is_floor) add_force(push_of(i, j), i, j, sum);
    }
  }

 private:
  [[nodiscard]] bool is_surface(std::int32_t i) const {
    return crust_.plate[i] == plate_ && m_.margins.hidden[i] == 0;
  }
  [[nodiscard]] double mean_age(std::int32_t i, std::int32_t j) const {
    return 0.5 * (static_cast<double>(crust_.age_myr[i]) + crust_.age_myr[j]);
  }
  [[nodiscard]] double push_of(std::int32_t i, std::int32_t j) const {
    return ridge_push_n_m(mean_age(i, j), force_);
  }
  [[nodiscard]] const Vector3& at(std::int32_t i) const { return m_.mesh->samples().position(i); }
  /// From j to i the plate lies on the left.
  [[nodiscard]] Vector3 along(std::int32_t i, std::int32_t j) const {
    return add(at(i), at(j), -1.0);
  }
  void add_force(double n_m, std::int32_t i, std::int32_t j, Part& sum) const {
    sum.line = add(sum.line, along(i, j), n_m);
  }
  /// How fast a plate leaves this one across an edge, and how fast it moves at all.
  [[nodiscard]] std::pair<double, double> leaving(std::int32_t i, std::int32_t j, int other) const {
    const Vector3 relative =
        cross(back(m_.frame[plate_], add(m_.rotation[other], m_.rotation[plate_], -1.0)), at(i));
    const Vector3 outward = normalised(cross(along(i, j), at(i)));
    return {dot(relative, outward), length(relative)};
  }
  static constexpr double kAcross = 0.5;       // less across than this is a transform
  static constexpr double kStill_mm_yr = 1.0;  // slower than this nothing meets or parts
  [[nodiscard]] bool parts(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const auto [across, speed] = leaving(i, j, crust_.plate[k]);
    return across > kAcross * std::max(speed, still_);
  }
  [[nodiscard]] bool meets(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const auto [across, speed] = leaving(i, j, crust_.plate[k]);
    return across < -kAcross * std::max(speed, still_);
  }
  /// Whether floor subducts below a neighbour that it has met but not yet reached since resampling.
  [[nodiscard]] bool goes_below(std::int32_t i, std::int32_t k) const {
    if (crust_.continental[i] != 0) return false;
    if (crust_.continental[k] == 0 && m_.state.pair(plate_, crust_.plate[k]).ocean_top < 0) {
      return false;
    }
    return is_on_top(m_, k, i);
  }
  /// A slab pulls its plate down and sucks the one above it to the trench.
  void add_slab(double age_myr, std::int16_t upper, std::int32_t i, std::int32_t j,
                Part& sum) const {
    add_force(slab_pull_n_m(age_myr, force_), i, j, sum);
    if (force_.suction_share <= 0.0 || upper < 0) return;
    sum.on_others.emplace_back(upper, scaled(along(i, j), -slab_suction_n_m(age_myr, force_)));
  }
  /// Where the plate subducts, at k: floor pulls, a continent resists and so does the one above.
  void add_trench(std::int32_t i, std::int32_t j, std::int32_t k, Part& sum) const {
    const std::int32_t above = m_.margins.partner[k];
    if (crust_.continental[k] == 0) {
      add_slab(crust_.age_myr[k], above < 0 ? std::int16_t{-1} : crust_.plate[above], i, j, sum);
      return;
    }
    if (above < 0 || crust_.plate[above] < 0 || crust_.continental[above] == 0) return;
    const std::int16_t upper = crust_.plate[above];
    if (leaving(i, j, upper).first >= 0.0) return;
    add_force(-force_.collision_n_m, i, j, sum);
    sum.on_others.emplace_back(upper, scaled(along(i, j), force_.collision_n_m));
  }

  const SphereTectonics& m_;
  const SphereCrust& crust_;
  const PlateForces& force_;
  int plate_, root_;
  double still_;  // radians per Myr
};

}  // namespace

std::vector<SphereTorques> torques(const SphereTectonics& model) {
  const auto& blocks = model.partition.blocks();
  const auto block_count = static_cast<std::int32_t>(blocks.size());
  std::vector<Part> part(blocks.size());
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 16)
  for (std::int32_t b = 0; b < block_count; ++b) {
    errors.guard([&] {
      const EdgeForces edges(model, blocks[b].plate);
      for (const std::int32_t i : model.partition.samples(blocks[b])) {
        edges.add_edges_at(i, part[b]);
        if (model.state.crust.continental[i] == 0) continue;
        const Vector3& r = model.mesh->samples().position(i);
        for (int c = 0; c < 3; ++c) {
          for (int d = 0; d < 3; ++d)
            part[b].continental[c][d] += (c == d ? 1.0 : 0.0) - r[c] * r[d];
        }
      }
    });
  }
  errors.rethrow();
  const double radius_m = 1e3 * model.settings.radius_km;
  const double base_m2 = 1e6 * model.sample_km2() * radius_m * radius_m;
  const double drag = basal_drag_pa_s_m(model.settings.force) * base_m2;
  const double more = model.settings.force.continental_drag - 1.0;
  std::vector<SphereTorques> of_root(model.state.plates.size());
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    if (!model.state.plates[p].alive) continue;
    SphereTorques& root = of_root[model.state.root(static_cast<int>(p))];
    const Matrix3 whole = drag_below(model, static_cast<int>(p));
    for (int c = 0; c < 3; ++c) root.drag_n_m_s[c] = add(root.drag_n_m_s[c], whole[c], drag);
  }
  const double lever_m2 = radius_m * radius_m;
  for (std::int32_t b = 0; b < block_count; ++b) {
    const int own = blocks[b].plate;
    SphereTorques& root = of_root[model.state.root(own)];
    root.driving_n_m = add(root.driving_n_m, times(model.frame[own], part[b].line), lever_m2);
    const Matrix3 land = carried(model.frame[own], part[b].continental);
    for (int c = 0; c < 3; ++c) root.drag_n_m_s[c] = add(root.drag_n_m_s[c], land[c], drag * more);
    for (const auto& [other, line] : part[b].on_others) {
      SphereTorques& resisting = of_root[model.state.root(other)];
      resisting.driving_n_m = add(resisting.driving_n_m, times(model.frame[own], line), lever_m2);
    }
  }
  return of_root;
}

/// Lets motion follow the forces. Returns what holds each plate back, in units of what holds one
/// sample of sea floor.
std::vector<Matrix3> balance_forces(SphereTectonics& model) {
  const std::vector<SphereTorques> of_plate = torques(model);
  const double share =
      -std::expm1(-model.settings.law.step_myr / model.settings.force.response_myr);
  const double most = model.settings.law.speed_mm_yr / model.settings.radius_km;
  for (std::size_t p = 0; p < of_plate.size(); ++p) {
    SpherePlate& plate = model.state.plates[p];
    if (!plate.alive || plate.carrier >= 0 || plate.is_held) continue;
    const Vector3 now = scaled(plate.axis, plate.speed_rad_myr);
    const Vector3 balanced =
        scaled(solved(of_plate[p].drag_n_m_s, of_plate[p].driving_n_m), kSecondsPerMyr);
    const Vector3 centre = times(model.frame[p], model.partition.cap(static_cast<int>(p)).centre);
    const Vector3 next = limited(add(now, add(balanced, now, -1.0), share), centre, most);
    plate.speed_rad_myr = length(next);
    if (plate.speed_rad_myr > 0.0) plate.axis = normalised(next);
  }
  hold_back_arcs(model);
  const double radius_m = 1e3 * model.settings.radius_km;
  const double sample =
      basal_drag_pa_s_m(model.settings.force) * 1e6 * model.sample_km2() * radius_m * radius_m;
  std::vector<Matrix3> drag;
  for (const SphereTorques& torques : of_plate) {
    Matrix3& own = drag.emplace_back(torques.drag_n_m_s);
    for (Vector3& row : own) row = scaled(row, 1.0 / sample);
  }
  return drag;
}

}  // namespace geo
