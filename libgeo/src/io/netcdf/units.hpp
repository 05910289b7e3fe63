#pragma once

#include <optional>
#include <string>

namespace geo::io {

/// Number of `target` units in one of `units`, as UDUNITS reads them; nothing where they measure
/// something else.
std::optional<double> conversion_factor(const std::string& units, const std::string& target);

}  // namespace geo::io
