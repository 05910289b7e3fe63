#pragma once

#include <cstddef>
#include <string>

namespace terrane {

/// Rasters come and go by the hundred: what one leaves is kept for the next instead of being given
/// back to the system, which would have to clear it again, page by page. Of what is left at the end
/// of the heap, more than 2 GB still goes back.
///
/// Memory that runs out ends the program with exit code 2 and one line that says how much was
/// wanted, wherever it happens: std::bad_alloc where it can be carried to `main`, at once where
/// not: in libraries written in C, in OpenMP's own, in a parallel region without a guard.
void prepare_memory();

/// Gives what nobody holds any more back to the system, as between two stages: the rasters of the
/// next have other sizes, and would else come to lie behind the gaps that those of the last left.
void give_back_memory();

/// Memory that a run may take now: what the machine has to spare, or less where this process
/// (`ulimit -d`) or its group (a container, a job of a cluster) is kept to that.
double available_memory_bytes();

/// What `main` says of std::bad_alloc, which knows no size.
std::string want_of_memory();

/// Ends the program here and now, with one line of error. Other threads that want the same wait
/// for that. Allocates nothing.
[[noreturn]] void end_at_once(const char* message, int code);

}  // namespace terrane
