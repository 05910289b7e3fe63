#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "geo/core/stage.hpp"

namespace geo {

/// The events of a run that change its surface, each at its time: at the beginning of the erosion
/// step nearest to its age, or after the last. Each leaves its record with the context.
class SurfaceEvents {
 public:
  /// `steps` steps of `time_step_yr` end today.
  SurfaceEvents(const Grid& grid, Context& context, std::int64_t steps, double time_step_yr)
      : grid_(grid), context_(context), steps_(steps), time_step_yr_(time_step_yr) {}

  /// Lets those that fall before `step` change the surface; `steps` is today. Returns whether any
  /// did. Throws ConfigurationError when the sea is to lose more water than it holds.
  bool strike(std::int64_t step, std::span<float> elevation_m);

 private:
  [[nodiscard]] std::int64_t step_of(double age_yr) const;
  [[nodiscard]] double mean_within_m(std::span<const float> elevation_m, const Centre& centre,
                                     double radius_m) const;
  void apply(const Impact& impact, const std::string& label, EventRecord& record,
             std::span<float> elevation_m);
  void apply(const Rift& rift, const std::string& label, EventRecord& record,
             std::span<float> elevation_m);
  void apply(const OceanShift& shift, const std::string& label, EventRecord& record,
             std::span<float> elevation_m);

  const Grid& grid_;
  Context& context_;
  std::int64_t steps_;
  double time_step_yr_;
};

}  // namespace geo
