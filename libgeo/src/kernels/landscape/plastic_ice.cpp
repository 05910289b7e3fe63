#include "geo/kernels/landscape/plastic_ice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "geo/core/error.hpp"
#include "ice_regions.hpp"
#include "kernels/numerics/monotone_queue.hpp"

namespace geo {
namespace {

constexpr float kUnreached = std::numeric_limits<float>::infinity();

void check_shape(const Grid& grid, std::size_t size, const char* name) {
  if (size == static_cast<std::size_t>(grid.size())) return;
  throw InputError(
      fmt::format("ice: {} has {} values on a grid of {} cells", name, size, grid.size()));
}

/// s of (s - b)(s - a) = k d.
double rise_along(double bed, double from, double kd) {
  return 0.5 * (bed + from + std::sqrt((bed - from) * (bed - from) + 4.0 * kd));
}

/// s of (s - b) |∇s| = k from neighbours `a` and `c`, dx and dy away; `above` is no less than it.
double rise_between(double bed, double a, double dx, double c, double dy, double k, double above) {
  const double x2 = 1.0 / (dx * dx), y2 = 1.0 / (dy * dy);
  // The product of convex functions that rise: Newton's steps come down to the root.
  double s = above;
  for (int step = 0; step < 12; ++step) {
    const double h = s - bed, u = s - a, v = s - c;
    const double gradient2 = u * u * x2 + v * v * y2;
    const double value = h * h * gradient2 - k * k;
    const double slope = 2.0 * h * gradient2 + 2.0 * h * h * (u * x2 + v * y2);
    const double change = value / slope;
    s -= change;
    if (!(change > 1e-5 * h)) break;
  }
  return s;
}

/// Cells that are not away, and those beside them.
CellSet cells_within_reach(const Grid& grid, std::span<const IceGround> ground) {
  const auto is_reached = [&](Index cell) { return ground[cell] != IceGround::away ? 1 : 0; };
  std::vector<std::uint8_t> within(ground.size(), 0);
  const auto offsets = grid.offsets();
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const Index row = grid.cell(0, j);
    const auto look_round = [&](int i) {
      int any = is_reached(row + i);
      for (int k = 0; k < kDirections; ++k) {
        const Index beside = grid.neighbour(i, j, k);
        if (beside != kNoCell) any |= is_reached(beside);
      }
      within[row + i] = static_cast<std::uint8_t>(any);
    };
    const bool is_inner = j > 0 && j < grid.ny() - 1;
    const int first = is_inner ? 1 : grid.nx(), last = is_inner ? grid.nx() - 1 : grid.nx();
    for (int i = 0; i < first; ++i) look_round(i);
    for (int i = first; i < last; ++i) {
      int any = is_reached(row + i);
      for (const Index offset : offsets) any |= is_reached(row + i + offset);
      within[row + i] = static_cast<std::uint8_t>(any);
    }
    for (int i = last; i < grid.nx(); ++i) look_round(i);
  }
  return {grid.size(), [&](Index c) { return within[c] != 0; }};
}

class March {
 public:
  March(const Grid& grid, double k_m, std::span<const float> bed_m,
        std::span<const IceGround> ground, const IceReach& reach)
      : grid_(grid),
        k_m_(k_m),
        bed_m_(bed_m),
        ground_(ground),
        reach_(reach.cells),
        offsets_(grid.offsets()) {
    surface_.order = reach.members;
    surface_.region_begins = reach.region_begins;
    surface_.height_m = SparseValues<float>(reach_);
    surface_.lowest = SparseValues<Index>(reach_, kNoCell);
    settled_ = SparseValues<std::uint8_t>(reach_);
  }

  IceSurface run() {
    std::size_t margins = 0;
    reach_->visit([&](Index cell) {
      surface_.height_m.of(cell) = kUnreached;
      surface_.lowest.of(cell) = cell;
      if (ground_[cell] != IceGround::away) return;
      settle_margin(cell);
      ++margins;
    });
    // A world without a margin.
    const bool is_endless = margins == 0 && reach_->size() == bed_m_.size();
    if (is_endless) {
      const auto lowest = std::min_element(bed_m_.begin(), bed_m_.end()) - bed_m_.begin();
      settle_margin(static_cast<Index>(lowest));
    }
    visit_regions(surface_.region_begins, [&](std::size_t region) { march(region, is_endless); });
    return std::move(surface_);
  }

 private:
  void settle_margin(Index cell) {
    surface_.height_m.of(cell) = std::max(bed_m_[cell], 0.0F);
    settled_.of(cell) = 1;
  }
  /// From the margins of a region up. Its cells come into the order in which they are reached.
  void march(std::size_t region, bool is_endless) {
    MonotoneQueue front;
    std::size_t next = surface_.region_begins[region];
    const auto is_margin = [&](Index cell) {
      return ground_[cell] == IceGround::away || (is_endless && settled_.of(cell) != 0);
    };
    for (const Index cell : cells_of(surface_, region)) {
      if (is_endless && settled_.of(cell) != 0) continue;
      const int i = grid_.column(cell), j = grid_.row(cell);
      const bool is_interior = grid_.is_interior(i, j);
      for (int k = 0; k < kDirections; ++k) {
        const Index margin = beside(cell, i, j, k, is_interior);
        if (margin == kNoCell || !is_margin(margin)) continue;
        reach(cell, reach_->place(cell), margin, surface_.height_m.of(margin), k, front);
      }
    }
    if (is_endless) {
      const auto is_settled = [&](Index cell) { return settled_.of(cell) != 0; };
      const auto at = std::find_if(surface_.order.begin(), surface_.order.end(), is_settled);
      std::iter_swap(surface_.order.begin(), at);
      ++next;
    }
    while (!front.empty()) {
      const auto [height, cell] = front.pop();
      const std::size_t place = reach_->place(cell);
      if (settled_.at(place) != 0 || height > surface_.height_m.at(place)) continue;
      settled_.at(place) = 1;
      surface_.order[next++] = cell;
      reach_neighbours(cell, surface_.height_m.at(place), front);
    }
  }
  void reach_neighbours(Index from, float height_m, MonotoneQueue& front) {
    const int i = grid_.column(from), j = grid_.row(from);
    const bool is_interior = grid_.is_interior(i, j);
    for (int k = 0; k < kDirections; ++k) {
      const Index cell = beside(from, i, j, k, is_interior);
      if (cell == kNoCell || ground_[cell] == IceGround::away) continue;
      const std::size_t place = reach_->place(cell);
      if (settled_.at(place) != 0) continue;
      const int back =
          is_interior ? (k + kDirections / 2) % kDirections : grid_.back_direction(j, k);
      reach(cell, place, from, height_m, back, front);
    }
  }
  [[nodiscard]] Index beside(Index cell, int i, int j, int k, bool is_interior) const {
    return is_interior ? cell + offsets_[k] : grid_.neighbour(i, j, k);
  }
  /// Of a cell and its place in the reach, from a settled neighbour `from_m` high, which lies in
  /// direction k of it.
  void reach(Index cell, std::size_t place, Index from, float from_m, int k, MonotoneQueue& front) {
    float& now = surface_.height_m.at(place);
    if (from_m >= now) return;
    const float height = std::max(static_cast<float>(rise(cell, from_m, k)), from_m);
    if (height >= now) return;
    now = height;
    surface_.lowest.at(place) = from;
    front.push(height, cell);
  }
  [[nodiscard]] double rise(Index cell, double below, int back) const {
    const double bed = bed_m_[cell];
    if (ground_[cell] == IceGround::bare) return std::max(bed, below);
    const int i = grid_.column(cell), j = grid_.row(cell);
    const bool is_interior = grid_.is_interior(i, j);
    const auto& distance = grid_.distances_m(j);
    const double along = rise_along(bed, below, k_m_ * distance[back]);
    if (back % 2 != 0) return along;  // diagonal
    const bool east_west = back == kEast || back == kWest;
    const auto lower = [&](int first, int second) {
      double best = kUnreached, apart = 1.0;
      for (const int side : {first, second}) {
        const Index to = beside(cell, i, j, side, is_interior);
        if (to == kNoCell) continue;
        const std::size_t place = reach_->place(to);
        if (settled_.at(place) == 0) continue;
        const float height = surface_.height_m.at(place);
        if (height < best) best = height, apart = distance[side];
      }
      return std::pair{best, apart};
    };
    const auto [other, apart] = east_west ? lower(kNorth, kSouth) : lower(kEast, kWest);
    if (!(other < along)) return along;
    return rise_between(bed, below, distance[back], other, apart, k_m_, along);
  }

  const Grid& grid_;
  double k_m_;
  std::span<const float> bed_m_;
  std::span<const IceGround> ground_;
  std::shared_ptr<const CellSet> reach_;
  IceSurface surface_;
  SparseValues<std::uint8_t> settled_;
  std::array<Index, kDirections> offsets_;
};

/// What becomes of the ice of a region.
struct RegionFlow {
  double accumulated_m3_yr = 0.0, melted_m3_yr = 0.0;
  MarginInflow out;
};
RegionFlow flow_of(std::size_t region, const Grid& grid, std::span<const float> bed_m,
                   std::span<const IceGround> ground, const IceSurface& surface,
                   const SparseValues<float>& balance_m_yr, IceFlux& flux) {
  RegionFlow flow;
  const IceOutflow outflow(grid, surface);
  const std::span<const Index> cells = cells_of(surface, region);
  for (auto at = cells.rbegin(); at != cells.rend(); ++at) {
    const Index cell = *at;
    const double area_m2 = grid.area_m2(grid.row(cell));
    double& through = flux.through_m3_yr.of(cell);
    const double own = balance_m_yr.of(cell) * area_m2;
    // Over a bed below the sea snow falls on ice that is there: on a grounded divide, which none
    // flows to, as well.
    const bool is_land = bed_m[cell] >= 0.0F || through > 0.0 ||
                         (ground[cell] == IceGround::iced && surface.height_m.of(cell) > 0.0F);
    if (own > 0.0 && is_land) {
      through += own;
      flow.accumulated_m3_yr += own;
    }
    if (through <= 0.0) continue;
    double melt = std::clamp(-own, 0.0, through);
    flux.share.of(cell) = own < 0.0 ? static_cast<float>(std::min(1.0, through / -own)) : 1.0F;
    if (surface.lowest.of(cell) == cell) melt = through;  // a world without a margin
    flux.melted.of(cell) = static_cast<float>(melt / through);
    flow.melted_m3_yr += melt;
    const double leaves = through - melt;
    if (leaves <= 0.0) continue;
    outflow.visit(cell, [&](Index to, double part) {
      if (ground[to] == IceGround::away) {
        flow.out.emplace_back(to, part * leaves);
      } else {
        flux.through_m3_yr.of(to) += part * leaves;
      }
    });
  }
  return flow;
}

}  // namespace

IceReach ice_reach(const Grid& grid, std::span<const IceGround> ground) {
  check_shape(grid, ground.size(), "the ground");
  IceReach reach;
  reach.cells = std::make_shared<const CellSet>(cells_within_reach(grid, ground));
  SparseValues<std::uint8_t> seen(reach.cells);
  const auto offsets = grid.offsets();
  const auto add = [&](Index cell) {
    if (ground[cell] == IceGround::away || seen.of(cell) != 0) return;
    seen.of(cell) = 1;
    reach.members.push_back(cell);
  };
  reach.cells->visit([&](Index first) {
    std::size_t at = reach.members.size();
    add(first);
    if (at < reach.members.size()) reach.region_begins.push_back(at);
    for (; at < reach.members.size(); ++at) {
      const Index cell = reach.members[at];
      const int i = grid.column(cell), j = grid.row(cell);
      const bool is_interior = grid.is_interior(i, j);
      for (int k = 0; k < kDirections; ++k) {
        const Index beside = is_interior ? cell + offsets[k] : grid.neighbour(i, j, k);
        if (beside != kNoCell) add(beside);
      }
    }
  });
  if (!reach.members.empty()) reach.region_begins.push_back(reach.members.size());
  return reach;
}

IceSurface plastic_ice_surface(const Grid& grid, double k_m, std::span<const float> bed_m,
                               std::span<const IceGround> ground) {
  return plastic_ice_surface(grid, k_m, bed_m, ground, ice_reach(grid, ground));
}

IceSurface plastic_ice_surface(const Grid& grid, double k_m, std::span<const float> bed_m,
                               std::span<const IceGround> ground, const IceReach& reach) {
  check_shape(grid, bed_m.size(), "the bed");
  check_shape(grid, ground.size(), "the ground");
  if (!(k_m > 0.0 && std::isfinite(k_m))) {
    throw InputError(fmt::format("ice: stress over weight of {} m, must be positive", k_m));
  }
  return March(grid, k_m, bed_m, ground, reach).run();
}

IceFlux ice_flux(const Grid& grid, std::span<const float> bed_m, std::span<const IceGround> ground,
                 const IceSurface& surface, const SparseValues<float>& balance_m_yr) {
  check_shape(grid, bed_m.size(), "the bed");
  check_shape(grid, ground.size(), "the ground");
  check_shape(grid, surface.height_m.cells(), "the surface");
  if (balance_m_yr.set() != surface.height_m.set()) {
    throw InputError("ice: the balance is not of the cells of the surface");
  }
  IceFlux flux;
  flux.through_m3_yr = SparseValues<double>(surface.height_m.set());
  flux.share = SparseValues<float>(surface.height_m.set());
  flux.melted = SparseValues<float>(surface.height_m.set());
  std::vector<RegionFlow> flows(surface.region_begins.size());
  visit_regions(surface.region_begins, [&](std::size_t region) {
    flows[region] = flow_of(region, grid, bed_m, ground, surface, balance_m_yr, flux);
  });
  for (const RegionFlow& flow : flows) {
    flux.accumulated_m3_yr += flow.accumulated_m3_yr;
    flux.melted_m3_yr += flow.melted_m3_yr;
    for (const auto& [to, part_m3_yr] : flow.out) {
      flux.through_m3_yr.of(to) += part_m3_yr;
      (bed_m[to] < 0.0F ? flux.calved_m3_yr : flux.melted_m3_yr) += part_m3_yr;
    }
  }
  return flux;
}

}  // namespace geo
