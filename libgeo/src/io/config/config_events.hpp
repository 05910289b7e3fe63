#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "geo/core/event.hpp"

namespace geo::io {

inline constexpr std::string_view kEventKey = "event";

/// The events of the node under the key `event`. Errors are ConfigurationErrors of one line that
/// begins `source_name:line:`.
std::vector<Event> events_from_toml(const toml::node& node, const std::string& source_name);

}  // namespace geo::io
