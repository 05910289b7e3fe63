#include "geo/kernels/landscape/rift_valley.hpp"

#include <algorithm>
#include <cmath>

namespace geo {

double rift_profile_m(const RiftSection& section, double distance_m) {
  constexpr double kFloor = 0.6;  // of the half width
  const double from_crest_m = distance_m - section.half_width_m;
  if (from_crest_m >= 0.0) {
    const double x = from_crest_m / section.flexure_m;
    return section.shoulder_m * std::exp(-x) * std::cos(x);
  }
  const double x =
      std::clamp((distance_m / section.half_width_m - kFloor) / (1.0 - kFloor), 0.0, 1.0);
  const double wall = x * x * (3.0 - 2.0 * x);
  return wall * section.shoulder_m - (1.0 - wall) * section.depth_m;
}

GreatCirclePath::GreatCirclePath(std::vector<Vector3> places) {
  for (std::size_t i = 1; i < places.size(); ++i) {
    Arc arc{.from = places[i - 1], .to = places[i], .begins = length_};
    arc.angle = angle_between(arc.from, arc.to);
    arc.normal = normalised(cross(arc.from, arc.to));
    arc.forward = cross(arc.normal, arc.from);
    length_ += arc.angle;
    arcs_.push_back(arc);
  }
}

GreatCirclePath::Nearest GreatCirclePath::nearest(const Vector3& place, double reach) const {
  Nearest best{4.0, 0.0};
  const double far = std::sin(std::min(reach, 1.5));
  for (const Arc& arc : arcs_) {
    const double beside = dot(arc.normal, place);
    if (std::abs(beside) > far) continue;
    const double along = std::atan2(dot(arc.forward, place), dot(arc.from, place));
    Nearest found{};
    if (along >= 0.0 && along <= arc.angle) {
      found = {std::asin(std::min(1.0, std::abs(beside))), arc.begins + along};
    } else {
      const double before = angle_between(arc.from, place), behind = angle_between(arc.to, place);
      found =
          before < behind ? Nearest{before, arc.begins} : Nearest{behind, arc.begins + arc.angle};
    }
    if (found.distance < best.distance && found.distance <= reach) best = found;
  }
  return best;
}

}  // namespace geo
