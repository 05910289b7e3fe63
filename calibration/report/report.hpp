#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "calibration/result.hpp"
#include "geo/core/event.hpp"
#include "geo/core/parameter.hpp"

namespace geo::calibration {

/// Where a fit keeps how far it is, and what says that it ended.
inline constexpr std::string_view kStateFile = "calibration.state.json";
inline constexpr std::string_view kResultFile = "calibration.json";

/// Writes calibration.json, fitted.toml (every parameter of a run, those of the fit at their fitted
/// values, so that `terrane run fitted.toml` makes that planet), hypsometry.csv, hypsometry.png and
/// report.html into a folder that exists. Each file is written beside its name and renamed.
/// `parameters`: all declarations of a run, already at the fitted values. Throws IoError.
void write_results(const Result& result, std::span<const Parameter> parameters,
                   std::span<const Event> events, const std::filesystem::path& folder);
/// Removes those files, and the state of the fit that wrote them. Throws IoError.
void remove_results(const std::filesystem::path& folder);

}  // namespace geo::calibration
