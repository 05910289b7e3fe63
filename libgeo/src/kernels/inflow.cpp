#include "geo/kernels/inflow.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "plane_frame.hpp"

namespace geo {
namespace {

/// Lowest land cell of a stretch, kNoCell when all of it is sea.
Index lowest_land(const Stretch& stretch, std::span<const float> z) {
  Index lowest = kNoCell;
  for (int k = 0; k < stretch.count; ++k) {
    const Index cell = stretch.first + k * stretch.step;
    if (z[cell] >= 0.0F && (lowest == kNoCell || z[cell] < z[lowest])) lowest = cell;
  }
  return lowest;
}

/// Discharge out of planet cells, also on lakes.
class Discharge {
 public:
  Discharge(const PlanetCells& cells, const PlanetWater& water) : water_(water) {
    if (water.lake_id.empty()) return;
    const auto first = static_cast<std::size_t>(cells.first_row()) * cells.planet().nx();
    for (std::size_t c = first; c < first + cells.size(); ++c) {
      if (water.lake_id[c] <= 0) continue;
      double& most = largest_m2_[water.lake_id[c]];
      most = std::max(most, water.drainage_area_m2[c]);
    }
  }
  [[nodiscard]] double operator()(Index cell) const {
    const double q = water_.discharge_m3_s[cell];
    if (water_.lake_id.empty() || water_.lake_id[cell] <= 0) return q;
    return q * water_.drainage_area_m2[cell] / largest_m2_.at(water_.lake_id[cell]);
  }

 private:
  const PlanetWater& water_;
  std::map<std::int32_t, double> largest_m2_;
};

/// How much of each covered cell of the planet lies within the plane.
std::vector<double> areas_inside(const PlanetCells& cells) {
  std::vector<double> area_m2(cells.size());
  const Index first = cells.planet().cell(0, cells.first_row());
  for (const Index cell : cells.cell_of()) area_m2[cell - first] += cells.fine().area_m2(0);
  return area_m2;
}

}  // namespace

std::vector<RiverCrossing> find_inflow(const PlanetCells& cells, const PlanetWater& water,
                                       std::span<float> elevation_m,
                                       std::span<double> inflow_area_m2,
                                       std::span<float> inflow_m3_s) {
  const Grid& planet = cells.planet();
  const PlaneFrame frame(cells.fine());
  const Discharge discharge(cells, water);
  std::fill(inflow_area_m2.begin(), inflow_area_m2.end(), 0.0);
  std::fill(inflow_m3_s.begin(), inflow_m3_s.end(), 0.0F);
  std::map<Index, double> exits;
  std::vector<RiverCrossing> crossings;

  const std::vector<double> inside_m2 = areas_inside(cells);
  const auto share_outside = [&](Index cell) {
    const double inside = inside_m2[cells.at(planet.column(cell), planet.row(cell))];
    return std::max(0.0, 1.0 - inside / planet.area_m2(planet.row(cell)));
  };
  const auto place = [&](Index cell) {
    return frame.project(planet.position(planet.column(cell), planet.row(cell)));
  };
  for (int j = cells.first_row(); j < cells.first_row() + cells.rows(); ++j) {
    const double reach_m = 0.5 * std::min(planet.spacing_east_m(j), planet.face_east_m(j));
    for (Index from = planet.cell(0, j); from < planet.cell(0, j) + planet.nx(); ++from) {
      const Index to = water.receiver[from];
      const double area = water.drainage_area_m2[from];
      if (to == from) continue;
      const auto start = place(from), end = place(to);
      const bool starts_inside = frame.holds(start);
      if (starts_inside == frame.holds(end)) continue;
      const double own = planet.area_m2(j);
      const bool is_river = area >= kRiverCells * own;
      if (starts_inside && !is_river) continue;
      const Stretch stretch =
          starts_inside ? frame.crossing(end, start, reach_m) : frame.crossing(start, end, reach_m);
      const Index lowest = lowest_land(stretch, elevation_m);
      if (lowest == kNoCell) continue;  // straight into the sea
      if (is_river) {
        const double way = starts_inside ? 1.0 - stretch.share : stretch.share;
        const double level_m = std::lerp(std::max(water.elevation_m[from], 0.0F),
                                         std::max(water.elevation_m[to], 0.0F), way);
        elevation_m[lowest] = std::min(elevation_m[lowest], static_cast<float>(level_m));
        crossings.push_back({from, lowest});
      }
      if (starts_inside) {
        exits[lowest] = std::max(exits[lowest], area);
        continue;
      }
      const double m3_s_per_m2 = discharge(from) / area;
      const double upstream = area - own, beside = own * share_outside(from);
      const double gathered = is_river ? upstream : upstream + beside;
      inflow_area_m2[lowest] += gathered;
      inflow_m3_s[lowest] += static_cast<float>(gathered * m3_s_per_m2);
      if (!is_river) continue;
      int land = 0;
      for (int k = 0; k < stretch.count; ++k) {
        land += elevation_m[stretch.first + k * stretch.step] >= 0.0F ? 1 : 0;
      }
      for (int k = 0; k < stretch.count; ++k) {
        const Index cell = stretch.first + k * stretch.step;
        if (elevation_m[cell] < 0.0F) continue;
        inflow_area_m2[cell] += beside / land;
        inflow_m3_s[cell] += static_cast<float>(beside * m3_s_per_m2 / land);
      }
    }
  }
  for (const auto& [cell, area] : exits) {
    if (inflow_area_m2[cell] >= area) continue;
    inflow_area_m2[cell] = 0.0;
    inflow_m3_s[cell] = 0.0F;
  }
  return crossings;
}

}  // namespace geo
