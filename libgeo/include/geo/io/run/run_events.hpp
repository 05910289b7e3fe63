#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace geo::io {

/// How a run is heard. Any may be empty.
struct RunEvents {
  std::function<void(std::string_view stage, double cells)> stage_begins;
  std::function<void(std::string_view stage, double seconds)> stage_ends;
  std::function<void(double fraction)> progress;
  std::function<void(std::string_view)> info, warning;
  const std::atomic<bool>* stop = nullptr;
};

}  // namespace geo::io
