#include "finish_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/landscape/hypsometric_curve.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/quantile_mapping.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/stages/isostasy/sea_level.hpp"

namespace geo {
namespace {

std::vector<std::uint8_t> land_of(std::span<const float> elevation_m) {
  std::vector<std::uint8_t> land(elevation_m.size());
  std::transform(elevation_m.begin(), elevation_m.end(), land.begin(),
                 [](float height) { return static_cast<std::uint8_t>(height >= 0.0F); });
  return land;
}

}  // namespace

bool SurfaceFinish::reshape(std::span<float> elevation_m) const {
  const bool reshapes =
      p_.land_smoothing_km > 0.0 || p_.hypsometry != "none" || p_.detail_noise > 0.0;
  if (!reshapes) return false;
  smooth_land(elevation_m);
  if (p_.hypsometry == "power-law") {
    bend_hypsometry(grid_, elevation_m, p_.hypsometry_median_m, 1e3 * p_.hypsometry_smoothing_km);
  }
  if (p_.hypsometry == "blueprint") {
    bend_hypsometry_once(grid_, elevation_m, p_.hypsometry_median_m,
                         1e3 * p_.hypsometry_smoothing_km);
  }
  add_detail(elevation_m);
  const auto settle_sea = [&] {
    const auto level = static_cast<float>(sea_level_m(grid_, elevation_m, context_.planet));
    for (float& height : elevation_m) height -= level;
  };
  settle_sea();
  if (p_.hypsometry == "rank") {
    const Hypsography& target = context_.hypsography;
    if (target.fraction.empty()) {
      throw ConfigurationError("erosion.hypsometry = rank needs fields.hypsography");
    }
    map_quantiles(grid_, {target.fraction, target.elevation_m}, elevation_m);
    // The curve's zero is the sea's, unless a volume of water fills what now are its basins.
    if (context_.planet.sea_level == "volume") settle_sea();
  }
  return true;
}

void SurfaceFinish::smooth_land(std::span<float> elevation_m) const {
  if (p_.land_smoothing_km <= 0.0) return;
  smooth(grid_, elevation_m, 1e3 * p_.land_smoothing_km, land_of(elevation_m));
}

void SurfaceFinish::add_detail(std::span<float> elevation_m) const {
  if (p_.detail_noise <= 0.0) return;
  const Noise noise(context_.seed, "erosion.detail");
  constexpr float kHigh_m = 5000.0F;
#pragma omp parallel for schedule(dynamic, 4)
  for (int j = 0; j < grid_.ny(); ++j) {
    for (int i = 0; i < grid_.nx(); ++i) {
      float& height = elevation_m[grid_.cell(i, j)];
      if (height <= 0.0F) continue;
      const auto at = grid_.unit_vector(i, j);
      const float sum = 80.0F * noise.value(at, 16.0) + 40.0F * noise.value(at, 32.0) +
                        20.0F * noise.value(at, 64.0) + 10.0F * noise.value(at, 128.0);
      height += static_cast<float>(p_.detail_noise) * sum *
                std::sqrt(std::clamp(height / kHigh_m, 0.0F, 1.0F));
    }
  }
}

}  // namespace geo
