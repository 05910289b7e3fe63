#pragma once

#include <string>

#include "calibration/result.hpp"

namespace geo::calibration {

/// Text of report.html: one page with its pictures and style in it, without scripts, that opens
/// without a network.
std::string page_text(const Result& result);

}  // namespace geo::calibration
