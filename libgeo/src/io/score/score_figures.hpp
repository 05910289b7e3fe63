#pragma once

#include <map>
#include <string>

#include "geo/core/state.hpp"

namespace geo::io {

/// Measured figures by the names of `data/targets/earth_scorecard.csv`, in the units of that table.
using Figures = std::map<std::string, double>;

// Each measures what the fields of the state allow, on the whole planet.
void measure_relief(const State& state, Figures& figures);
void measure_crust(const State& state, Figures& figures);
void measure_plates(const State& state, Figures& figures);
void measure_climate(const State& state, Figures& figures);
void measure_life(const State& state, Figures& figures);
void measure_rivers(const State& state, Figures& figures);

}  // namespace geo::io
