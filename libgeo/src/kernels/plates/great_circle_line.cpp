#include "geo/kernels/plates/great_circle_line.hpp"

#include <algorithm>
#include <cmath>

namespace geo {

GreatCircleLine::GreatCircleLine(std::span<const Vector3> places) {
  double half = 0.0;
  for (std::size_t k = 1; k < places.size(); ++k) {
    const Vector3 &from = places[k - 1], &to = places[k];
    const Vector3 normal = normalised(cross(from, to));
    if (length(normal) == 0.0) continue;
    arcs_.push_back({from, to, normal});
    half += 0.5 * angle_between(from, to);
  }
  for (const auto& [from, to, normal] : arcs_) {
    const double step = angle_between(from, to);
    if (half <= step) {
      middle_ = rotated(from, scaled(normal, half));
      along_ = cross(normal, middle_);
      break;
    }
    half -= step;
  }
  constexpr double kBeyond = 1.2;  // radians
  Arc& first = arcs_.front();
  first.from = rotated(first.from, scaled(first.normal, -kBeyond));
  Arc& last = arcs_.back();
  last.to = rotated(last.to, scaled(last.normal, kBeyond));
}

bool GreatCircleLine::is_left(const Vector3& at) const {
  double least = 9.0, value = 0.0;
  for (std::size_t k = 0; k < arcs_.size(); ++k) {
    const auto& [from, to, normal] = arcs_[k];
    const double over = dot(at, normal);
    if (dot(cross(normal, from), at) >= 0.0 && dot(cross(to, normal), at) >= 0.0) {
      const double far = std::asin(std::min(1.0, std::abs(over)));
      if (far < least) {
        least = far;
        value = over;
      }
      continue;
    }
    if (const double far = angle_between(at, from); k == 0 && far < least) {
      least = far;
      value = over;
    }
    if (const double far = angle_between(at, to); far < least) {
      least = far;
      value = k + 1 == arcs_.size() ? over : dot(at, add(normal, arcs_[k + 1].normal));
    }
  }
  return value >= 0.0;
}

}  // namespace geo
