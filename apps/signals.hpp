#pragma once

#include <atomic>

namespace terrane {

/// Makes SIGINT and SIGTERM set `stop_requested()`; a second one ends the program at once. A file
/// size limit becomes an ordinary write error.
void prepare_signals();

const std::atomic<bool>& stop_requested();

}  // namespace terrane
