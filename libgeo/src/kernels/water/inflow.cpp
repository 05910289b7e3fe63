#include "geo/kernels/water/inflow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "planet_window.hpp"

namespace geo {
namespace {

/// Lowest land cell of a stretch that no river has taken, kNoCell when there is none.
Index lowest_land(const Stretch& stretch, std::span<const float> z,
                  std::span<const std::uint8_t> taken) {
  Index lowest = kNoCell;
  for (int k = 0; k < stretch.count; ++k) {
    const Index cell = stretch.first + k * stretch.step;
    if (taken[cell] != 0) continue;
    if (z[cell] >= 0.0F && (lowest == kNoCell || z[cell] < z[lowest])) lowest = cell;
  }
  return lowest;
}

/// Discharge out of planet cells, also on lakes. A lake shows on all its cells what leaves it, of
/// rivers that come in at its very sill as well: each of its cells passes on the rivers that have
/// come in above it, less what the lake loses of them.
class Discharge {
 public:
  Discharge(const PlanetCells& cells, const PlanetWater& water) : water_(water) {
    if (water.lake_id.empty()) return;
    const auto begin = static_cast<Index>(cells.first_row()) * cells.planet().nx();
    const Index end = begin + static_cast<Index>(cells.size());
    for (Index c = begin; c < end; ++c) {
      if (lake_of(c) > 0) lakes_[lake_of(c)].leaves_m3_s = water.discharge_m3_s[c];
    }
    // Lakes reach farther than the cells that are covered.
    std::map<Index, std::int32_t> lake_of_sill;
    for (Index c = 0; c < cells.planet().size(); ++c) {
      const std::int32_t from = lake_of(c), to = lake_of(water.receiver[c]);
      if (to == from) continue;
      if (lakes_.contains(from)) lake_of_sill[water.receiver[c]] = from;
      if (lakes_.contains(to)) pass_on(to, water.receiver[c], water.discharge_m3_s[c]);
    }
    if (lake_of_sill.empty()) return;
    for (Index c = 0; c < cells.planet().size(); ++c) {
      const auto sill = lake_of_sill.find(water.receiver[c]);
      if (sill == lake_of_sill.end() || lake_of(c) == sill->second) continue;
      lakes_[sill->second].comes_in_at_sill_m3_s += water.discharge_m3_s[c];
    }
  }
  [[nodiscard]] double operator()(Index cell) const {
    if (lake_of(cell) <= 0) return water_.discharge_m3_s[cell];
    const auto passes = passes_m3_s_.find(cell);
    if (passes == passes_m3_s_.end()) return 0.0;
    const Balance& lake = lakes_.at(lake_of(cell));
    const double own = std::max(0.0, lake.leaves_m3_s - lake.comes_in_at_sill_m3_s);
    return passes->second * std::min(1.0, own / lake.comes_in_m3_s);
  }

 private:
  struct Balance {
    double comes_in_m3_s = 0.0, comes_in_at_sill_m3_s = 0.0, leaves_m3_s = 0.0;
  };
  [[nodiscard]] std::int32_t lake_of(Index cell) const {
    return water_.lake_id.empty() ? 0 : water_.lake_id[cell];
  }
  /// A river that comes into a lake at a cell, on its way to the sill.
  void pass_on(std::int32_t lake, Index at, double river_m3_s) {
    lakes_[lake].comes_in_m3_s += river_m3_s;
    for (; lake_of(at) == lake; at = water_.receiver[at]) {
      passes_m3_s_[at] += river_m3_s;
      if (water_.receiver[at] == at) break;
    }
  }

  const PlanetWater& water_;
  std::map<std::int32_t, Balance> lakes_;
  std::map<Index, double> passes_m3_s_;
};

/// How much of each covered cell of the planet lies within the plane.
std::vector<double> areas_inside(const PlanetCells& cells) {
  std::vector<double> area_m2(cells.size());
  const Index first = cells.planet().cell(0, cells.first_row());
  for (const Index cell : cells.cell_of()) area_m2[cell - first] += cells.fine().area_m2(0);
  return area_m2;
}

/// Land on the edge of the plane in each covered cell of the planet.
std::map<Index, std::vector<Index>> land_edges(const PlanetCells& cells, std::span<const float> z) {
  const Grid& fine = cells.fine();
  std::map<Index, std::vector<Index>> edge;
  for (Index c = 0; c < fine.size(); ++c) {
    if (z[c] >= 0.0F && fine.is_open_edge(fine.column(c), fine.row(c))) {
      edge[cells.cell_of()[c]].push_back(c);
    }
  }
  return edge;
}

bool falls_inward(const Grid& fine, Index edge_cell, std::span<const float> z) {
  for (int k = 0; k < kDirections; ++k) {
    const Index next = fine.neighbour(edge_cell, k);
    if (next == kNoCell || fine.is_open_edge(fine.column(next), fine.row(next))) continue;
    if (z[next] < z[edge_cell]) return true;
  }
  return false;
}

/// Of some edge cells that fall inward and where nothing leaves, the lowest that is not below a
/// level, or else the highest; kNoCell if there is none.
Index lowest_inward(const Grid& fine, std::span<const Index> edge, std::span<const float> z,
                    std::span<const std::uint8_t> leaves, float level_m) {
  Index best = kNoCell;
  for (const Index c : edge) {
    if (leaves[c] != 0 || !falls_inward(fine, c, z)) continue;
    const bool high = z[c] >= level_m;
    if (best == kNoCell || (z[best] < level_m ? z[c] > z[best] : high && z[c] < z[best])) best = c;
  }
  return best;
}

/// A step of the planet's water over the edge.
struct Passage {
  Index from, to;
  bool outward;
};

/// All of them, the largest first.
std::vector<Passage> find_passages(const PlanetCells& cells, const PlanetWater& water,
                                   const PlanetWindow& window) {
  const Grid& planet = cells.planet();
  std::vector<Passage> passages;
  const Index begin = planet.cell(0, cells.first_row());
  for (Index from = begin; from < begin + static_cast<Index>(cells.size()); ++from) {
    const Index to = water.receiver[from];
    const bool outward = window.inside(from);
    if (outward == window.inside(to)) continue;
    passages.push_back({from, to, outward});
  }
  std::stable_sort(passages.begin(), passages.end(), [&](const Passage& a, const Passage& b) {
    return water.drainage_area_m2[a.from] > water.drainage_area_m2[b.from];
  });
  return passages;
}

/// What enters a part of the planet, and where, while it is found.
class Inflow {
 public:
  Inflow(const PlanetCells& cells, const PlanetWater& water, std::span<float> elevation_m,
         std::span<double> inflow_area_m2, std::span<float> inflow_m3_s)
      : cells_(cells),
        planet_(cells.planet()),
        water_(water),
        z_(elevation_m),
        area_m2_(inflow_area_m2),
        inflow_m3_s_(inflow_m3_s),
        window_(cells, water.receiver),
        discharge_(cells, water),
        inside_m2_(areas_inside(cells)),
        taken_(elevation_m.size()),
        leaves_(elevation_m.size()) {
    std::fill(area_m2_.begin(), area_m2_.end(), 0.0);
    std::fill(inflow_m3_s_.begin(), inflow_m3_s_.end(), 0.0F);
  }

  /// Rivers that cross the edge, where it is lowest near the place where they do on the planet.
  void let_rivers_cross() {
    for (const Passage& passage : find_passages(cells_, water_, window_)) cross(passage);
  }
  /// What planet cells on the edge shed outside flows in with their river, or beside it.
  void let_edges_shed() {
    for (const auto& [cell, edge] : land_edges(cells_, z_)) {
      if (!window_.inside(cell) || water_.elevation_m[cell] < 0.0F) continue;
      const auto river = entry_of_.find(cell);
      const Index entry = river != entry_of_.end() ? river->second
                                                   : lowest_inward(cells_.fine(), edge, z_, leaves_,
                                                                   water_.elevation_m[cell]);
      if (entry == kNoCell) continue;
      enter(entry, cell, outside_m2(cell));
      if (river == entry_of_.end()) crossings_.brooks.push_back({cell, entry});
    }
  }
  [[nodiscard]] Crossings take() { return std::move(crossings_); }

 private:
  void cross(const Passage& passage) {
    const auto& [from, to, outward] = passage;
    const Stretch stretch = stretch_of(passage);
    const Index lowest = lowest_land(stretch, z_, taken_);
    if (lowest == kNoCell) {  // straight into the sea, or out of it
      if (outward) crossings_.rivers.push_back({from, stretch.middle()});
      return;
    }
    const double way = outward ? 1.0 - stretch.share : stretch.share;
    const double level_m = std::lerp(std::max(water_.elevation_m[from], 0.0F),
                                     std::max(water_.elevation_m[to], 0.0F), way);
    z_[lowest] = std::min(z_[lowest], static_cast<float>(level_m));
    crossings_.rivers.push_back({from, lowest});
    taken_[lowest] = 1;
    if (outward) {
      leaves_[lowest] = 1;
      return;
    }
    const double own_inside = planet_.area_m2(planet_.row(from)) - outside_m2(from);
    entry_of_.try_emplace(to, lowest);
    enter(lowest, from, water_.drainage_area_m2[from] - own_inside);
  }
  [[nodiscard]] Stretch stretch_of(const Passage& passage) const {
    const int row = planet_.row(passage.from);
    const double reach_m = 0.5 * std::min(planet_.spacing_east_m(row), planet_.face_east_m(row));
    const auto start = window_.place(passage.from), end = window_.place(passage.to);
    return passage.outward ? window_.frame().crossing(end, start, reach_m)
                           : window_.frame().crossing(start, end, reach_m);
  }
  void enter(Index edge_cell, Index planet_cell, double area_m2) {
    area_m2_[edge_cell] += area_m2;
    inflow_m3_s_[edge_cell] += static_cast<float>(area_m2 / water_.drainage_area_m2[planet_cell] *
                                                  discharge_(planet_cell));
  }
  [[nodiscard]] double outside_m2(Index cell) const {
    const double inside = inside_m2_[cells_.at(planet_.column(cell), planet_.row(cell))];
    return std::max(0.0, planet_.area_m2(planet_.row(cell)) - inside);
  }

  const PlanetCells& cells_;
  const Grid& planet_;
  const PlanetWater& water_;
  std::span<float> z_;
  std::span<double> area_m2_;
  std::span<float> inflow_m3_s_;
  PlanetWindow window_;
  Discharge discharge_;
  std::vector<double> inside_m2_;
  std::vector<std::uint8_t> taken_, leaves_;
  std::map<Index, Index> entry_of_;
  Crossings crossings_;
};

}  // namespace

void check_sizes(std::string_view kernel, const Grid& planet, const PlanetWater& water) {
  check_sizes(kernel, planet.size(),
              {{"elevation_m", water.elevation_m.size()},
               {"receiver", water.receiver.size()},
               {"drainage_area_m2", water.drainage_area_m2.size()},
               {"discharge_m3_s", water.discharge_m3_s.size()},
               {"lake_id", water.lake_id.size(), ArraySize::May::be_empty}});
}

Crossings find_inflow(const PlanetCells& cells, const PlanetWater& water,
                      std::span<float> elevation_m, std::span<double> inflow_area_m2,
                      std::span<float> inflow_m3_s) {
  check_sizes("find_inflow", cells.planet(), water);
  check_sizes("find_inflow", cells.fine().size(),
              {{"elevation_m", elevation_m.size()},
               {"inflow_area_m2", inflow_area_m2.size()},
               {"inflow_m3_s", inflow_m3_s.size()}});
  Inflow inflow(cells, water, elevation_m, inflow_area_m2, inflow_m3_s);
  inflow.let_rivers_cross();
  inflow.let_edges_shed();
  return inflow.take();
}

}  // namespace geo
