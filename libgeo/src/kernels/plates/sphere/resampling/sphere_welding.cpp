#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// Plates border each other where this share of the smaller one's outline lies between them.
constexpr double kBordered = 0.1;

/// Two plates that may become one.
struct Neighbours {
  int larger, smaller;
  double speed_mm_yr;  ///< of the smaller one beside the larger, root mean square over its area
};

/// Edges of samples between each two plates, by number, and those between continents.
struct Borders {
  std::vector<std::int32_t> edges, of_continents;
};
Borders borders_of(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  const std::size_t plates = model.state.plates.size();
  Borders borders{std::vector<std::int32_t>(plates * plates, 0),
                  std::vector<std::int32_t>(plates * plates, 0)};
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    for (const std::int32_t j : model.mesh->neighbours(i)) {
      if (crust.plate[i] == crust.plate[j]) continue;
      const std::size_t at = crust.plate[i] * plates + crust.plate[j];
      ++borders.edges[at];
      if (crust.continental[i] != 0 && crust.continental[j] != 0) ++borders.of_continents[at];
    }
  }
  return borders;
}

double speed_beside(const SphereTectonics& model, int moving, int at_rest) {
  const auto& cap = model.partition.cap(moving);
  const Vector3 relative =
      back(model.frame[moving], add(model.rotation[moving], model.rotation[at_rest], -1.0));
  return model.settings.radius_km *
         std::sqrt(std::max(0.0, dot(relative, times(cap.inertia, relative))) / cap.samples);
}

/// Whether a plate is a block that has had its time.
bool is_spent_block(const SphereTectonics& model, int plate) {
  return is_block(model.state, plate) &&
         model.state.time_myr - model.state.plates[plate].born_myr >=
             model.settings.indentation_lasts_myr;
}

/// Two plates that hardly move beside each other, if these do.
std::optional<Neighbours> still_pair(const SphereTectonics& model, const Borders& borders, int a,
                                     int b) {
  const SphereSettings& s = model.settings;
  const std::size_t plates = model.state.plates.size();
  const bool is_larger = model.partition.cap(a).samples >= model.partition.cap(b).samples;
  const std::size_t larger = is_larger ? a : b, smaller = is_larger ? b : a;
  const std::int32_t edges = borders.edges[smaller * plates + larger];
  if (edges == 0 || !is_free(model.state.plates[a]) || !is_free(model.state.plates[b])) return {};
  std::int32_t outline = 0;
  for (std::size_t other = 0; other < plates; ++other) {
    outline += borders.edges[smaller * plates + other];
  }
  if (edges < kBordered * outline) return {};
  if (model.state.time_myr - model.state.pair(a, b).parted_myr < s.welding_after_myr) return {};
  const bool holds_out = !is_spent_block(model, a) && !is_spent_block(model, b);
  const double land =
      holds_out ? static_cast<double>(borders.of_continents[smaller * plates + larger]) / edges
                : 0.0;
  const double speed_mm_yr =
      speed_beside(model, static_cast<int>(smaller), static_cast<int>(larger));
  if (speed_mm_yr >= s.welding_mm_yr * (1.0 - s.welding_continental * land)) return {};
  return Neighbours{static_cast<int>(larger), static_cast<int>(smaller), speed_mm_yr};
}

/// Of the plates that may become one those that move least beside each other.
std::optional<Neighbours> stillest(const SphereTectonics& model) {
  const auto plates = static_cast<int>(model.state.plates.size());
  const Borders borders = borders_of(model);
  std::optional<Neighbours> found;
  for (int a = 0; a < plates; ++a) {
    for (int b = a + 1; b < plates; ++b) {
      const auto both = still_pair(model, borders, a, b);
      if (both && (!found || both->speed_mm_yr < found->speed_mm_yr)) found = both;
    }
  }
  return found;
}

/// The whole remembers of each other plate what that part does which has met it last.
void join_memories(SphereState& state, int whole, int part) {
  for (int other = 0; other < std::ssize(state.plates); ++other) {
    if (other == whole || other == part) continue;
    const PlatePair& told = state.pair(part, other);
    PlatePair& kept = state.pair(whole, other);
    if (told.last_contact_myr <= kept.last_contact_myr) continue;
    const float parted_myr = std::max(told.parted_myr, kept.parted_myr);
    kept = seen_from(told, (part < other) != (whole < other));
    kept.parted_myr = parted_myr;
  }
}

/// The smaller plate becomes part of the larger one, and both move with the mean of their motions.
void weld(SphereTectonics& model, const Neighbours& both) {
  SphereState& state = model.state;
  SpherePlate& whole = state.plates[both.larger];
  SpherePlate& part = state.plates[both.smaller];
  const double of_whole = model.partition.cap(both.larger).samples;
  const double of_part = model.partition.cap(both.smaller).samples;
  const Vector3 mean = scaled(
      add(scaled(model.rotation[both.larger], of_whole), model.rotation[both.smaller], of_part),
      1.0 / (of_whole + of_part));
  whole.speed_rad_myr = length(mean);
  if (whole.speed_rad_myr > 0.0) whole.axis = normalised(mean);
  whole.yielding = {};
  join_memories(state, both.larger, both.smaller);
  state.end_life(part.id, whole.id);
  part.alive = false;
  for (std::int16_t& plate : state.crust.plate) {
    if (plate == both.smaller) plate = static_cast<std::int16_t>(both.larger);
  }
  derive_plates(model);
}

}  // namespace

PlatePair seen_from(PlatePair pair, bool is_turned) {
  if (!is_turned) return pair;
  for (std::int8_t* top : {&pair.ocean_top, &pair.continent_top}) {
    if (*top >= 0) *top = static_cast<std::int8_t>(1 - *top);
  }
  return pair;
}

void weld_still_plates(SphereTectonics& model) {
  if (model.settings.welding_mm_yr <= 0.0) return;
  while (const auto both = stillest(model)) weld(model, *both);
}

}  // namespace geo
