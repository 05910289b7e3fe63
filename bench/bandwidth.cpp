#include "bandwidth.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <vector>

namespace geo::bench {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double measure_triad() {
  constexpr std::int64_t kValues = 16'000'000;
  std::vector<float> a(kValues, 0.0F), b(kValues, 1.0F), c(kValues, 2.0F);
  double best_s = 1e30;
  for (int repeat = 0; repeat < 8; ++repeat) {
    const double start = seconds();
#pragma omp parallel for schedule(static)
    for (std::int64_t i = 0; i < kValues; ++i) a[i] = b[i] + 3.0F * c[i];
    benchmark::DoNotOptimize(a.data());
    best_s = std::min(best_s, seconds() - start);
  }
  return 3.0 * sizeof(float) * kValues / best_s;
}

}  // namespace

double bandwidth_bytes_s() {
  static std::map<int, double> measured;
  double& rate = measured[omp_get_max_threads()];
  if (rate == 0.0) rate = measure_triad();
  return rate;
}

void report(benchmark::State& state, const Grid& grid, double bytes_per_cell) {
  const double cells = static_cast<double>(state.iterations()) * grid.size();
  state.counters["cells/s"] = benchmark::Counter(cells, benchmark::Counter::kIsRate);
  state.counters["bandwidth_share"] =
      benchmark::Counter(cells * bytes_per_cell / bandwidth_bytes_s(), benchmark::Counter::kIsRate);
}

void one_and_two_threads(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
}

void set_threads(const benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(0)));
}

}  // namespace geo::bench
