#pragma once

#include <memory>
#include <vector>

#include "geo/core/state.hpp"

namespace geo::io {

/// Resolutions of the data that Earth's figures were measured on.
inline constexpr double kReliefStepDeg = 0.2, kCrustStepDeg = 1.0;
/// Cells over which local relief is measured.
inline constexpr double kLocalStepDeg = 180.0 / 512.0;

/// A field on a grid of its own.
struct CoarseField {
  std::shared_ptr<const Grid> grid;
  std::vector<float> values;
};

/// Area-weighted means of a field of a whole planet over cells of `step_deg`; the field as it is
/// where the planet's own cells are no smaller.
CoarseField coarsen(const State& state, const Field<float>& spec, double step_deg);

}  // namespace geo::io
