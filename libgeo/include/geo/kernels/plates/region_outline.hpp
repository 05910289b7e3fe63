#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// The first two edges of a closed line that cross each other, each by the place that it begins at,
/// from 0. Edges are as RegionOutline takes them. Lines that only touch do not cross, and loops of
/// less than 0.1 square degrees are taken for the rounding of drawn lines.
[[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> first_crossing(
    const std::vector<Centre>& ring);

/// What closed lines on a planet enclose: a place within an odd number of them is inside.
///
/// Edges are straight in latitude and longitude, as GeoJSON has them (RFC 7946), and take the short
/// way round: lines may cross the date line, be cut along it, or use longitudes beyond it. An edge
/// between the two ends of the map, -180 and 180, along a pole or behind an edge down the map's
/// side, runs along its parallel. A line that goes once round the planet encloses the pole that it
/// touches, else the smaller of its two sides.
///
/// A place is compared with the edges of its own degree of latitude only.
class RegionOutline {
 public:
  explicit RegionOutline(std::span<const std::vector<Centre>> rings);
  [[nodiscard]] bool holds(const Centre& place) const;

 private:
  struct Edge {
    double from_latitude, from_longitude, to_latitude, to_longitude;
  };
  void add_ring(const std::vector<Centre>& ring);
  void add_edge(const Edge& edge);
  std::array<std::vector<Edge>, 180> edges_;  // by degrees of latitude from the south pole
};

}  // namespace geo
