#pragma once

#include <optional>
#include <string>

namespace geo::io {

/// Number of metres in one of these units, as UDUNITS reads them; nothing where they are no length.
std::optional<double> metres_per(const std::string& units);

}  // namespace geo::io
