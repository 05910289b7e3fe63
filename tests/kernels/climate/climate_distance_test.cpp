#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

std::array<double, 3> unit(double latitude_deg, double longitude_deg) {
  const double lat = latitude_deg * kRadians, lon = longitude_deg * kRadians;
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

/// All coast points by brute force: mid-points of faces between land and sea.
struct Coast {
  std::vector<std::array<double, 2>> points;  // latitude, longitude or y, x
};

Coast coast_of(const Grid& grid, const std::vector<float>& h, bool geographic) {
  Coast coast;
  const auto land = [&](Index c) { return h[c] >= 0.0F; };
  const double half_lat = geographic ? 0.5 * 180.0 / grid.ny() : 0.0;
  const double half_lon = geographic ? 0.5 * 360.0 / grid.nx() : 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      for (const int k : {kNorth, kEast, kSouth, kWest}) {
        const Index to = grid.neighbour(i, j, k);
        if (to == kNoCell || land(grid.cell(i, j)) == land(to)) continue;
        if (geographic) {
          coast.points.push_back({grid.latitude_deg(j) + kRowStep[k] * half_lat,
                                  grid.longitude_deg(i) + kColumnStep[k] * half_lon});
        } else {
          coast.points.push_back({grid.y_m(j) + 0.5 * kRowStep[k] * grid.face_east_m(j),
                                  grid.x_m(i) + 0.5 * kColumnStep[k] * grid.spacing_east_m(j)});
        }
      }
    }
  }
  return coast;
}

std::vector<float> random_relief(const Grid& grid, std::uint64_t seed, double share) {
  const RandomStream random(seed, "relief");
  std::vector<float> h(static_cast<std::size_t>(grid.size()));
  for (Index c = 0; c < grid.size(); ++c) h[c] = random.uniform(c) < share ? 100.0F : -100.0F;
  return h;
}

TEST(DistanceToCoast, MatchesBruteForceOnTheSphere) {
  const Grid grid = Grid::sphere(48, 24);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto h = random_relief(grid, seed, seed % 2 ? 0.01 : 0.3);
    const Coast coast = coast_of(grid, h, true);
    if (coast.points.empty()) continue;
    std::vector<float> distance(h.size());
    distance_to_coast(grid, h, distance);
    for (int j = 0; j < grid.ny(); ++j) {
      for (int i = 0; i < grid.nx(); ++i) {
        const auto here = unit(grid.latitude_deg(j), grid.longitude_deg(i));
        double nearest = 1e30;
        for (const auto& [lat, lon] : coast.points) {
          const auto p = unit(lat, lon);
          const double chord = std::hypot(here[0] - p[0], here[1] - p[1], here[2] - p[2]);
          nearest = std::min(nearest, 2 * 6371000.0 * std::asin(std::min(1.0, 0.5 * chord)));
        }
        ASSERT_NEAR(distance[grid.cell(i, j)], nearest, 2.0)
            << "seed " << seed << " cell " << i << ", " << j;
      }
    }
  }
}

TEST(DistanceToCoast, MatchesBruteForceOnPlaneAndTorus) {
  for (const Grid& grid :
       {Grid::plane(23, 17, 900.0, 1300.0), Grid::torus(20, 14, 900.0, 1300.0)}) {
    const bool torus = grid.topology() == Topology::torus;
    const double width = grid.nx() * 900.0, height = grid.ny() * 1300.0;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      const auto h = random_relief(grid, seed, seed % 2 ? 0.01 : 0.3);
      const Coast coast = coast_of(grid, h, false);
      if (coast.points.empty()) continue;
      std::vector<float> distance(h.size());
      distance_to_coast(grid, h, distance);
      for (int j = 0; j < grid.ny(); ++j) {
        for (int i = 0; i < grid.nx(); ++i) {
          double nearest = 1e30;
          for (const auto& [y, x] : coast.points) {
            double dx = std::abs(x - grid.x_m(i)), dy = std::abs(y - grid.y_m(j));
            if (torus) dx = std::min(dx, width - dx), dy = std::min(dy, height - dy);
            nearest = std::min(nearest, std::hypot(dx, dy));
          }
          ASSERT_NEAR(distance[grid.cell(i, j)], nearest, 0.01)
              << "seed " << seed << " cell " << i << ", " << j;
        }
      }
    }
  }
}

TEST(DistanceToCoast, CircularCapIsExactWithinACell) {
  const Grid grid = Grid::sphere(360, 180);
  // A cap of 20 degrees about a point off the pole, so that circles are not rows.
  const auto centre = unit(70.0, 30.0);
  std::vector<float> h(static_cast<std::size_t>(grid.size())), distance(h.size());
  std::vector<double> angle_deg(h.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const auto p = unit(grid.latitude_deg(grid.row(c)), grid.longitude_deg(grid.column(c)));
    const double dot = p[0] * centre[0] + p[1] * centre[1] + p[2] * centre[2];
    angle_deg[c] = std::acos(std::clamp(dot, -1.0, 1.0)) / kRadians;
    h[c] = angle_deg[c] < 20.0 ? 1.0F : -1.0F;
  }
  distance_to_coast(grid, h, distance);
  const double cell_m = 6371000.0 * kRadians;
  for (Index c = 0; c < grid.size(); ++c) {
    ASSERT_NEAR(distance[c], std::abs(angle_deg[c] - 20.0) * cell_m, cell_m);
  }
}

TEST(DistanceToCoast, WithoutCoastIsHalfTheWayRound) {
  const Grid grid = Grid::sphere(24, 12);
  std::vector<float> distance(static_cast<std::size_t>(grid.size()));
  distance_to_coast(grid, std::vector<float>(distance.size(), -5.0F), distance);
  for (const float d : distance) ASSERT_FLOAT_EQ(d, static_cast<float>(kPi * 6371000.0));
}

}  // namespace
}  // namespace geo
