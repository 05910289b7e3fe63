#pragma once

#include <string>

#include "calibration/result.hpp"

namespace geo::calibration {

/// Text of calibration.json: every figure of the result under a name with its unit, null where a
/// figure is not determined, and the program and libraries that made it.
std::string json_text(const Result& result);

}  // namespace geo::calibration
