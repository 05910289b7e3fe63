#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/remapping/planet_cells.hpp"
#include "kernels/remapping/plane_frame.hpp"

namespace geo {

/// Which of the planet's cells drain within a part of it.
///
/// Those whose centres lie in it, and those whose centres lie less than half a cell beyond its edge
/// as long as their water goes in without leaving that margin. So a river that runs along the edge
/// does not go out and in with the grid of the planet.
class PlanetWindow {
 public:
  PlanetWindow(const PlanetCells& cells, std::span<const Index> receiver);

  [[nodiscard]] bool inside(Index planet_cell) const {
    return holds(planet_cell) && where(planet_cell) == kInside;
  }
  /// Where the centre of a planet's cell lies on the map; just within the edge for cells inside.
  [[nodiscard]] std::array<double, 2> place(Index planet_cell) const;
  [[nodiscard]] const PlaneFrame& frame() const { return frame_; }

 private:
  enum Where : std::uint8_t { kOutside, kNear, kInside };
  [[nodiscard]] bool holds(Index planet_cell) const {
    return planet_cell >= first_ && planet_cell < first_ + static_cast<Index>(where_.size());
  }
  [[nodiscard]] std::uint8_t where(Index planet_cell) const { return where_[planet_cell - first_]; }

  const Grid& planet_;
  PlaneFrame frame_;
  Index first_;
  std::vector<std::uint8_t> where_;
};

}  // namespace geo
