#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/cell_set.hpp"
#include "geo/core/grid.hpp"

namespace geo {

/// Whether ice can be on a cell.
enum class IceGround : std::uint8_t {
  away,  ///< no ice ever comes here: the sea, warm land; what flows in is gone
  bare,  ///< ice may come here
  iced,
};

/// Where ice may come: the cells that are not `away` in regions that touch each other only across
/// margins, and the margins, cells that are away beside them. It takes memory for these alone.
struct IceReach {
  std::shared_ptr<const CellSet> cells;    ///< those of regions, and margins
  std::vector<Index> members;              ///< those of regions, one region after the other
  std::vector<std::size_t> region_begins;  ///< where each begins in that, and the end of the last
};

/// `ground`: one value per cell. Throws InputError otherwise. Cost: linear; rows are shared out to
/// threads.
[[nodiscard]] IceReach ice_reach(const Grid& grid, std::span<const IceGround> ground);

/// Surface of ice, and of the ground between, with the order in which it rises. It is known where
/// cells are not `away` and beside those: mostly a small part of a planet, and so is what it takes.
struct IceSurface {
  SparseValues<float> height_m;  ///< bed plus ice; on bare ground that which drains to the margin
  std::vector<Index> order;      ///< cells that are not `away`: region by region, lowest first
  std::vector<std::size_t> region_begins;  ///< as in IceReach
  SparseValues<Index> lowest;  ///< neighbour that each cell was reached from; itself where away
};

/// Perfectly plastic ice: the shear stress at its base is the yield stress τ everywhere (Nye 1951;
/// Reeh 1982), so that its surface s over the bed b rises from the margins by
///
///   (s - b) |∇s| = τ / (ρ g) = k
///
/// From a margin on level ground s = sqrt(2 k x), on a slope S thickness is k / S. Solved from the
/// margins up in one sweep (fast marching, Sethian 1996): each cell from the neighbours below it by
/// a first-order upwind difference in two directions, or along a diagonal where that is lower.
/// Cells that are `away` are margins, at their bed or at sea level 0; bare ground is filled as far
/// as it does not drain to one. On a world without a margin the lowest cell serves as one.
///
/// `bed_m`, `ground`: one value per cell. `k_m` > 0, m. `reach`: of any ground that is away in the
/// same cells; ice that comes and goes elsewhere leaves it as it is. Throws InputError where shapes
/// do not fit or k is not positive and finite. Cost: n log n in the cells that are not away, for
/// which it takes memory. Regions are shared out to threads; the same bits always.
[[nodiscard]] IceSurface plastic_ice_surface(const Grid& grid, double k_m,
                                             std::span<const float> bed_m,
                                             std::span<const IceGround> ground,
                                             const IceReach& reach);
/// The same, with the reach of that ground.
[[nodiscard]] IceSurface plastic_ice_surface(const Grid& grid, double k_m,
                                             std::span<const float> bed_m,
                                             std::span<const IceGround> ground);

/// Ice that passes through the cells of a steady glacier; none beyond the cells of its surface.
struct IceFlux {
  SparseValues<double> through_m3_yr;  ///< what a cell gets, snow of its own included
  SparseValues<float> share;           ///< of the cell that ice covers
  SparseValues<float> melted;          ///< share of the ice that ends in the cell
  double accumulated_m3_yr = 0.0, melted_m3_yr = 0.0, calved_m3_yr = 0.0;
};

/// Where the neighbours of a cell that its ice flows to, and in which shares: down the slope of the
/// surface through each face, as wide as that is; along the diagonal it was reached from, if it
/// was.
class IceOutflow {
 public:
  IceOutflow(const Grid& grid, const IceSurface& surface)
      : grid_(grid), surface_(surface), offsets_(grid.offsets()) {}

  /// Calls `visit(neighbour, share)`; shares add up to 1 but for rounding.
  template <class Visit>
  void visit(Index cell, Visit&& visit) const {
    const int i = grid_.column(cell), j = grid_.row(cell);
    const bool is_interior = grid_.is_interior(i, j);
    const float s = surface_.height_m.of(cell);
    const auto& distance = grid_.distances_m(j);
    Index to[5];
    double weight[5];
    int count = 0;
    double sum = 0.0;
    const auto add = [&](Index neighbour, double face_m, double distance_m) {
      const double w = face_m * (s - surface_.height_m.of(neighbour)) / distance_m;
      if (!(w > 0.0)) return;
      to[count] = neighbour, weight[count] = w, ++count;
      sum += w;
    };
    bool straight = false;
    const Index lowest = surface_.lowest.of(cell);
    for (const int k : {kNorth, kEast, kSouth, kWest}) {
      const Index neighbour = is_interior ? cell + offsets_[k] : grid_.neighbour(i, j, k);
      if (neighbour == kNoCell) continue;
      straight = straight || neighbour == lowest;
      const double face_m = k == kEast || k == kWest ? grid_.face_east_m(j)
                                                     : grid_.face_north_m(k == kNorth ? j : j - 1);
      add(neighbour, face_m, distance[k]);
    }
    if (!straight && lowest != cell) {
      for (const int k : {kNorthEast, kSouthEast, kSouthWest, kNorthWest}) {
        if (grid_.neighbour(i, j, k) != lowest) continue;
        add(lowest, 0.5 * std::min(grid_.face_east_m(j), grid_.spacing_east_m(j)), distance[k]);
        break;
      }
    }
    if (count == 0) return visit(lowest, 1.0);  // level: the way it was filled from
    for (int n = 0; n < count; ++n) visit(to[n], weight[n] / sum);
  }

 private:
  const Grid& grid_;
  const IceSurface& surface_;
  std::array<Index, kDirections> offsets_;
};

/// Steady flux of ice down a surface: every cell passes on what comes and what snow adds, less what
/// melts of it, as far as there is any. Accumulation equals melt and calving to rounding, whatever
/// the surface. Ice forms on land, where ice comes, and, over a bed that its weight has pressed
/// below the sea, where it already stands above the water; cells that are `away` melt what reaches
/// them, or let it calve where their bed lies below the sea.
///
/// `balance_m_yr`: m of ice a year on the cells that the surface has, read where the ground is not
/// away; InputError where it is of others. Cost: linear. Regions are shared out to threads; the
/// same bits always.
[[nodiscard]] IceFlux ice_flux(const Grid& grid, std::span<const float> bed_m,
                               std::span<const IceGround> ground, const IceSurface& surface,
                               const SparseValues<float>& balance_m_yr);

}  // namespace geo
