#include "geo/kernels/plates/raster/raster_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/random.hpp"
#include "raster_first_map.hpp"
#include "raster_growth.hpp"

namespace geo {
namespace {

/// One octave: unit gradients at the nodes of a lattice of nx by ny that wraps.
class Octave {
 public:
  Octave(int nx, int ny, const RandomStream& random, int number)
      : nx_(nx), ny_(ny), gradient_(static_cast<std::size_t>(nx) * ny) {
    for (std::size_t k = 0; k < gradient_.size(); ++k) {
      const double angle = 2.0 * std::numbers::pi * random.uniform(k, number);
      gradient_[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
  }
  void add_row(float v, int columns, float amplitude, std::span<float> line) const {
    const int j = static_cast<int>(v);
    const float fy = v - static_cast<float>(j), wy = fade(fy);
    const auto* low = &gradient_[static_cast<std::size_t>(j % ny_) * nx_];
    const auto* high = &gradient_[static_cast<std::size_t>((j + 1) % ny_) * nx_];
    for (int c = 0; c < columns; ++c) {
      const float u = (static_cast<float>(c) + 0.5F) * static_cast<float>(nx_) / columns;
      const int i = std::min(static_cast<int>(u), nx_ - 1), next = i + 1 == nx_ ? 0 : i + 1;
      const float fx = u - static_cast<float>(i), wx = fade(fx);
      const auto at = [&](const Gradient& g, float dx, float dy) { return g.x * dx + g.y * dy; };
      const float south = mix(at(low[i], fx, fy), at(low[next], fx - 1.0F, fy), wx);
      const float north = mix(at(high[i], fx, fy - 1.0F), at(high[next], fx - 1.0F, fy - 1.0F), wx);
      line[c] += amplitude * mix(south, north, wy);
    }
  }
  [[nodiscard]] int rows() const { return ny_; }

 private:
  struct Gradient {
    float x, y;
  };
  static float fade(float t) { return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F); }
  static float mix(float a, float b, float t) { return a + t * (b - a); }
  int nx_, ny_;
  std::vector<Gradient> gradient_;
};

}  // namespace

std::vector<float> seamless_noise(const RasterWorld& world, double cells_across, double gain,
                                  int octaves, std::uint64_t seed) {
  const RandomStream random(seed, "raster.terrain");
  std::vector<float> noise(world.size(), 0.0F);
  // Over what all octaves may reach, also those too fine for this map: a finer one has them, too.
  double amplitude = 1.0, sum = 0.0;
  for (int k = 0; k < octaves; ++k) sum += std::pow(gain, k);
  for (int k = 0; k < octaves; ++k, amplitude *= gain) {
    const double across = cells_across * std::exp2(k);
    const int nx = std::max(1, static_cast<int>(std::lround(across)));
    const int ny = std::max(1, static_cast<int>(std::lround(across * world.rows / world.columns)));
    // Finer than two cells a wave there is nothing to see.
    if (2 * nx > world.columns && k > 0) break;
    const Octave octave(nx, ny, random, k);
#pragma omp parallel for schedule(static)
    for (int row = 0; row < world.rows; ++row) {
      const float v = (static_cast<float>(row) + 0.5F) * static_cast<float>(ny) / world.rows;
      octave.add_row(
          v, world.columns, static_cast<float>(amplitude),
          std::span(noise).subspan(static_cast<std::size_t>(row) * world.columns, world.columns));
    }
  }
  for (float& value : noise) value = static_cast<float>(value / sum);
  return noise;
}

std::vector<RasterCrust> start_raster(const RasterWorld& world, double sea_share,
                                      double ocean_crust, double cells_across, std::uint64_t seed) {
  constexpr int kOctaves = 9;
  constexpr double kGain = 0.55;
  const std::vector<float> noise = seamless_noise(world, cells_across, kGain, kOctaves, seed);
  return first_map(noise, sea_share, ocean_crust);
}

namespace {

/// Grows plates on a lattice from random places of it.
std::vector<std::int16_t> grow(const RasterWorld& lattice, int plates, std::uint64_t seed,
                               std::uint64_t round) {
  return grow_over(lattice.size(), plates, seed, round, [&](std::int32_t cell, auto&& take) {
    const int x = cell % lattice.columns, y = cell / lattice.columns;
    const std::int32_t row = y * lattice.columns;
    take(lattice.row(y + 1) * lattice.columns + x);
    take(lattice.row(y - 1) * lattice.columns + x);
    take(row + lattice.column(x - 1));
    take(row + lattice.column(x + 1));
  });
}

}  // namespace

std::vector<std::int16_t> grow_raster_plates(const RasterWorld& world, int plates,
                                             std::uint64_t seed, std::uint64_t round) {
  check_plates(plates, world.size());
  constexpr double kPlaces = 9000.0, kPlacesOfAPlate = 60.0;
  const double shape = static_cast<double>(world.rows) / world.columns;
  const double places = std::max(kPlaces, kPlacesOfAPlate * plates);
  const int across = std::max(1, static_cast<int>(std::lround(std::sqrt(places / shape))));
  const RasterWorld lattice{across, std::max(1, static_cast<int>(std::lround(places / across)))};
  const std::vector<std::int16_t> plate = grow(lattice, plates, seed, round);
  // Outlines bend at scales below the lattice's.
  constexpr double kMost = 2.2, kWavelength = 9.0;  // cells of the lattice
  constexpr int kOctaves = 6;
  constexpr double kGain = 0.55;
  const RandomStream random(seed, "raster.bend");
  const auto bend = [&](std::uint64_t component) {
    const auto words = random.words(component);
    return seamless_noise(world, lattice.columns / kWavelength, kGain, kOctaves,
                          std::uint64_t{words[0]} << 32 | words[1]);
  };
  const std::vector<float> east = bend(0), north = bend(1);
  std::vector<std::int16_t> seen(world.size());
#pragma omp parallel for schedule(static)
  for (int y = 0; y < world.rows; ++y) {
    for (int x = 0; x < world.columns; ++x) {
      const std::size_t cell = static_cast<std::size_t>(y) * world.columns + x;
      const double u = (x + 0.5) * lattice.columns / world.columns + kMost * east[cell];
      const double v = (y + 0.5) * lattice.rows / world.rows + kMost * north[cell];
      seen[cell] = plate[static_cast<std::size_t>(lattice.row(static_cast<int>(std::floor(v)))) *
                             lattice.columns +
                         lattice.column(static_cast<int>(std::floor(u)))];
    }
  }
  return seen;
}

}  // namespace geo
