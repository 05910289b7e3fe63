#pragma once

#include <span>

#include "geo/core/stage.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// What happens to a surface in the end, where it is asked for: smoothing of land, hypsometry,
/// detail noise (blueprint 4.6 to 4.9a). The sea then takes its level again if any of it moved the
/// ground. Returns whether it did.
class SurfaceFinish {
 public:
  SurfaceFinish(const ErosionParameters& parameters, const Grid& grid, const Context& context)
      : p_(parameters), grid_(grid), context_(context) {}
  [[nodiscard]] bool reshape(std::span<float> elevation_m) const;

 private:
  void smooth_land(std::span<float> elevation_m) const;
  void add_detail(std::span<float> elevation_m) const;

  const ErosionParameters& p_;
  const Grid& grid_;
  const Context& context_;
};

}  // namespace geo
