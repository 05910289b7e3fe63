#pragma once

#include <span>
#include <vector>

#include "geo/core/vector3.hpp"

namespace geo {

/// A line of arcs of great circles that parts a sphere in two: beyond its ends it goes on along the
/// great circles of its first and last arc. Places are unit vectors; a line has two different ones
/// at least, the next never opposite the one before.
class GreatCircleLine {
 public:
  explicit GreatCircleLine(std::span<const Vector3> places);

  /// Half of its length from either end.
  [[nodiscard]] const Vector3& middle() const noexcept { return middle_; }
  /// Whether a place lies left of the line, seen along it: of the nearest arc, or of the two that
  /// meet in the nearest corner.
  [[nodiscard]] bool is_left(const Vector3& at) const;
  /// Whether a place lies beyond the great circle that crosses the line in its middle.
  [[nodiscard]] bool is_beyond_middle(const Vector3& at) const { return dot(at, along_) > 0.0; }

 private:
  struct Arc {
    Vector3 from, to, normal;  // the normal points to the left
  };
  std::vector<Arc> arcs_;
  Vector3 middle_{}, along_{};
};

}  // namespace geo
