#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geo/core/random.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/plates/great_circle_line.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

int largest_plate(const SphereTectonics& model) {
  int largest = 0;
  for (int p = 1; p < model.partition.plates(); ++p) {
    if (model.state.plates[p].carrier >= 0) continue;
    if (model.partition.cap(p).samples > model.partition.cap(largest).samples) largest = p;
  }
  return largest;
}

/// Axes about which fragments leave each other. A rotation w opens the area w . int r x n dl along
/// a fracture, n the normal to the fragment's own side, and that integral is the chord between the
/// ends of the fracture, whatever its bends: a fragment turns about the sum of the chords of its
/// fractures, which opens most. Where they go against each other, on both sides of a strip, its
/// axis is shorter than 1. A fracture that goes all round has no chord, and opens no more than it
/// closes: it opens about its place that is nearest to `about`.
std::vector<Vector3> across_fractures(const SphereTectonics& model, int plate,
                                      std::span<const std::int8_t> fragment, int fragments,
                                      const Vector3& about) {
  const FibonacciSphere& samples = model.mesh->samples();
  struct Edge {
    Vector3 at;
    std::size_t pair;
    Vector3 along;
  };
  std::vector<Edge> edges;
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (fragment[i] < 0) continue;
    const auto star = model.mesh->neighbours(i);
    for (std::size_t s = 0; s < star.size(); ++s) {
      const int own = fragment[i], other = fragment[star[s]];
      if (other < 0 || other == own) continue;
      // Between the middles of the triangles right and left of the way to the neighbour.
      const Vector3& left = samples.position(star[(s + 1) % star.size()]);
      const Vector3& right = samples.position(star[(s + star.size() - 1) % star.size()]);
      const Vector3 at = normalised(add(samples.position(i), samples.position(star[s])));
      edges.push_back({at, static_cast<std::size_t>(own) * fragments + other,
                       scaled(add(right, left, -1.0), 1.0 / 3.0)});
    }
  }
  const Vector3 wanted = back(model.frame[plate], about);
  Vector3 middle{};
  double most = -2.0;
  std::vector<Vector3> chord(static_cast<std::size_t>(fragments) * fragments, Vector3{});
  std::vector<Vector3> near(chord.size(), Vector3{});
  std::vector<double> line(chord.size(), 0.0);
  for (const Edge& edge : edges) {
    chord[edge.pair] = add(chord[edge.pair], edge.along);
    line[edge.pair] += length(edge.along);
    if (dot(edge.at, wanted) <= most) continue;
    most = dot(edge.at, wanted);
    middle = edge.at;
  }
  for (const Edge& edge : edges) {
    const double weight = std::max(0.0, dot(edge.at, middle));
    near[edge.pair] = add(near[edge.pair], edge.along, weight);
  }
  constexpr double kAllRound = 0.1;  // chord over line
  constexpr double kAgainst = 0.5;   // of their chords cancel before a fragment goes slower
  std::vector<Vector3> axes;
  for (int own = 0; own < fragments; ++own) {
    Vector3 sum{};
    double whole = 0.0;
    for (int other = 0; other < fragments; ++other) {
      const std::size_t pair = static_cast<std::size_t>(own) * fragments + other;
      const Vector3& one = length(chord[pair]) < kAllRound * line[pair] ? near[pair] : chord[pair];
      sum = add(sum, one);
      whole += length(one);
    }
    const double size = std::max(length(sum), kAgainst * whole);
    axes.push_back(size > 0.0 ? times(model.frame[plate], scaled(sum, 1.0 / size)) : Vector3{});
  }
  return axes;
}

/// Of the fragments of a plate the one that is nearest to the middle of a body that it carries.
std::size_t fragment_nearest(const SphereTectonics& model, int body, int plate,
                             std::span<const std::int8_t> fragment) {
  const Vector3 middle =
      back(model.frame[plate], times(model.frame[body], model.partition.cap(body).centre));
  double most = -2.0;
  std::size_t nearest = 0;
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (fragment[i] < 0) continue;
    const double near = dot(model.mesh->samples().position(i), middle);
    if (near <= most) continue;
    most = near;
    nearest = static_cast<std::size_t>(fragment[i]);
  }
  return nearest;
}

/// Fragments of a plate that break apart: how many samples each has, with what goes with it.
struct Fragments {
  std::vector<std::int32_t> size;
  std::vector<std::pair<int, std::size_t>>
      carried;  // bodies of the plate, and the fragment of each

  [[nodiscard]] std::ptrdiff_t largest() const {
    return std::max_element(size.begin(), size.end()) - size.begin();
  }
};

/// No fragments where there are not two with samples. What the plate carries goes with the fragment
/// that is nearest to it.
std::optional<Fragments> fragments_of(const SphereTectonics& model, int plate,
                                      std::span<const std::int8_t> fragment, std::size_t count) {
  Fragments found{std::vector<std::int32_t>(count, 0), {}};
  for (const std::int8_t k : fragment) {
    if (k >= 0) ++found.size[k];
  }
  const auto has_samples = [](std::int32_t samples) { return samples > 0; };
  if (std::count_if(found.size.begin(), found.size.end(), has_samples) < 2) return std::nullopt;
  for (int p = 0; p < model.partition.plates(); ++p) {
    if (!model.state.plates[p].alive || model.state.plates[p].carrier != plate) continue;
    found.carried.emplace_back(p, fragment_nearest(model, p, plate, fragment));
    found.size[found.carried.back().second] += model.partition.cap(p).samples;
  }
  return found;
}

/// A fragment as a plate: it turns about an axis on top of the motion of the whole. Where rifts
/// open gradually it moves as the whole did at first.
SpherePlate plate_from(const SpherePlate& whole, const Vector3& away, double speed_mm_yr,
                       bool is_gradual, const SphereSettings& s) {
  SpherePlate part = whole;
  const Vector3 drift = scaled(whole.axis, whole.speed_rad_myr);
  const Vector3 rotation = add(drift, scaled(away, speed_mm_yr / s.radius_km));
  part.speed_rad_myr = std::min(length(rotation), s.law.speed_mm_yr / s.radius_km);
  if (part.speed_rad_myr > 0.0) part.axis = normalised(rotation);
  if (is_gradual && !whole.is_held) {
    part.yielding = add(add(whole.yielding, drift), part.axis, -part.speed_rad_myr);
  }
  return part;
}

/// The fragment of the nearest sample.
FragmentAt by_nearest(const SphereTectonics& model, std::span<const std::int8_t> fragment) {
  return [&samples = model.mesh->samples(),
          of = std::vector<std::int8_t>(fragment.begin(), fragment.end())](const Vector3& place,
                                                                           bool /*continental*/) {
    return std::max<int>(0, of[samples.nearest(place)]);
  };
}

/// The nearest of some places in the frame of the planet, as warped distances see them.
FragmentAt voronoi_fragments(const SphereTectonics& model, int plate,
                             std::span<const Vector3> places) {
  constexpr double kWavelength_km = 1500.0;
  std::vector<Vector3> local;
  for (const Vector3& place : places) local.push_back(back(model.frame[plate], place));
  const double most = 2.2 * model.settings.rift_warp_km / model.settings.radius_km;
  const double frequency = model.settings.radius_km / kWavelength_km;
  return [local, most, frequency, warp = Noise(model.seed, "plates.rift_warp")](
             const Vector3& place, bool /*continental*/) {
    Vector3 at = place;
    for (int c = 0; c < 3; ++c) {
      const Vector3 shifted{place[0] + 3.1 * c, place[1] - 1.7 * c, place[2] + 0.9 * c};
      at[c] += most * warp.fbm(shifted, frequency, 5);
    }
    const auto far = [&](const Vector3& one) { return length(add(at, one, -1.0)); };
    return static_cast<int>(std::ranges::min_element(local, {}, far) - local.begin());
  };
}

PlateLife::Origin origin_by(SphereEvent::Kind kind) {
  switch (kind) {
    case SphereEvent::Kind::subduction_initiation:
      return PlateLife::Origin::subduction_initiation;
    case SphereEvent::Kind::back_arc:
      return PlateLife::Origin::back_arc;
    case SphereEvent::Kind::indentation:
      return PlateLife::Origin::block;
    default:
      return PlateLife::Origin::rift;
  }
}

/// A plume below the continents of a plate: the nearest to their middle, or none.
const SpherePlume* plume_below(const SphereTectonics& model, int plate) {
  const auto& cap = model.partition.cap(plate);
  const Vector3 middle = times(model.frame[plate], cap.centre);
  const SpherePlume* nearest = nullptr;
  for (const SpherePlume& plume : model.state.plumes) {
    const std::int32_t above = model.mesh->samples().nearest(back(model.frame[plate], plume.place));
    const SphereCrust& crust = model.state.crust;
    if (crust.plate[above] != plate || crust.continental[above] == 0) continue;
    if (nearest == nullptr || dot(plume.place, middle) > dot(nearest->place, middle)) {
      nearest = &plume;
    }
  }
  return nearest;
}

/// Middles of fragments at even angles about a place, above which the rifts between them meet
/// (Burke & Dewey 1973): two lie on both sides of one rift, three give a triple junction.
std::vector<Vector3> middles_about(const Vector3& place, double first_angle, int fragments) {
  constexpr double kAway_rad = 0.2;
  const Vector3 any = std::abs(place[2]) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0};
  const Vector3 east = normalised(cross(any, place)), north = cross(place, east);
  std::vector<Vector3> middles;
  for (int k = 0; k < fragments; ++k) {
    const double angle = first_angle + 2.0 * std::numbers::pi * k / fragments;
    const Vector3 way = add(scaled(east, std::cos(angle)), north, std::sin(angle));
    middles.push_back(add(scaled(place, std::cos(kAway_rad)), way, std::sin(kAway_rad)));
  }
  return middles;
}

/// Middles of the fragments of a plate: about a plume below its continents, or at places drawn on
/// the sphere, as soon as enough lie on the plate.
std::vector<Vector3> middles_of_fragments(const SphereTectonics& model, int plate,
                                          const RandomStream& random, const PlateChances& now,
                                          int fragments) {
  if (random.uniform(now.descent, draw_of(now.rifts, 3)) < model.settings.plume_rift_share) {
    if (const SpherePlume* plume = plume_below(model, plate)) {
      const double angle =
          random.uniform(now.descent, draw_of(now.rifts, 4), 0.0, 2.0 * std::numbers::pi);
      return middles_about(plume->place, angle, fragments);
    }
  }
  std::vector<Vector3> places;
  const DrawnPlaces drawn(random, now, now.rifts);
  for (std::uint64_t k = 0; k < 4000 && std::ssize(places) < fragments; ++k) {
    const std::int32_t at = model.mesh->samples().nearest(back(model.frame[plate], drawn[k]));
    if (model.state.crust.plate[at] == plate) places.push_back(drawn[k]);
  }
  return places;
}

}  // namespace

void rift_by_chance(SphereTectonics& model) {
  const RandomStream random(model.seed, "plates.rifts");
  const auto plates = static_cast<int>(model.state.plates.size());
  const int largest = model.settings.rift_largest ? largest_plate(model) : -1;
  for (int p = 0; p < plates; ++p) {
    if (!model.state.plates[p].alive || model.state.plates[p].carrier >= 0) continue;
    if (model.settings.rift_largest && p != largest) continue;
    const auto& cap = model.partition.cap(p);
    const double ratio = model.sample_km2() * cap.samples / model.settings.mean_area_km2;
    if (ratio < model.settings.rift_smallest) continue;
    // Continents break more easily than the floor of oceans.
    const double weight =
        model.settings.rift_largest ? 1.0 : 0.2 + 0.8 * cap.continental / std::max(1, cap.samples);
    const double chance =
        rift_probability(model.settings.rift_per_myr * model.settings.law.step_myr, weight, ratio);
    PlateChances& chances = model.state.plates[p].chances;
    const PlateChances now = chances;
    if (!is_struck(chances.rift_hazard, -std::log1p(-chance), random, now, now.rifts)) continue;
    ++chances.rifts;
    chances.rift_hazard = 0.0;
    const double draw = random.uniform(now.descent, draw_of(now.rifts, 1));
    const int fragments = model.settings.rift_largest || draw < 0.6 ? 2 : draw < 0.9 ? 3 : 4;
    const std::vector<Vector3> places = middles_of_fragments(model, p, random, now, fragments);
    if (std::ssize(places) < 2) continue;
    rift_plate(model, p, places,
               model.settings.rift_speed_mm_yr *
                   random.uniform(now.descent, draw_of(now.rifts, 2), 0.6, 1.4));
  }
}

void rift_plate(SphereTectonics& model, int plate, std::span<const Vector3> places,
                double speed_mm_yr) {
  const FibonacciSphere& samples = model.mesh->samples();
  const auto& of = model.state.crust.plate;
  const FragmentAt part_at = voronoi_fragments(model, plate, places);
  std::vector<std::int8_t> fragment(of.size(), -1);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (of[i] == plate) fragment[i] = static_cast<std::int8_t>(part_at(samples.position(i), false));
  }
  Vector3 middle{};
  for (const Vector3& place : places) middle = add(middle, place);
  const auto away =
      across_fractures(model, plate, fragment, static_cast<int>(places.size()), middle);
  if (part_plate(model, plate, fragment, away, speed_mm_yr, SphereEvent::Kind::rift, part_at))
    ++model.budget.rifts;
}

void rift_plate_along(SphereTectonics& model, int plate, const GreatCircleLine& line, int fragments,
                      double speed_mm_yr) {
  const FragmentAt part_at = [line, fragments, frame = model.frame[plate]](const Vector3& place,
                                                                           bool /*continental*/) {
    const Vector3 at = times(frame, place);
    const bool is_left = line.is_left(at), is_cut = line.is_beyond_middle(at);
    return is_left ? (is_cut && fragments > 3 ? 3 : 0) : (is_cut && fragments > 2 ? 2 : 1);
  };
  const std::int32_t n = model.mesh->size();
  std::vector<std::int8_t> fragment(n, -1);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    if (model.state.crust.plate[i] != plate) continue;
    fragment[i] = static_cast<std::int8_t>(part_at(model.mesh->samples().position(i), false));
  }
  const auto away = across_fractures(model, plate, fragment, fragments, line.middle());
  if (part_plate(model, plate, fragment, away, speed_mm_yr, SphereEvent::Kind::rift, part_at))
    ++model.budget.rifts;
}

std::optional<std::pair<int, int>> split_plate(SphereTectonics& model, int plate,
                                               std::span<const std::uint8_t> inside) {
  auto& of = model.state.crust.plate;
  std::vector<std::int8_t> fragment(of.size(), -1);
  std::array<std::int32_t, 2> first{-1, -1};
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (of[i] != plate) continue;
    fragment[i] = inside[i] != 0 ? 1 : 0;
    if (first[fragment[i]] < 0) first[fragment[i]] = i;
  }
  if (first[0] < 0 || first[1] < 0) return {};
  const SpherePlate whole = model.state.plates[plate];
  const std::array<Vector3, 2> together{};
  if (!part_plate(model, plate, fragment, together, 0.0, SphereEvent::Kind::rift)) return {};
  ++model.budget.rifts;
  const std::pair<int, int> parts{of[first[0]], of[first[1]]};
  for (const int part : {parts.first, parts.second}) {
    model.state.plates[part].axis = whole.axis;
    model.state.plates[part].speed_rad_myr = whole.speed_rad_myr;
    model.state.plates[part].driver = -1;
  }
  derive_motion(model);
  return parts;
}

/// The largest fragment keeps the plate's number. One that has no samples comes to nothing.
bool part_plate(SphereTectonics& model, int plate, std::span<const std::int8_t> fragment,
                std::span<const Vector3> away, double speed_mm_yr, SphereEvent::Kind kind,
                FragmentAt part_at) {
  SphereState& state = model.state;
  const auto& cap = model.partition.cap(plate);
  const Vector3 centre = times(model.frame[plate], cap.centre);
  const double area_km2 = model.sample_km2() * cap.samples;
  const SpherePlate whole = state.plates[plate];
  const auto fragments = fragments_of(model, plate, fragment, away.size());
  if (!fragments) return false;
  const bool is_rift = kind == SphereEvent::Kind::rift;
  const bool is_gradual = is_rift && model.settings.rift_onset_myr > 0.0;
  PlateChange change{.kind = PlateChange::Kind::split,
                     .plate = plate,
                     .part_at = part_at ? std::move(part_at) : by_nearest(model, fragment),
                     .becomes = std::vector<int>(away.size(), -1)};
  std::vector<int> numbers;
  for (std::size_t k = 0; k < away.size(); ++k) {
    if (fragments->size[k] == 0) continue;
    SpherePlate part = plate_from(whole, away[k], speed_mm_yr, is_gradual, model.settings);
    // What is left of a plate whose floor has begun to subduct goes on.
    if (is_rift || k > 0) {
      part.chances = {.descent = descent_from(model, whole.chances, Descent::rift, k)};
    }
    if (static_cast<std::ptrdiff_t>(k) != fragments->largest()) {
      part.id = state.begin_life(origin_by(kind), whole.id);
      part.born_myr = state.time_myr;
      part.driver = -1;
    }
    int number = plate;
    if (numbers.empty()) {
      state.plates[plate] = part;
    } else {
      number = state.add_plate(part);
    }
    for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
      if (fragment[i] == static_cast<std::int8_t>(k)) {
        state.crust.plate[i] = static_cast<std::int16_t>(number);
      }
    }
    for (const int other : numbers) {
      if (is_rift) state.pair(number, other).parted_myr = static_cast<float>(state.time_myr);
    }
    for (const auto& [body, nearest] : fragments->carried) {
      if (nearest == k) state.plates[body].carrier = static_cast<std::int16_t>(number);
    }
    numbers.push_back(number);
    change.becomes[k] = number;
  }
  model.step.changes.push_back(std::move(change));
  model.events.push_back({kind, state.time_myr, plate, -1, centre, area_km2});
  derive_plates(model);
  return true;
}

}  // namespace geo
