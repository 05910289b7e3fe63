#include "island_window.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/projection.hpp"

namespace geo {
namespace {

/// Twice as wide as the seam along the wide grid's edge (seam_m), as far as the hemisphere reaches.
int margin_cells(const IslandParameters& p, Centre centre, Ellipsoid figure) {
  constexpr double kShare = 0.05;  // of the shorter side
  if (p.edge_fade) return 0;
  const double rim_m =
      std::numbers::sqrt2 * EqualAreaProjection(centre, figure).authalic_radius_m();
  const auto corner_m = [&](int margin) {
    return p.cell_m * std::hypot(0.5 * static_cast<double>(p.nx) + margin,
                                 0.5 * static_cast<double>(p.ny) + margin);
  };
  int margin = static_cast<int>(std::ceil(kShare * static_cast<double>(std::min(p.nx, p.ny))));
  while (margin > 0 && corner_m(margin) > rim_m) --margin;
  return margin;
}

std::shared_ptr<const Grid> grid_of(const IslandParameters& p, int margin, Centre centre,
                                    Ellipsoid figure) {
  return std::make_shared<const Grid>(Grid::equal_area(static_cast<int>(p.nx) + 2 * margin,
                                                       static_cast<int>(p.ny) + 2 * margin,
                                                       p.cell_m, centre, figure));
}

}  // namespace

IslandWindow::IslandWindow(const IslandParameters& p, Centre centre, Ellipsoid figure)
    : margin_(margin_cells(p, centre, figure)),
      island_(grid_of(p, 0, centre, figure)),
      wide_(margin_ > 0 ? grid_of(p, margin_, centre, figure) : island_) {}

}  // namespace geo
