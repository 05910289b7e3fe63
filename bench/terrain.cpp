#include "terrain.hpp"

#include <cstdlib>
#include <map>
#include <string>

#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

namespace geo::bench {

int columns() {
  static const int kColumns = [] {
    const char* asked = std::getenv("TERRANE_BENCH_NX");
    return asked != nullptr ? std::stoi(asked) : 4096;
  }();
  return kColumns;
}

const Grid& sphere() {
  static const Grid kSphere = Grid::sphere(columns(), columns() / 2);
  return kSphere;
}

const Grid& plane() {
  static const Grid kPlane = Grid::plane(columns(), columns() / 2, 1000.0, 1000.0);
  return kPlane;
}

const std::vector<float>& terrain(const Grid& grid) {
  static std::map<const Grid*, std::vector<float>> made;
  std::vector<float>& z = made[&grid];
  if (!z.empty()) return z;
  z.resize(grid.size());
  const Noise noise(20, "bench");
  // Wavelengths from half the domain down to two cells.
  const double domain =
      grid.topology() == Topology::sphere ? 1.5 : 1.5 * 6371e3 / (grid.nx() * 1e3);
#pragma omp parallel for schedule(dynamic, 16)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      z[grid.cell(i, j)] = 9000.0F * noise.fbm(grid.unit_vector(i, j), domain, 12, 0.55);
    }
  }
  const float sea_level_m = level_for_fraction(grid, z, 0.44);
  for (float& height : z) height -= sea_level_m;
  return z;
}

}  // namespace geo::bench
