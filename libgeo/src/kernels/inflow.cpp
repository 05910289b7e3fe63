#include "geo/kernels/inflow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "geo/core/projection.hpp"

namespace geo {
namespace {

/// A stretch of one side of a plane: cells first + k * step.
struct Stretch {
  Index first = 0;
  Index step = 1;
  int count = 0;
  double share = 0.0;  ///< of the way from outside to inside
};

/// The rectangle of a fine grid on its map.
class Frame {
 public:
  explicit Frame(const Grid& fine)
      : fine_(fine),
        projection_(*fine.centre(), fine.figure()),
        half_width_(0.5 * fine.nx() * fine.spacing_east_m(0)),
        half_height_(0.5 * fine.ny() * fine.step_north_m()) {}

  [[nodiscard]] std::array<double, 2> project(Centre position) const {
    return projection_.project(position);
  }
  [[nodiscard]] bool holds(std::array<double, 2> p) const {
    return std::abs(p[0]) < half_width_ && std::abs(p[1]) < half_height_;
  }
  /// Cells of the side that the way from `outside` to `inside` crosses, within `reach_m` of where.
  [[nodiscard]] Stretch crossing(std::array<double, 2> outside, std::array<double, 2> inside,
                                 double reach_m) const {
    // The last of the sides that the segment crosses on its way in.
    const auto share = [](double from, double to, double half) {
      return std::abs(from) <= half ? 0.0 : (from - std::copysign(half, from)) / (from - to);
    };
    const double across = share(outside[0], inside[0], half_width_);
    const double up = share(outside[1], inside[1], half_height_);
    const double t = std::max(across, up);
    const double x = outside[0] + t * (inside[0] - outside[0]);
    const double y = outside[1] + t * (inside[1] - outside[1]);
    const double dx = fine_.spacing_east_m(0), dy = fine_.step_north_m();
    if (across >= up) {
      const Index column = outside[0] < 0.0 ? 0 : fine_.nx() - 1;
      return along((y + half_height_) / dy, reach_m / dy, fine_.ny(), column, fine_.nx(), t);
    }
    const Index row = outside[1] < 0.0 ? 0 : fine_.ny() - 1;
    return along((x + half_width_) / dx, reach_m / dx, fine_.nx(), row * fine_.nx(), 1, t);
  }

 private:
  static Stretch along(double position, double reach, int cells, Index origin, Index step,
                       double share) {
    const int first = std::clamp(static_cast<int>(std::floor(position - reach)), 0, cells - 1);
    const int last = std::clamp(static_cast<int>(std::floor(position + reach)), 0, cells - 1);
    return {origin + first * step, step, last - first + 1, share};
  }
  const Grid& fine_;
  EqualAreaProjection projection_;
  double half_width_, half_height_;
};

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

}  // namespace

void find_inflow(const PlanetCells& cells, const PlanetWater& water, std::span<float> elevation_m,
                 std::span<double> inflow_area_m2, std::span<float> inflow_m3_s) {
  const Grid& planet = cells.planet();
  const Frame frame(cells.fine());
  const Discharge discharge(cells, water);
  std::fill(inflow_area_m2.begin(), inflow_area_m2.end(), 0.0);
  std::fill(inflow_m3_s.begin(), inflow_m3_s.end(), 0.0F);
  std::map<Index, double> exits;

  const auto place = [&](Index cell) {
    return frame.project(planet.position(planet.column(cell), planet.row(cell)));
  };
  for (int j = cells.first_row(); j < cells.first_row() + cells.rows(); ++j) {
    const double reach_m = 0.5 * std::min(planet.spacing_east_m(j), planet.face_east_m(j));
    for (Index from = planet.cell(0, j); from < planet.cell(0, j) + planet.nx(); ++from) {
      const Index to = water.receiver[from];
      const double area = water.drainage_area_m2[from];
      if (to == from || area < kRiverCells * planet.area_m2(j)) continue;
      const auto start = place(from), end = place(to);
      const bool starts_inside = frame.holds(start);
      if (starts_inside == frame.holds(end)) continue;
      const Stretch stretch =
          starts_inside ? frame.crossing(end, start, reach_m) : frame.crossing(start, end, reach_m);
      const Index lowest = lowest_land(stretch, elevation_m);
      if (lowest == kNoCell) continue;  // straight into the sea
      const double own = planet.area_m2(j);
      const double way = starts_inside ? 1.0 - stretch.share : stretch.share;
      const double level_m = std::lerp(std::max(water.elevation_m[from], 0.0F),
                                       std::max(water.elevation_m[to], 0.0F), way);
      elevation_m[lowest] = std::min(elevation_m[lowest], static_cast<float>(level_m));
      if (starts_inside) {
        exits[lowest] = std::max(exits[lowest], area);
        continue;
      }
      const double q = discharge(from), own_q = q * own / area;
      inflow_area_m2[lowest] += area - own;
      inflow_m3_s[lowest] += static_cast<float>(q - own_q);
      int land = 0;
      for (int k = 0; k < stretch.count; ++k) {
        land += elevation_m[stretch.first + k * stretch.step] >= 0.0F ? 1 : 0;
      }
      for (int k = 0; k < stretch.count; ++k) {
        const Index cell = stretch.first + k * stretch.step;
        if (elevation_m[cell] < 0.0F) continue;
        inflow_area_m2[cell] += own / land;
        inflow_m3_s[cell] += static_cast<float>(own_q / land);
      }
    }
  }
  for (const auto& [cell, area] : exits) {
    if (inflow_area_m2[cell] >= area) continue;
    inflow_area_m2[cell] = 0.0;
    inflow_m3_s[cell] = 0.0F;
  }
}

}  // namespace geo
