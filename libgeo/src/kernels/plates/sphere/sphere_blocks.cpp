#include <algorithm>
#include <cmath>
#include <vector>

#include "sphere_behind.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// How much of a collision belt a block lies behind, km.
constexpr double kBelt_km = 3000.0;
/// Continents that meet more slowly break nothing, mm/yr.
constexpr double kIndenting_mm_yr = 10.0;

/// Whether a sample is continental above a continent that comes fast enough.
bool is_indented(const SphereTectonics& model, std::int32_t edge) {
  const SphereCrust& crust = model.state.crust;
  const std::int32_t below = model.margins.partner[edge];
  if (below < 0 || crust.plate[below] < 0) return false;
  if (crust.continental[edge] == 0 || crust.continental[below] == 0) return false;
  const int upper = crust.plate[edge], lower = crust.plate[below];
  const Vector3 at = times(model.frame[upper], model.mesh->samples().position(edge));
  const Vector3 relative = add(model.rotation[lower], model.rotation[upper], -1.0);
  return model.settings.radius_km * length(cross(relative, at)) >= kIndenting_mm_yr;
}

/// A block remembers of other plates what the plate does of which it was a part: it stays above
/// the continent that goes below it.
void hand_memories_on(SphereState& state, int plate, int block) {
  for (int other = 0; other < std::ssize(state.plates); ++other) {
    if (other == plate || other == block) continue;
    state.pair(block, other) =
        seen_from(state.pair(plate, other), (plate < other) != (block < other));
  }
}

/// The continent behind a stretch of the deformation front breaks off as a block.
void break_block(SphereTectonics& model, int plate, std::int32_t front) {
  const std::vector<std::int32_t> block =
      behind_trench(model, front, kBelt_km, model.settings.indentation_km,
                    [&](std::int32_t i) { return model.state.crust.continental[i] != 0; });
  const double counted_km2 = model.sample_km2() * static_cast<double>(block.size()) *
                             model.settings.piece_continental_weight;
  if (counted_km2 <= model.settings.smallest_piece_km2 ||
      2 * std::ssize(block) > static_cast<std::ptrdiff_t>(model.partition.cap(plate).samples)) {
    return;
  }
  std::vector<std::int8_t> fragment(model.mesh->size(), -1);
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (model.state.crust.plate[i] == plate) fragment[i] = 0;
  }
  for (const std::int32_t i : block) fragment[i] = 1;
  const std::vector<Vector3> together(2, Vector3{});
  if (!part_plate(model, plate, fragment, together, 0.0, SphereEvent::Kind::indentation)) return;
  hand_memories_on(model.state, plate, model.state.crust.plate[block.front()]);
}

}  // namespace

bool is_block(const SphereState& state, int plate) {
  const std::int16_t id = state.plates[plate].id;
  return id >= 0 && state.lives[id].origin == PlateLife::Origin::block;
}

/// Each length of a collision belt breaks the continent above at a rate.
void break_blocks_by_chance(SphereTectonics& model) {
  if (model.settings.indentation_per_myr <= 0.0) return;
  act_by_chance(
      model, trenches_where(model, [&](std::int32_t edge) { return is_indented(model, edge); }),
      model.settings.indentation_per_myr, "plates.blocks",
      [&](int plate) { return !is_block(model.state, plate); },
      [&](int plate, std::int32_t front) { break_block(model, plate, front); });
}

}  // namespace geo
