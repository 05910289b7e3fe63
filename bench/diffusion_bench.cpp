#include "bandwidth.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "terrain.hpp"

namespace geo::bench {
namespace {

// Rows, columns, rows: three times in and out as float.
constexpr double kBytes = 3.0 * 2.0 * sizeof(float);

void diffuse_once(benchmark::State& state, const Grid& grid, double spread_cells) {
  set_threads(state);
  std::vector<float> z = terrain(grid);
  const double spread_m = spread_cells * grid.face_east_m(grid.ny() / 2);
  for (auto _ : state) diffuse(grid, z, 0.01, 0.5 * spread_m * spread_m / 0.01);
  report(state, grid, kBytes);
}

void DiffusionPlane(benchmark::State& state) { diffuse_once(state, plane(), 0.5); }
void DiffusionSphere(benchmark::State& state) { diffuse_once(state, sphere(), 0.5); }

void DiffusionFixedSea(benchmark::State& state) {
  set_threads(state);
  const Grid& grid = plane();
  std::vector<float> z = terrain(grid);
  std::vector<std::uint8_t> sea(z.size());
  for (std::size_t c = 0; c < z.size(); ++c) sea[c] = z[c] < 0.0F;
  for (auto _ : state) diffuse(grid, z, 0.01, 1e7, {.fixed = sea});
  report(state, grid, kBytes + 2.0);
}

void Smoothing300km(benchmark::State& state) {
  set_threads(state);
  std::vector<float> z = terrain(sphere());
  for (auto _ : state) smooth(sphere(), z, 300e3);
  report(state, sphere(), 3.0 * kBytes);
}

BENCHMARK(DiffusionPlane)->Apply(one_and_two_threads);
BENCHMARK(DiffusionSphere)->Apply(one_and_two_threads);
BENCHMARK(DiffusionFixedSea)->Apply(one_and_two_threads);
BENCHMARK(Smoothing300km)->Apply(one_and_two_threads);

}  // namespace
}  // namespace geo::bench
