#pragma once

#include <vector>

#include "geo/core/vector3.hpp"

namespace geo {

/// Cross section of a rift, lengths in m.
struct RiftSection {
  double half_width_m;  ///< from the middle to the crest of a shoulder
  double depth_m;       ///< of the floor below the old ground
  double shoulder_m;    ///< height of the crest above it
  double flexure_m;     ///< flexural parameter of the plate
};

/// Change of a level ground at `distance_m` from the middle line, continuous: a floor to 0.6 of the
/// half width, a smooth wall up to the crest, and beyond it, x from the crest, the deflection of a
/// broken elastic plate that is unloaded at its end (Turcotte & Schubert 2002, 3.16; Weissel &
/// Karner 1989)
///   shoulder exp(-x / flexure) cos(x / flexure).
[[nodiscard]] double rift_profile_m(const RiftSection& section, double distance_m);

/// A line of arcs of great circles on the unit sphere.
class GreatCirclePath {
 public:
  /// At least two unit vectors; none the antipode of the next.
  explicit GreatCirclePath(std::vector<Vector3> places);

  struct Nearest {
    double distance;  ///< from the line, radians
    double along;     ///< of the foot, from the beginning of the line, radians
  };
  /// Where the line passes the place nearest; `distance` beyond `reach` is returned as 4.
  [[nodiscard]] Nearest nearest(const Vector3& place, double reach) const;
  [[nodiscard]] double length() const { return length_; }

 private:
  struct Arc {
    Vector3 from{}, to{}, normal{}, forward{};  ///< `forward` is 90 degrees on from `from`
    double angle = 0.0, begins = 0.0;
  };
  std::vector<Arc> arcs_;
  double length_ = 0.0;
};

}  // namespace geo
