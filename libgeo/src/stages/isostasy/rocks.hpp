#pragma once

#include "crust.hpp"

namespace geo {

/// Rock at the surface and its erodibility (blueprint 3.5).
void classify_rock(const Crust& crust);

}  // namespace geo
