#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/vector3.hpp"

namespace geo {

/// A place of a border between two cells, or where borders meet.
struct BorderPoint {
  Vector3 place;         ///< unit vector, z to the north pole, x to longitude 0
  Index left = kNoCell;  ///< the cells on both sides, as one goes along; kNoCell where borders meet
  Index right = kNoCell;
};

/// A border between two labels, from where it meets others to where it does so again, or closed:
/// its first point then is its last one too.
struct BorderLine {
  std::int32_t left = 0, right = 0;  ///< labels on both sides, as one goes along
  std::vector<BorderPoint> points;
};

/// A connected region of one label. Rings are closed, their first place repeated at the end, with
/// the region to the left of them: anticlockwise outside, clockwise round holes. The ring outside
/// is the one to whose right most of the sphere lies.
struct BorderedRegion {
  std::int32_t label = 0;
  std::vector<Vector3> outside;
  std::vector<std::vector<Vector3>> holes;
};

/// Cells of label `kNoLabel` are in no region, but have borders with others.
inline constexpr std::int32_t kNoLabel = -1;

/// Where a border lies between two neighbouring cells: 0 at the middle of the first one, 1 at that
/// of the second.
using BorderShare = std::function<double(Index, Index)>;
/// Half way.
[[nodiscard]] inline double half_way(Index /*first*/, Index /*second*/) { return 0.5; }

/// The partition of a sphere of cells into regions of equal labels, traced cell side by cell side.
/// Points lie on the great circles between the middles of neighbouring cells, so that a border half
/// way is at most half a cell off and steps of cells become chamfers, and one by linear
/// interpolation of a field is its contour. All that borders on a place shares its points to the
/// bit. Of four cells at a corner whose labels alternate none touches the one across.
///
/// Throws Bug unless the grid is a sphere with one label per cell. Cost: linear in cells.
class RegionBorders {
 public:
  RegionBorders(const Grid& grid, std::span<const std::int32_t> label,
                const BorderShare& share = half_way);

  /// In the order of the cells at which they begin.
  [[nodiscard]] std::span<const BorderLine> lines() const { return lines_; }
  /// In the order of their first cells. A label that covers the sphere has no border and no region.
  [[nodiscard]] std::span<const BorderedRegion> regions() const { return regions_; }

 private:
  std::vector<BorderLine> lines_;
  std::vector<BorderedRegion> regions_;
};

/// The solid angle to the left of a closed line of great circles, sr, 0 to 4 pi.
[[nodiscard]] double area_to_the_left_sr(std::span<const Vector3> ring);

}  // namespace geo
