#pragma once

namespace geo::io {

/// How long a fixed piece of work takes here and now, s: half of it computes noise, half passes
/// over memory, as stages do.
struct MachineSpeed {
  double one_thread_s = 0.0;
  double all_threads_s = 0.0;
};

/// Measures for some tenths of a second, with whatever else the machine is doing at the moment.
MachineSpeed measure_machine(int threads);

}  // namespace geo::io
