#pragma once

#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"

namespace geo {

/// What makes a window of a planet worth a closer look (Tectonica blueprint, eq. 9.1), cells
/// weighted by their true area:
///   mix = 1 - 2.5 |land fraction - 0.4|
///   score = mix * coast fraction * min(elevation range / 5000 m, 1)
///           * (1 + 2 min(boundary fraction, 0.5)) + 0.3 noise
/// Coast cells are land (elevation >= 0) with sea in one of four neighbours: the finer the planet's
/// grid, the smaller their share, until noise alone decides. The appeal of a window is the same
/// without that: coasts count by their length over the circumference of the window, 1 at most, and
/// noise multiplies (design):
///   appeal = mix * min(coast, 1) * min(elevation range / 5000 m, 1)
///            * (1 + 2 min(boundary fraction, 0.5)) * (1 + 0.3 noise) + 0.001 noise
struct RegionFigures {
  double land_fraction = 0.0, coast_fraction = 0.0, boundary_fraction = 0.0;
  double coast_share = 0.0;  ///< length, a cell as long as a row is high, over the circumference
  double elevation_range_m = 0.0;
  [[nodiscard]] double score(double noise) const;
  [[nodiscard]] double appeal(double noise) const;
};

/// The window of `width_m` x `height_m` round a cell: whole rows and columns of the planet, as many
/// as fit that size at the latitude of the cell (at least one), wrapping round.
/// `boundary_type` may be empty.
/// Arrays have one value per cell, `boundary_type` may be empty; Bug otherwise.
RegionFigures region_figures(const Grid& planet, std::span<const float> elevation_m,
                             std::span<const std::int8_t> boundary_type, Index centre,
                             double width_m, double height_m);

/// How the land of a window lies in it, as shares of its land: pieces that it holds whole, the
/// largest piece that its border cuts, and the other pieces that it cuts. Cells whose corners touch
/// are connected. In windows more than 128 cells wide or high only every second cell is looked at,
/// or every third and so on.
struct RegionLand {
  double whole = 0.0, main = 0.0, others = 0.0;
  /// What its score is multiplied by where it is positive: 1 for islands, 0.6 for one coast, less
  /// the more of other lands the window cuts (design).
  [[nodiscard]] double weight() const;
};
/// `elevation_m`: one value per cell; Bug otherwise.
RegionLand region_land(const Grid& planet, std::span<const float> elevation_m, Index centre,
                       double width_m, double height_m);

/// By what windows are compared: by eq. 9.1, or by their appeal and by how whole their land is.
enum class RegionRule { figures, whole };

/// The best window's centre cell, of those that have land where any has. Windows smaller than three
/// cells a side are judged with the cells around them. Candidates lie an eighth of a window apart;
/// windows that reach into the polar tenth of the rows at either end are left out; if none is left,
/// the middle row alone is searched. Noise in 0..1 is a function of seed and position. The land of
/// the 64 best windows of each row is looked at, best first, until no later one can be better.
/// Cost: linear in cells. Throws InputError unless `planet` is a sphere. Arrays have one value per
/// cell, `boundary_type` may be empty; Bug otherwise.
Index best_region(const Grid& planet, std::span<const float> elevation_m,
                  std::span<const std::int8_t> boundary_type, double width_m, double height_m,
                  std::uint64_t seed, RegionRule rule = RegionRule::whole);

/// The noise of eq. 9.1 at a cell.
double region_noise(const Grid& planet, Index centre, double width_m, std::uint64_t seed);

}  // namespace geo
