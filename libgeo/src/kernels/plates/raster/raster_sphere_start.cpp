#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geo/core/error.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/plates/raster/raster_sphere.hpp"
#include "raster_growth.hpp"

namespace geo {
namespace {

constexpr double kGain = 0.55;

}  // namespace

std::vector<RasterCrust> start_raster_sphere(const FibonacciSphere& samples, double sea_share,
                                             double ocean_crust, double waves_round,
                                             std::uint64_t seed) {
  constexpr int kOctaves = 9;
  const std::vector<float> noise = fbm_at(Noise(seed, "raster.terrain"), samples.positions(),
                                          waves_round / (2.0 * std::numbers::pi), kOctaves, kGain);
  std::vector<float> sorted = noise;
  std::sort(sorted.begin(), sorted.end());
  const auto place = std::min<std::size_t>(
      noise.size() - 1, static_cast<std::size_t>(sea_share * static_cast<double>(noise.size())));
  const float sea = sea_share >= 1.0 ? INFINITY : sorted[place];
  const float least = sorted.front(), range = std::max(1e-6F, sorted.back() - least);
  std::vector<RasterCrust> crust(noise.size());
  // Floor of the first map is no longer young.
  constexpr std::int16_t kBorn = -60;
  for (std::size_t k = 0; k < noise.size(); ++k) {
    crust[k].height =
        noise[k] >= sea ? 1.0F + (noise[k] - least) / range : static_cast<float>(ocean_crust);
    crust[k].born = kBorn;
  }
  return crust;
}

std::vector<std::int16_t> grow_raster_sphere_plates(const FibonacciSphere& samples, int plates,
                                                    std::uint64_t seed, std::uint64_t round) {
  constexpr std::int32_t kPlaces = 6000, kPlacesOfAPlate = 60;
  if (plates < 1 || plates > 32767 || plates > samples.size()) {
    throw ConfigurationError("raster plates: 1 to 32767, no more than cells, not " +
                             std::to_string(plates));
  }
  const FibonacciSphere places(std::max(kPlaces, kPlacesOfAPlate * plates));
  const SphereMesh mesh(places);
  const std::vector<std::int16_t> plate =
      grow_over(places.size(), plates, seed, round, [&](std::int32_t place, auto&& take) {
        for (const std::int32_t next : mesh.neighbours(place)) take(next);
      });
  // Outlines bend at scales below that lattice's.
  constexpr double kMost = 2.2, kWavelength = 9.0;  // spacings of the lattice
  constexpr int kOctaves = 6;
  std::vector<std::vector<float>> bend;
  for (const char* stream : {"raster.bend_x", "raster.bend_y", "raster.bend_z"}) {
    bend.push_back(fbm_at(Noise(seed, stream), samples.positions(),
                          1.0 / (kWavelength * places.spacing()), kOctaves, kGain));
  }
  std::vector<std::int16_t> seen(samples.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < samples.size(); ++i) {
    Vector3 place = samples.position(i);
    for (int c = 0; c < 3; ++c) place[c] += kMost * places.spacing() * bend[c][i];
    seen[i] = plate[places.nearest(normalised(place))];
  }
  return seen;
}

}  // namespace geo
