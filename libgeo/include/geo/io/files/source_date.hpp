#pragma once

#include <ctime>

namespace geo::io {

/// Whether SOURCE_DATE_EPOCH says when files were made; nothing else may tell the true time then.
bool time_is_given();

/// The time that files carry, in seconds since 1970: SOURCE_DATE_EPOCH where it is given, else now.
/// Throws ConfigurationError when it is no whole number of seconds up to the year 9999.
std::time_t now_or_given();

}  // namespace geo::io
