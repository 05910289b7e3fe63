#pragma once

#include <memory>
#include <vector>

#include "geo/core/state.hpp"

namespace geo::io {

constexpr int kWidth = 720;

std::shared_ptr<const Grid> small_sphere();
/// Land between 60°W and 60°E, the sea elsewhere; both hilly.
std::vector<float> one_continent(const Grid& grid);
/// Whatever maps are drawn of.
State full_state();

}  // namespace geo::io
