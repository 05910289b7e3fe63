#pragma once

#include "geo/core/checkpoint.hpp"
#include "geo/kernels/plates/sphere/sphere_state.hpp"

namespace geo {

/// All of a state as named arrays, and back, bit for bit. Throws InputError when arrays are missing
/// or do not fit together.
[[nodiscard]] Checkpoint checkpoint_of(const SphereState& state);
[[nodiscard]] SphereState state_of(const Checkpoint& checkpoint);

/// The same of the model whose plates lead, beside the first.
void add_leader(const SphereState& leader, Checkpoint& to);
[[nodiscard]] bool has_leader(const Checkpoint& from);
[[nodiscard]] SphereState leader_of(const Checkpoint& from);

}  // namespace geo
