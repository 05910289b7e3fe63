#include "geo/kernels/plates/region_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace geo {
namespace {

constexpr double kCircle = 360.0, kPole = 90.0, kRadians = std::numbers::pi / 180.0;

int band_of(double latitude_deg) {
  return std::clamp(static_cast<int>(std::floor(latitude_deg + kPole)), 0, 179);
}

/// Degrees of longitude that the edge from b to c goes, a the place before.
double longitude_step(const Centre& a, const Centre& b, const Centre& c) {
  const double straight = c.longitude_deg - b.longitude_deg;
  if (std::abs(straight) <= 0.5 * kCircle) return straight;
  const bool along_map = std::abs(straight) == kCircle &&
                         (std::abs(b.latitude_deg) == kPole ||
                          (a.longitude_deg == b.longitude_deg && a.latitude_deg != b.latitude_deg));
  return along_map ? straight : std::remainder(straight, kCircle);
}

/// A closed line with its first place not repeated, longitudes without jumps. As many places as it
/// has, and its first one again where the line ends.
std::vector<Centre> unrolled(const std::vector<Centre>& ring) {
  std::vector<Centre> corner = ring;
  if (corner.size() > 1 && corner.front().latitude_deg == corner.back().latitude_deg &&
      corner.front().longitude_deg == corner.back().longitude_deg) {
    corner.pop_back();
  }
  const std::size_t n = corner.size();
  if (n < 3) return {};
  std::vector<Centre> line{
      {corner[0].latitude_deg, std::remainder(corner[0].longitude_deg, kCircle)}};
  for (std::size_t k = 0; k < n; ++k) {
    const Centre& to = corner[(k + 1) % n];
    const double step = longitude_step(corner[(k + n - 1) % n], corner[k], to);
    line.push_back({to.latitude_deg, line.back().longitude_deg + step});
  }
  return line;
}

/// Twice the area of the triangle a, b, c: above 0 where it turns to the left.
double turn(const Centre& a, const Centre& b, const Centre& c) {
  return (b.longitude_deg - a.longitude_deg) * (c.latitude_deg - a.latitude_deg) -
         (b.latitude_deg - a.latitude_deg) * (c.longitude_deg - a.longitude_deg);
}

bool edges_cross(const Centre& a, const Centre& b, const Centre& c, const Centre& d) {
  return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

/// Area between a line and a place that closes it, square degrees; above 0 where it turns left.
double area_deg2(std::span<const Centre> line, const Centre& from) {
  double twice = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) twice += turn(from, line[k - 1], line[k]);
  return 0.5 * twice;
}

/// The smaller of the two loops of a closed line whose edges behind i and k, i < k, cross.
double smaller_loop_deg2(std::span<const Centre> line, std::size_t i, std::size_t k) {
  const Centre &a = line[i], &b = line[i + 1], &c = line[k], &d = line[k + 1];
  const double along = turn(c, d, a) / (turn(c, d, a) - turn(c, d, b));
  const Centre at{std::lerp(a.latitude_deg, b.latitude_deg, along),
                  std::lerp(a.longitude_deg, b.longitude_deg, along)};
  const double loop = area_deg2(line.subspan(i + 1, k - i), at);
  return std::min(std::abs(loop), std::abs(area_deg2(line, line.front()) - loop));
}

}  // namespace

std::optional<std::pair<std::size_t, std::size_t>> first_crossing(const std::vector<Centre>& ring) {
  constexpr double kRounding_deg2 = 0.1;
  const std::vector<Centre> line = unrolled(ring);
  std::array<std::vector<std::size_t>, 180> edges;  // by degrees of latitude
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const auto [low, high] = std::minmax(line[k].latitude_deg, line[k + 1].latitude_deg);
    for (int band = band_of(low); band <= band_of(high); ++band) {
      for (const std::size_t other : edges[band]) {
        if (edges_cross(line[other], line[other + 1], line[k], line[k + 1]) &&
            smaller_loop_deg2(line, other, k) > kRounding_deg2) {
          return {{other, k}};
        }
      }
      edges[band].push_back(k);
    }
  }
  return {};
}

RegionOutline::RegionOutline(std::span<const std::vector<Centre>> rings) {
  for (const auto& ring : rings) add_ring(ring);
}

void RegionOutline::add_ring(const std::vector<Centre>& ring) {
  const std::vector<Centre> line = unrolled(ring);
  if (line.empty()) return;
  double pole = 0.0, above = 0.0;  // the pole that it touches; integral of the sine of latitude
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Centre &from = line[k], &to = line[k + 1];
    add_edge({from.latitude_deg, from.longitude_deg, to.latitude_deg, to.longitude_deg});
    above += 0.5 * (to.longitude_deg - from.longitude_deg) *
             (std::sin(from.latitude_deg * kRadians) + std::sin(to.latitude_deg * kRadians));
    if (std::abs(from.latitude_deg) == kPole) pole = from.latitude_deg;
  }
  const Centre &first = line.front(), &last = line.back();
  const double round = last.longitude_deg - first.longitude_deg;
  if (std::abs(round) < 0.5 * kCircle) return;
  if (pole == 0.0) pole = above * round > 0.0 ? kPole : -kPole;
  add_edge({first.latitude_deg, last.longitude_deg, pole, last.longitude_deg});
  add_edge({pole, first.longitude_deg, first.latitude_deg, first.longitude_deg});
}

void RegionOutline::add_edge(const Edge& edge) {
  if (edge.from_latitude == edge.to_latitude) return;
  const auto [low, high] = std::minmax(edge.from_latitude, edge.to_latitude);
  for (int band = band_of(low); band <= band_of(high); ++band) edges_[band].push_back(edge);
}

/// Counts the edges east of a place, and of its images a turn and more away.
bool RegionOutline::holds(const Centre& place) const {
  constexpr double kImages = 3.0;  // either way: lines go round once at most
  const double longitude = std::remainder(place.longitude_deg, kCircle);
  long crossings = 0;
  for (const Edge& edge : edges_[band_of(place.latitude_deg)]) {
    if ((edge.from_latitude <= place.latitude_deg) == (edge.to_latitude <= place.latitude_deg)) {
      continue;
    }
    const double along =
        (place.latitude_deg - edge.from_latitude) / (edge.to_latitude - edge.from_latitude);
    const double crossing = std::lerp(edge.from_longitude, edge.to_longitude, along);
    const double images = std::ceil((crossing - longitude) / kCircle) + kImages;
    crossings += std::lround(std::clamp(images, 0.0, 2.0 * kImages + 1.0));
  }
  return crossings % 2 != 0;
}

}  // namespace geo
