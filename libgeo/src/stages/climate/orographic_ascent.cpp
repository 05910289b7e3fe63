#include "orographic_ascent.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/orography.hpp"

namespace geo {

std::vector<float> orographic_ascent(const ClimateFrame& frame, std::span<const float> wind_east,
                                     std::span<const float> wind_north,
                                     std::span<const float> height_m, const ClimateParameters& p) {
  const Grid& topography = frame.topography();
  std::vector<float> east(height_m.size()), north(height_m.size()), ascent(height_m.size());
  const Interpolator east_of(frame.topography_on_planet(), wind_east,
                             Interpolator::Kind::vector_component);
  const Interpolator north_of(frame.topography_on_planet(), wind_north,
                              Interpolator::Kind::vector_component);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto scratch = errors.make<std::vector<float>>(east_of.scratch_size());
#pragma omp for schedule(static)
    for (int j = 0; j < topography.ny(); ++j) {
      if (errors.any()) continue;
      const std::size_t begin = static_cast<std::size_t>(j) * topography.nx();
      east_of.row(j, std::span(east).subspan(begin, topography.nx()), scratch);
      north_of.row(j, std::span(north).subspan(begin, topography.nx()), scratch);
    }
  }
  errors.rethrow();
  upwind_lift(topography, height_m, east, north, 1000.0 * p.lift_reach_km, ascent);
  const auto per_lift = static_cast<float>(1.0 / p.lift_height_m);
  for (float& value : ascent) value = std::exp(std::clamp(value * per_lift, -1.0F, 1.0F));
  return ascent;
}

std::vector<float> mean_ascent(const ClimateFrame& frame, std::span<const float> ascent) {
  std::vector<float> mean(static_cast<std::size_t>(frame.planet().size()));
  frame.topography_on_planet().average(ascent, mean);
  std::replace(mean.begin(), mean.end(), 0.0F, 1.0F);
  return mean;
}

}  // namespace geo
