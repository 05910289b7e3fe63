#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/plates/raster/raster_sphere.hpp"
#include "raster_first_map.hpp"
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
  return first_map(noise, sea_share, ocean_crust);
}

std::vector<std::int16_t> grow_raster_sphere_plates(const FibonacciSphere& samples, int plates,
                                                    std::uint64_t seed, std::uint64_t round) {
  constexpr std::int32_t kPlaces = 6000, kPlacesOfAPlate = 60;
  check_plates(plates, samples.size());
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
