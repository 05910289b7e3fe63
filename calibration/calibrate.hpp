#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "calibration/result.hpp"
#include "calibration/settings.hpp"
#include "geo/core/event.hpp"
#include "geo/core/parameter.hpp"

namespace geo::calibration {

/// What is asked for.
struct Request {
  std::string target;            ///< as --target gives it
  std::string preset_or_config;  ///< for the record
  std::filesystem::path folder;
  std::span<const Parameter> configuration;  ///< all declarations of a run at its values
  std::span<const Event> events;
  Settings settings;
  bool resume = false, overwrite = false;
  bool allow_other_build = false;  ///< go on with what another build of terrane began
};

/// Who watches; any may be empty.
struct Watch {
  std::function<void(std::string_view message)> info;
  std::function<void(const Iteration&)> iteration;
  const std::atomic<bool>* stop = nullptr;
};

/// Fits, judges on held-out planets, and writes all files into the folder. What has been done is
/// kept after each iteration in calibration.state.json; with `resume` the fit goes on there and
/// ends with the same bits. The configuration's own values end at those of the fit.
/// Throws ConfigurationError, InputError, IoError, Interrupted.
Result calibrate(const Request& request, const Watch& watch);

/// Whether the target was reached, and if not, why, in one sentence (empty when it was).
std::string failure_of(const Result& result);

}  // namespace geo::calibration
