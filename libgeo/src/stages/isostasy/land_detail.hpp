#pragma once

#include "geo/kernels/exemplars/exemplar.hpp"
#include "geo/stages/isostasy/coarse_grid.hpp"
#include "geo/stages/isostasy/crust.hpp"

namespace geo {

/// What exemplars are chosen and turned by; any may be empty.
struct Orogens {
  std::span<const std::int8_t> type;
  std::span<const float> age_myr, fold_east, fold_north;
};

/// Gives the land detail like exemplars (Cortial et al. 2019, section 5) in place of the waves
/// shorter than `detail_longest_km` that it has. Its height is `detail_amplitude` times that of
/// what it replaces, or what waves twice as long around lead to expect of a self-affine relief, and
/// a quarter of the land's height at most; means over larger windows stay, and so do the shores and
/// the sea.
void detail_land(const Crust<float>& crust, const CoarseGrid& coarse, const Orogens& orogens,
                 const ExemplarLibrary& library);

}  // namespace geo
