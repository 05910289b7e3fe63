#pragma once

#include <benchmark/benchmark.h>

#include "geo/core/grid.hpp"

namespace geo::bench {

/// Memory bandwidth of this machine with the current number of threads, bytes per second: the best
/// of several triads a = b + s c over arrays far larger than the caches, measured once per number
/// of threads in the same run as the benchmarks.
double bandwidth_bytes_s();

/// Reports cells per second, and the share of the memory bandwidth that a kernel would use if it
/// moved `bytes_per_cell` once: its input and output, and what it cannot do without between.
void report(benchmark::State& state, const Grid& grid, double bytes_per_cell);

/// Runs a benchmark with 1 and 2 threads, as its argument.
void one_and_two_threads(benchmark::internal::Benchmark* benchmark);
void set_threads(const benchmark::State& state);

}  // namespace geo::bench
