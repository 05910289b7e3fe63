#pragma once

#include "geo/stages/isostasy/crust.hpp"

namespace geo {

/// Rock at the surface and its erodibility (blueprint 3.5).
void classify_rock(const Crust<float>& crust);

}  // namespace geo
