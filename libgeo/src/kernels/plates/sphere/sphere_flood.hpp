#pragma once

#include <cstdint>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_mesh.hpp"

namespace geo {

/// All samples that can be reached from one of them over neighbours that may be entered, nearest
/// first. `seen` (one for each sample) keeps out what was reached before and learns of the rest.
template <class MayEnter>
std::vector<std::int32_t> flooded_from(const SphereMesh& mesh, std::int32_t from,
                                       std::vector<std::uint8_t>& seen, MayEnter&& may_enter) {
  std::vector<std::int32_t> reached{from};
  seen[from] = 1;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    for (const std::int32_t j : mesh.neighbours(reached[k])) {
      if (seen[j] != 0 || !may_enter(j)) continue;
      seen[j] = 1;
      reached.push_back(j);
    }
  }
  return reached;
}

}  // namespace geo
