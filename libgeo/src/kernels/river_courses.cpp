#include "geo/kernels/river_courses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>
#include <vector>

#include "plane_frame.hpp"

namespace geo {
namespace {

/// Columns and rows of a fine grid, both ends included.
struct Box {
  int west, east, south, north;
  [[nodiscard]] int width() const { return east - west + 1; }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width()) * (north - south + 1);
  }
  [[nodiscard]] bool holds(int i, int j) const {
    return i >= west && i <= east && j >= south && j <= north;
  }
  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j - south) * width() + (i - west);
  }
};

/// One end of a step of a river.
struct End {
  Index cell = kNoCell;
  double level_m = 0.0;
};

using Front = std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>,
                                  std::greater<>>;

class Courses {
 public:
  Courses(const Grid& fine, std::span<float> z) : fine_(fine), z_(z) {}

  /// The path of least cost from one end to the other, both included; empty if there is none.
  [[nodiscard]] std::vector<Index> path(const End& from, const End& to, int margin) {
    const Box box = around(from.cell, to.cell, margin);
    constexpr double kFar = std::numeric_limits<double>::infinity();
    cost_.assign(box.size(), kFar);
    back_.assign(box.size(), kNoCell);
    Front front;
    const auto place = [&](Index c) { return box.at(fine_.column(c), fine_.row(c)); };
    cost_[place(from.cell)] = 0.0;
    front.push({0.0, from.cell});
    while (!front.empty() && front.top().second != to.cell) {
      const auto [so_far, c] = front.top();
      front.pop();
      if (so_far > cost_[place(c)]) continue;
      for (int k = 0; k < kDirections; ++k) {
        const Index next = fine_.neighbour(c, k);
        if (next == kNoCell) continue;
        const int i = fine_.column(next), j = fine_.row(next);
        // Water that touches the edge leaves.
        if (!box.holds(i, j) || (fine_.is_open_edge(i, j) && next != to.cell)) continue;
        const double length_m = fine_.distances_m(j)[k];
        const double more = length_m * resistance(next, from, to);
        double& least = cost_[box.at(i, j)];
        if (so_far + more >= least) continue;
        least = so_far + more;
        back_[box.at(i, j)] = c;
        front.push({least, next});
      }
    }
    std::vector<Index> way;
    for (Index c = to.cell; c != kNoCell; c = back_[place(c)]) way.push_back(c);
    if (way.back() != from.cell) return {};
    std::reverse(way.begin(), way.end());
    return way;
  }

  /// Cuts what stands above the levels along a path.
  void cut(std::span<const Index> way, const End& from, const End& to) {
    for (std::size_t k = 0; k < way.size(); ++k) {
      const double share = static_cast<double>(k) / std::max<std::size_t>(1, way.size() - 1);
      const auto level_m = static_cast<float>(std::lerp(from.level_m, to.level_m, share));
      const Index c = way[k];
      if (z_[c] <= level_m || is_edge(c)) continue;
      z_[c] = level_m;
      cut_.push({level_m, c});
    }
  }

  /// Lays back the sides of all cuts.
  void lay_back_sides() {
    constexpr double kSlope = 0.15;
    while (!cut_.empty()) {
      const auto [height_m, c] = cut_.top();
      cut_.pop();
      if (height_m > z_[c]) continue;
      for (int k = 0; k < kDirections; ++k) {
        const Index next = fine_.neighbour(c, k);
        if (next == kNoCell || is_edge(next)) continue;
        const auto most_m =
            static_cast<float>(height_m + kSlope * fine_.distances_m(fine_.row(c))[k]);
        if (z_[next] <= most_m) continue;
        z_[next] = most_m;
        cut_.push({most_m, next});
      }
    }
  }

 private:
  [[nodiscard]] bool is_edge(Index c) const {
    return fine_.is_open_edge(fine_.column(c), fine_.row(c));
  }
  [[nodiscard]] Box around(Index a, Index b, int margin) const {
    const auto [west, east] = std::minmax({fine_.column(a), fine_.column(b)});
    const auto [south, north] = std::minmax({fine_.row(a), fine_.row(b)});
    return {std::max(0, west - margin), std::min(fine_.nx() - 1, east + margin),
            std::max(0, south - margin), std::min(fine_.ny() - 1, north + margin)};
  }
  /// Cost of a metre at a cell.
  [[nodiscard]] double resistance(Index c, const End& from, const End& to) const {
    constexpr double kDigging_m = 20.0;
    const double di = fine_.column(to.cell) - fine_.column(from.cell);
    const double dj = fine_.row(to.cell) - fine_.row(from.cell);
    const double along = (fine_.column(c) - fine_.column(from.cell)) * di +
                         (fine_.row(c) - fine_.row(from.cell)) * dj;
    const double share = std::clamp(along / std::max(1.0, di * di + dj * dj), 0.0, 1.0);
    const double level_m = std::lerp(from.level_m, to.level_m, share);
    return 1.0 + std::max(0.0, z_[c] - level_m) / kDigging_m;
  }

  const Grid& fine_;
  std::span<float> z_;
  std::vector<double> cost_;
  std::vector<Index> back_;
  Front cut_;
};

/// Where the rivers of a planet's cells are at their centres.
class Beds {
 public:
  Beds(const PlanetCells& cells, const PlanetWater& water, std::span<const float> z)
      : cells_(cells), water_(water), z_(z), frame_(cells.fine()) {}

  [[nodiscard]] bool inside(Index planet_cell) const { return frame_.holds(place(planet_cell)); }

  /// The lowest place within a quarter of a planet cell of the centre, away from the edge.
  End operator()(Index planet_cell) {
    const auto [found, is_new] = bed_.try_emplace(planet_cell, End{});
    if (is_new) {
      found->second = {lowest(planet_cell), std::max(0.0F, water_.elevation_m[planet_cell])};
    }
    return found->second;
  }
  /// A quarter of a planet cell in fine cells.
  [[nodiscard]] int reach(Index planet_cell) const {
    const Grid& planet = cells_.planet();
    const int row = planet.row(planet_cell);
    const double cell_m = std::min(planet.spacing_east_m(row), planet.step_north_m());
    return static_cast<int>(0.25 * cell_m / cells_.fine().spacing_east_m(0));
  }

 private:
  [[nodiscard]] std::array<double, 2> place(Index c) const {
    const Grid& planet = cells_.planet();
    return frame_.project(planet.position(planet.column(c), planet.row(c)));
  }
  [[nodiscard]] Index lowest(Index planet_cell) const {
    const Grid& fine = cells_.fine();
    const auto [x, y] = place(planet_cell);
    const auto clamped = [](double v, int n) {
      return std::clamp(static_cast<int>(std::floor(v)), 1, n - 2);
    };
    const int ci = clamped(x / fine.spacing_east_m(0) + 0.5 * fine.nx(), fine.nx());
    const int cj = clamped(y / fine.step_north_m() + 0.5 * fine.ny(), fine.ny());
    const int r = reach(planet_cell);
    Index best = fine.cell(ci, cj);
    for (int j = std::max(1, cj - r); j <= std::min(fine.ny() - 2, cj + r); ++j) {
      for (int i = std::max(1, ci - r); i <= std::min(fine.nx() - 2, ci + r); ++i) {
        const Index c = fine.cell(i, j);
        if (z_[c] < z_[best]) best = c;
      }
    }
    return best;
  }

  const PlanetCells& cells_;
  const PlanetWater& water_;
  std::span<const float> z_;
  PlaneFrame frame_;
  std::map<Index, End> bed_;
};

}  // namespace

void open_river_courses(const PlanetCells& cells, const PlanetWater& water,
                        std::span<const RiverCrossing> crossings, std::span<float> elevation_m) {
  const Grid& planet = cells.planet();
  Beds beds(cells, water, elevation_m);
  Courses courses(cells.fine(), elevation_m);
  std::map<Index, Index> crossing_of;
  for (const auto& [planet_cell, edge_cell] : crossings) crossing_of[planet_cell] = edge_cell;

  const Index end = planet.cell(0, cells.first_row()) + static_cast<Index>(cells.size());
  for (Index from = planet.cell(0, cells.first_row()); from < end; ++from) {
    const Index to = water.receiver[from];
    if (to == from || water.drainage_area_m2[from] < kRiverCells * planet.area_m2(planet.row(from)))
      continue;
    const bool starts_inside = beds.inside(from), ends_inside = beds.inside(to);
    if (!starts_inside && !ends_inside) continue;
    const auto crossing = crossing_of.find(from);
    // Straight into or out of the sea.
    if (starts_inside != ends_inside && crossing == crossing_of.end()) continue;
    const auto at_edge = [&] {
      return End{crossing->second, static_cast<double>(elevation_m[crossing->second])};
    };
    const End source = starts_inside ? beds(from) : at_edge();
    const End goal = ends_inside ? beds(to) : at_edge();
    const auto way = courses.path(source, goal, std::max(1, 2 * beds.reach(from)));
    courses.cut(way, source, goal);
  }
  courses.lay_back_sides();
}

}  // namespace geo
