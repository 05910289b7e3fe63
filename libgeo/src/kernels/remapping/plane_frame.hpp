#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/grid.hpp"
#include "geo/core/projection.hpp"

namespace geo {

/// A stretch of one side of a plane: cells first + k * step.
struct Stretch {
  Index first = 0;
  Index step = 1;
  int count = 0;
  double share = 0.0;  ///< of the way from outside to inside
  [[nodiscard]] Index middle() const { return first + count / 2 * step; }
};

/// The rectangle of a fine grid on its map.
class PlaneFrame {
 public:
  explicit PlaneFrame(const Grid& fine)
      : fine_(fine),
        projection_(*fine.centre(), fine.figure()),
        half_width_(0.5 * fine.nx() * fine.spacing_east_m(0)),
        half_height_(0.5 * fine.ny() * fine.step_north_m()) {}

  [[nodiscard]] std::array<double, 2> project(Centre position) const {
    return projection_.project(position);
  }
  /// Whether a place lies within the rectangle, or within so much of it.
  [[nodiscard]] bool holds(std::array<double, 2> p, double across_m = 0.0,
                           double up_m = 0.0) const {
    return std::abs(p[0]) < half_width_ + across_m && std::abs(p[1]) < half_height_ + up_m;
  }
  /// The nearest place that is not on the edge.
  [[nodiscard]] std::array<double, 2> nearest_within(std::array<double, 2> p) const {
    const double x = half_width_ - 1.5 * fine_.spacing_east_m(0);
    const double y = half_height_ - 1.5 * fine_.step_north_m();
    return {std::clamp(p[0], -x, x), std::clamp(p[1], -y, y)};
  }
  /// Cells of the side that the way from `outside` to `inside` crosses, within `reach_m` of where.
  [[nodiscard]] Stretch crossing(std::array<double, 2> outside, std::array<double, 2> inside,
                                 double reach_m) const {
    // The last of the sides that the segment crosses on its way in.
    const auto share = [](double from, double to, double half) {
      return std::abs(from) <= half ? 0.0 : (from - std::copysign(half, from)) / (from - to);
    };
    const double across = share(outside[0], inside[0], half_width_);
    const double up = share(outside[1], inside[1], half_height_);
    const double t = std::max(across, up);
    const double x = outside[0] + t * (inside[0] - outside[0]);
    const double y = outside[1] + t * (inside[1] - outside[1]);
    const double dx = fine_.spacing_east_m(0), dy = fine_.step_north_m();
    if (across >= up) {
      const Index column = outside[0] < 0.0 ? 0 : fine_.nx() - 1;
      return along((y + half_height_) / dy, reach_m / dy, fine_.ny(), column, fine_.nx(), t);
    }
    const Index row = outside[1] < 0.0 ? 0 : fine_.ny() - 1;
    return along((x + half_width_) / dx, reach_m / dx, fine_.nx(), row * fine_.nx(), 1, t);
  }

 private:
  static Stretch along(double position, double reach, int cells, Index origin, Index step,
                       double share) {
    const int first = std::clamp(static_cast<int>(std::floor(position - reach)), 0, cells - 1);
    const int last = std::clamp(static_cast<int>(std::floor(position + reach)), 0, cells - 1);
    return {origin + first * step, step, last - first + 1, share};
  }
  const Grid& fine_;
  EqualAreaProjection projection_;
  double half_width_, half_height_;
};

}  // namespace geo
