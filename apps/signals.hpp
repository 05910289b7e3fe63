#pragma once

#include <atomic>

namespace terrane {

/// Makes SIGINT, SIGTERM and SIGHUP set `stop_requested()`; a second one ends the program at once.
/// What nohup has shielded from SIGHUP stays so. A file size limit and a pipe that nobody reads
/// become ordinary write errors: a run outlives the reader of its log.
void prepare_signals();

/// Ends the program as programs end whose output nobody reads any more: without a word.
void end_by_broken_pipe();

/// Gives a closed standard stream the null device, lest a file of the run take its number and
/// receive what is meant for the terminal.
void keep_standard_streams();

const std::atomic<bool>& stop_requested();

}  // namespace terrane
