#pragma once

#include <atomic>

namespace terrane {

/// Makes SIGINT and SIGTERM set `stop_requested()`; a second one ends the program at once. A file
/// size limit becomes an ordinary write error.
void prepare_signals();

/// Gives a closed standard stream the null device, lest a file of the run take its number and
/// receive what is meant for the terminal.
void keep_standard_streams();

const std::atomic<bool>& stop_requested();

}  // namespace terrane
