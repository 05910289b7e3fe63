#include "planet_window.hpp"

#include <algorithm>

namespace geo {

PlanetWindow::PlanetWindow(const PlanetCells& cells, std::span<const Index> receiver)
    : planet_(cells.planet()),
      frame_(cells.fine()),
      first_(planet_.cell(0, cells.first_row())),
      where_(cells.size(), kOutside) {
  const auto end = first_ + static_cast<Index>(where_.size());
#pragma omp parallel for schedule(static)
  for (Index c = first_; c < end; ++c) {
    const int row = planet_.row(c);
    const auto p = frame_.project(planet_.position(planet_.column(c), row));
    if (frame_.holds(p)) {
      where_[c - first_] = kInside;
    } else if (frame_.holds(p, 0.5 * planet_.spacing_east_m(row), 0.5 * planet_.step_north_m())) {
      where_[c - first_] = kNear;
    }
  }
  std::vector<Index> way;
  for (Index c = first_; c < end; ++c) {
    way.clear();
    Index next = c;
    while (holds(next) && where(next) == kNear && receiver[next] != next) {
      way.push_back(next);
      next = receiver[next];
    }
    const bool goes_in = holds(next) && where(next) == kInside;
    for (const Index passed : way) where_[passed - first_] = goes_in ? kInside : kOutside;
  }
}

std::array<double, 2> PlanetWindow::place(Index planet_cell) const {
  const auto p =
      frame_.project(planet_.position(planet_.column(planet_cell), planet_.row(planet_cell)));
  return inside(planet_cell) ? frame_.nearest_within(p) : p;
}

}  // namespace geo
