#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/raster/raster_plate.hpp"

namespace geo {

/// The first map of a world from its terrain's noise: `sea_share` of it, the lowest, is a flat
/// ocean floor of `ocean_crust`; the rest is land, 1 plus the noise scaled to [0, 1].
[[nodiscard]] inline std::vector<RasterCrust> first_map(std::span<const float> noise,
                                                        double sea_share, double ocean_crust) {
  constexpr std::int16_t kBorn = -60;  // floor of the first map is no longer young
  std::vector<float> sorted(noise.begin(), noise.end());
  const auto place = std::min<std::size_t>(
      noise.size() - 1, static_cast<std::size_t>(sea_share * static_cast<double>(noise.size())));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place),
                   sorted.end());
  const float sea = sea_share >= 1.0 ? INFINITY : sorted[place];
  const auto [low, high] = std::minmax_element(noise.begin(), noise.end());
  const float least = *low, range = std::max(1e-6F, *high - *low);
  std::vector<RasterCrust> crust(noise.size());
  for (std::size_t k = 0; k < noise.size(); ++k) {
    crust[k].height =
        noise[k] >= sea ? 1.0F + (noise[k] - least) / range : static_cast<float>(ocean_crust);
    crust[k].born = kBorn;
  }
  return crust;
}

/// Throws ConfigurationError unless a world of so many cells can have so many plates.
inline void check_plates(int plates, std::int32_t cells) {
  if (plates >= 1 && plates <= 32767 && plates <= cells) return;
  throw ConfigurationError("raster plates: 1 to 32767, no more than cells, not " +
                           std::to_string(plates));
}

}  // namespace geo
