#pragma once

#include <nlohmann/json.hpp>

#include "geo/core/state.hpp"
#include "io/drawing/map_frame.hpp"

namespace geo::io {

/// The rivers of the maps as lines of longitude, latitude and width; null without any.
[[nodiscard]] nlohmann::ordered_json rivers_of(const State& state, const MapFrame& frame);
/// Winds every few degrees, fewer towards the poles: longitude, latitude, east, north, m/s.
[[nodiscard]] nlohmann::ordered_json winds_of(const State& state);
/// Boundaries of plates by the colour of what happens there.
[[nodiscard]] nlohmann::ordered_json boundaries_of(const State& state, const MapFrame& frame);
/// The longitude with most land, to be seen first.
[[nodiscard]] double centre_of(const State& state);

}  // namespace geo::io
