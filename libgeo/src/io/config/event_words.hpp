#pragma once

#include <string>
#include <vector>

#include "geo/io/maps/maps.hpp"
#include "geo/io/run/manifest.hpp"

namespace geo::io {

/// A sentence for each event of a run: where, when, what it left.
std::vector<std::string> event_lines(const Manifest& manifest);

/// What maps show of them.
std::vector<EventMark> event_marks(const Manifest& manifest);

}  // namespace geo::io
