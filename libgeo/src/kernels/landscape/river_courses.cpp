#include "geo/kernels/landscape/river_courses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "kernels/water/planet_window.hpp"

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

int cells_to_edge(const Grid& fine, Index c) {
  const int i = fine.column(c), j = fine.row(c);
  return std::min({i, fine.nx() - 1 - i, j, fine.ny() - 1 - j});
}

/// Factor of the cost of a path through ground of some noise.
double toughness(double noise) {
  constexpr double kWinding = 2.0;
  return std::exp(kWinding * noise);
}

using Front = std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>,
                                  std::greater<>>;

/// Courses as they grow, from the sea upstream.
class Network {
 public:
  /// @param strip  cells along the edge that courses keep clear of, unless they cross it
  Network(const Grid& fine, std::span<const float> z, std::span<const float> noise, int strip)
      : fine_(fine), z_(z), noise_(noise), strip_(strip), place_(z.size(), kNone) {}

  /// Place of a cell in the courses, kNone where there is none.
  [[nodiscard]] std::int32_t place(Index cell) const { return place_[cell]; }

  /// Place of an end, which begins a course of its own if there is none yet.
  std::int32_t root(const End& end) {
    if (place_[end.cell] == kNone) append(end.cell, kCourseEnds, end.level_m);
    return place_[end.cell];
  }

  /// Adds the course from one end to the other. `joins(place)`: whether it may end there already.
  /// Returns false if it did not find a way clear of other rivers.
  template <class Joins>
  bool connect(const End& from, const End& to, int margin, const Joins& joins, bool may_touch) {
    const Box box = around(from.cell, to.cell, margin);
    constexpr double kFar = std::numeric_limits<double>::infinity();
    cost_.assign(box.size(), kFar);
    back_.assign(box.size(), kNoCell);
    Front front;
    const auto at = [&](Index c) { return box.at(fine_.column(c), fine_.row(c)); };
    const bool to_sea = z_[to.cell] < 0.0F;
    const auto ends_at = [&](Index c) {
      return c == to.cell || (to_sea && z_[c] < 0.0F) ||
             (place_[c] != kNone && (may_touch || joins(place_[c])));
    };
    cost_[at(from.cell)] = 0.0;
    front.push({0.0, from.cell});
    Index end = kNoCell;
    while (!front.empty()) {
      const auto [so_far, c] = front.top();
      front.pop();
      if (so_far > cost_[at(c)]) continue;
      if (c != from.cell && ends_at(c)) {
        end = c;
        break;
      }
      for (int k = 0; k < kDirections; ++k) {
        const Index next = fine_.neighbour(c, k);
        if (next == kNoCell) continue;
        const int i = fine_.column(next), j = fine_.row(next);
        // Water that touches the edge leaves.
        if (!box.holds(i, j) || (fine_.is_open_edge(i, j) && next != to.cell)) continue;
        if (!may_touch && (touches_others(next, from, to, joins) || (!to_sea && touches_sea(next))))
          continue;
        const double length_m = fine_.distances_m(j)[k];
        const double more = length_m * resistance(next, from, to);
        double& least = cost_[box.at(i, j)];
        if (so_far + more >= least) continue;
        least = so_far + more;
        back_[box.at(i, j)] = c;
        front.push({least, next});
      }
    }
    if (end == kNoCell) return false;
    lay(from, {end, to.level_m}, [&](Index c) { return back_[at(c)]; });
    return true;
  }

  [[nodiscard]] std::size_t size() const { return courses_.cell.size(); }
  RiverCourses take() { return std::move(courses_); }

  static constexpr std::int32_t kNone = -1;

 private:
  void append(Index cell, std::int32_t next, double level_m) {
    place_[cell] = static_cast<std::int32_t>(courses_.cell.size());
    courses_.cell.push_back(cell);
    courses_.next.push_back(next);
    courses_.level_m.push_back(static_cast<float>(level_m));
  }
  template <class Back>
  void lay(const End& from, const End& to, const Back& back) {
    std::vector<Index> way;  // upstream
    for (Index c = to.cell; c != kNoCell; c = back(c)) way.push_back(c);
    std::int32_t next = root(to);
    const double end_m = std::min<double>(to.level_m, courses_.level_m[next]);
    for (std::size_t k = 1; k < way.size(); ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(way.size() - 1);
      append(way[k], next, std::lerp(end_m, std::max(end_m, from.level_m), share));
      next = place_[way[k]];
    }
  }
  template <class Joins>
  [[nodiscard]] bool touches_others(Index c, const End& from, const End& to,
                                    const Joins& joins) const {
    const auto foreign = [&](Index cell) {
      return place_[cell] != kNone && cell != from.cell && cell != to.cell && !joins(place_[cell]);
    };
    if (foreign(c)) return true;
    if (c == to.cell || place_[c] != kNone) return false;
    for (int k = 0; k < kDirections; ++k) {
      const Index next = fine_.neighbour(c, k);
      if (next != kNoCell && foreign(next)) return true;
    }
    return false;
  }
  [[nodiscard]] bool touches_sea(Index c) const {
    if (z_[c] < 0.0F) return true;
    for (int k = 0; k < kDirections; ++k) {
      const Index next = fine_.neighbour(c, k);
      if (next != kNoCell && z_[next] < 0.0F) return true;
    }
    return false;
  }
  [[nodiscard]] Box around(Index a, Index b, int margin) const {
    const auto [west, east] = std::minmax({fine_.column(a), fine_.column(b)});
    const auto [south, north] = std::minmax({fine_.row(a), fine_.row(b)});
    return {std::max(0, west - margin), std::min(fine_.nx() - 1, east + margin),
            std::max(0, south - margin), std::min(fine_.ny() - 1, north + margin)};
  }
  /// Cost of a metre at a cell: low ground is easy, no ground is quite even, and the edge, which is
  /// nothing on the ground, does not lead rivers along it, nor along a line at a distance from it.
  [[nodiscard]] double resistance(Index c, const End& from, const End& to) const {
    constexpr double kDigging_m = 20.0, kHollow_m = 100.0, kStrip = 6.0, kUneven = 0.5;
    const double di = fine_.column(to.cell) - fine_.column(from.cell);
    const double dj = fine_.row(to.cell) - fine_.row(from.cell);
    const double along = (fine_.column(c) - fine_.column(from.cell)) * di +
                         (fine_.row(c) - fine_.row(from.cell)) * dj;
    const double share = std::clamp(along / std::max(1.0, di * di + dj * dj), 0.0, 1.0);
    const double level_m = std::lerp(from.level_m, to.level_m, share);
    const double low_m = level_m - std::min(0.5 * level_m, kHollow_m);
    const double strip = strip_ * (1.0 + kUneven * noise_[c]);
    const double in_strip =
        std::max(0.0, 1.0 - static_cast<double>(cells_to_edge(fine_, c)) / std::max(1.0, strip));
    return toughness(noise_[c]) * (1.0 + kStrip * in_strip * in_strip) *
           (1.0 + std::max(0.0, z_[c] - low_m) / kDigging_m);
  }

  const Grid& fine_;
  std::span<const float> z_, noise_;
  int strip_;
  RiverCourses courses_;
  std::vector<std::int32_t> place_;
  std::vector<double> cost_;
  std::vector<Index> back_;
};

/// Where the rivers of a planet's cells are at their centres.
class Beds {
 public:
  Beds(const PlanetCells& cells, const PlanetWater& water, std::span<const float> z)
      : cells_(cells), water_(water), z_(z), window_(cells, water.receiver) {}

  [[nodiscard]] bool inside(Index planet_cell) const { return window_.inside(planet_cell); }

  [[nodiscard]] bool on_lake(Index planet_cell) const {
    return !water_.lake_id.empty() && water_.lake_id[planet_cell] > 0;
  }
  /// The lowest place within a quarter of a planet cell of the centre, away from the edge: what the
  /// planet knows is which cell the water goes through, and not where.
  End operator()(Index planet_cell) {
    const auto [found, is_new] = bed_.try_emplace(planet_cell, End{});
    if (is_new) found->second = {lowest(planet_cell), level_m(planet_cell)};
    return found->second;
  }
  /// A quarter of a planet cell in fine cells.
  [[nodiscard]] int reach(Index planet_cell) const {
    const Grid& planet = cells_.planet();
    const int row = planet.row(planet_cell);
    const double cell_m = std::min(planet.spacing_east_m(row), planet.step_north_m());
    return static_cast<int>(0.25 * cell_m / cells_.fine().spacing_east_m(0));
  }
  /// That of the first row.
  [[nodiscard]] int quarter() const { return reach(cells_.planet().cell(0, cells_.first_row())); }
  /// Half of that, as long as it is little of the plane.
  [[nodiscard]] int strip() const {
    const Grid& fine = cells_.fine();
    return std::clamp(quarter() / 2, 1, std::max(1, std::min(fine.nx(), fine.ny()) / 16));
  }

 private:
  /// Of the water there: on a lake, that of the highest place on the way out of it.
  [[nodiscard]] double level_m(Index planet_cell) const {
    float level = std::max(0.0F, water_.elevation_m[planet_cell]);
    if (water_.lake_id.empty()) return level;
    for (Index c = planet_cell; water_.lake_id[c] > 0 && water_.receiver[c] != c;) {
      c = water_.receiver[c];
      level = std::max(level, water_.elevation_m[c]);
    }
    return level;
  }
  [[nodiscard]] Index lowest(Index planet_cell) const {
    const Grid& fine = cells_.fine();
    const auto [x, y] = window_.place(planet_cell);
    const int s = strip();
    const auto clamped = [&](double v, int n) {
      return std::clamp(static_cast<int>(std::floor(v)), s, n - 1 - s);
    };
    const int ci = clamped(x / fine.spacing_east_m(0) + 0.5 * fine.nx(), fine.nx());
    const int cj = clamped(y / fine.step_north_m() + 0.5 * fine.ny(), fine.ny());
    const int r = reach(planet_cell);
    Index best = fine.cell(ci, cj);
    for (int j = std::max(s, cj - r); j <= std::min(fine.ny() - 1 - s, cj + r); ++j) {
      for (int i = std::max(s, ci - r); i <= std::min(fine.nx() - 1 - s, ci + r); ++i) {
        const Index c = fine.cell(i, j);
        if (z_[c] < z_[best]) best = c;
      }
    }
    return best;
  }

  const PlanetCells& cells_;
  const PlanetWater& water_;
  std::span<const float> z_;
  PlanetWindow window_;
  std::map<Index, End> bed_;
};

/// Planet cells whose water passes through the part of it, those downstream first.
std::vector<Index> river_steps(const PlanetCells& cells, const PlanetWater& water,
                               const Beds& beds) {
  std::vector<Index> steps;
  const Index begin = cells.planet().cell(0, cells.first_row());
  for (Index from = begin; from < begin + static_cast<Index>(cells.size()); ++from) {
    const Index to = water.receiver[from];
    if (to != from && (beds.inside(from) || beds.inside(to))) steps.push_back(from);
  }
  std::stable_sort(steps.begin(), steps.end(), [&](Index a, Index b) {
    return water.drainage_area_m2[a] > water.drainage_area_m2[b];
  });
  return steps;
}

/// Noise of unit variance from half a planet cell down to two fine ones, which makes courses wind.
/// All its waves are as strong: a least path over even ground would follow the eight directions of
/// the grid, as a detour by one cell costs more than weaker short waves save.
std::vector<float> winding(const PlanetCells& cells, std::uint64_t seed) {
  DetailLaw law;
  law.wavelength_m = 0.5 * cells.planet().step_north_m();
  const double octaves = std::log2(law.wavelength_m / cells.fine().step_north_m());
  law.octaves = static_cast<int>(std::clamp(octaves, 1.0, 12.0));
  law.gain = 1.0;
  std::vector<float> noise(cells.fine().size());
  unit_detail(cells.fine(), law, seed, "island.detail", noise);
  return noise;
}

/// Courses of a part of the planet while they are traced: the steps of the planet's rivers, one
/// after the other from the sea upwards.
class Tracing {
 public:
  Tracing(const PlanetCells& cells, const PlanetWater& water, const Crossings& crossings,
          std::span<const float> elevation_m, std::span<const float> noise)
      : water_(water),
        crossings_(crossings),
        z_(elevation_m),
        beds_(cells, water, elevation_m),
        network_(cells.fine(), elevation_m, noise, beds_.strip()) {
    for (const auto& [planet_cell, edge_cell] : crossings.rivers) {
      crossing_of_[planet_cell] = edge_cell;
    }
  }

  [[nodiscard]] const Beds& beds() const { return beds_; }

  /// The way of a planet cell's water to its receiver.
  void trace_step(Index from) {
    const Index to = water_.receiver[from];
    const bool starts_inside = beds_.inside(from), ends_inside = beds_.inside(to);
    const auto crossing = crossing_of_.find(from);
    if (starts_inside != ends_inside && crossing == crossing_of_.end()) return;
    const auto at_edge = [&] { return edge(crossing->second); };
    const End source = starts_inside ? beds_(from) : at_edge();
    const End goal = ends_inside ? beds_(to) : at_edge();
    // One that begins at the edge where another ends, or in the sea, has nowhere to go.
    if (network_.place(source.cell) != Network::kNone || z_[source.cell] < 0.0F) return;
    const auto joins = [&](std::int32_t place) { return goal_of_[place] == to; };
    // Clear of other rivers, if need be on a long way round.
    const int near = std::max(2, 2 * beds_.reach(from));
    const auto clear = [&](int margin) {
      return network_.connect(source, goal, margin, joins, /*may_touch=*/false);
    };
    if (!clear(near) && !clear(3 * near)) {
      network_.connect(source, goal, near, joins, /*may_touch=*/true);
    }
    goal_of_.resize(network_.size(), to);
    on_lake_.resize(network_.size(), beds_.on_lake(from) && beds_.on_lake(to) ? 1 : 0);
  }
  /// What enters beside the rivers, down to where one goes on.
  void trace_brooks() {
    for (const auto& [cell, edge_cell] : crossings_.brooks) {
      const End goal = beds_(cell);
      // Where nothing goes on there is no river to go to.
      if (network_.place(edge_cell) != Network::kNone ||
          network_.place(goal.cell) == Network::kNone) {
        continue;
      }
      const auto joins = [&](std::int32_t /*place*/) { return true; };
      network_.connect(edge(edge_cell), goal, std::max(2, 2 * beds_.reach(cell)), joins, true);
      on_lake_.resize(network_.size(), 0);
    }
  }
  /// The courses with how far each may sink below the level that the planet has for it.
  [[nodiscard]] RiverCourses take() {
    RiverCourses courses = network_.take();
    courses.shortcut = std::max(courses.shortcut, 2 * beds_.quarter());
    for (std::size_t k = 0; k < courses.cell.size(); ++k) {
      courses.least_m.push_back(on_lake_[k] != 0 ? courses.level_m[k] : 0.0F);
      // What sank upstream of a lake would drain it.
      if (const std::int32_t next = courses.next[k]; next != kCourseEnds) {
        courses.least_m[k] = std::max(courses.least_m[k], courses.least_m[next]);
      }
    }
    return courses;
  }

 private:
  [[nodiscard]] End edge(Index edge_cell) const {
    return {edge_cell, std::max(0.0, static_cast<double>(z_[edge_cell]))};
  }

  const PlanetWater& water_;
  const Crossings& crossings_;
  std::span<const float> z_;
  Beds beds_;
  Network network_;
  std::map<Index, Index> crossing_of_;
  std::vector<Index> goal_of_;  ///< for each place, the planet cell that its step goes to
  std::vector<std::uint8_t> on_lake_;
};

/// A function of noise, one value per cell.
template <class Function>
std::vector<float> of_noise(std::span<const float> noise, const Function& function) {
  std::vector<float> values(noise.size());
  std::transform(noise.begin(), noise.end(), values.begin(),
                 [&](float n) { return static_cast<float>(function(n)); });
  return values;
}

/// Slope of the ground beside a course.
double side_slope(double noise) {
  constexpr double kSteepest = 0.15, kUneven = 0.8;
  return kSteepest * std::exp(kUneven * std::min(0.0, noise));
}

}  // namespace

RiverCourses trace_river_courses(const PlanetCells& cells, const PlanetWater& water,
                                 const Crossings& crossings, std::uint64_t seed,
                                 std::span<const float> elevation_m) {
  check_sizes("trace_river_courses", cells.planet(), water);
  check_sizes("trace_river_courses", cells.fine().size(), {{"elevation_m", elevation_m.size()}});
  const std::vector<float> noise = winding(cells, seed);
  Tracing tracing(cells, water, crossings, elevation_m, noise);
  for (const Index from : river_steps(cells, water, tracing.beds())) tracing.trace_step(from);
  tracing.trace_brooks();
  RiverCourses courses = tracing.take();
  courses.side_slope = of_noise(noise, side_slope);
  courses.toughness = of_noise(noise, toughness);
  return courses;
}

}  // namespace geo
