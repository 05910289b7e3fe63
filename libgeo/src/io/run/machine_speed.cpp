#include "geo/io/run/machine_speed.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "geo/kernels/noise/noise.hpp"

namespace geo::io {
namespace {

using Clock = std::chrono::steady_clock;

/// The piece of work, on as many threads as are asked for.
class Work {
 public:
  Work() : positions_(kPositions), noise_(kPositions), from_(kCells, 1.0F), to_(kCells, 2.0F) {
    for (int k = 0; k < kPositions; ++k) positions_[k] = {0.37 * k, 0.11 * k, 0.53 * k};
  }

  double seconds(int threads) {
    const auto start = Clock::now();
    constexpr int kBlock = 512, kPasses = 3;
    const Noise noise(1, "machine");
#pragma omp parallel num_threads(threads)
    {
#pragma omp for schedule(static)
      for (int k = 0; k < kPositions; k += kBlock) {
        noise.fbm(std::span(positions_).subspan(k, kBlock), 1.0, 6, 0.5,
                  std::span(noise_).subspan(k, kBlock));
      }
      for (int pass = 0; pass < kPasses; ++pass) {
#pragma omp for schedule(static)
        for (std::int64_t cell = 0; cell < kCells; ++cell) {
          to_[cell] = 0.5F * to_[cell] + from_[cell];
        }
      }
    }
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  /// The median of some.
  double typical_seconds(int threads) {
    std::array<double, 5> seconds{};
    for (double& each : seconds) each = this->seconds(threads);
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
  }

 private:
  static constexpr int kPositions = 32768;
  static constexpr std::int64_t kCells = 8 << 20;
  std::vector<std::array<double, 3>> positions_;
  std::vector<float> noise_, from_, to_;
};

}  // namespace

MachineSpeed measure_machine(int threads) {
  Work work;
  work.seconds(threads);  // threads begin, pages come
  MachineSpeed speed;
  speed.one_thread_s = work.typical_seconds(1);
  speed.all_threads_s = threads > 1 ? work.typical_seconds(threads) : speed.one_thread_s;
  return speed;
}

}  // namespace geo::io
