#include "geo/kernels/plates/region_borders.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/place.hpp"

namespace geo {
namespace {

constexpr std::int32_t kNone = -1;

/// The sides between cells of different labels. A side runs along one of four ways from one corner
/// of cells to the next: along a meridian to the north, or along a parallel to the east; each is
/// gone along forwards or backwards. Corners of the lowest and the highest row are the poles, one
/// corner each.
class Sides {
 public:
  Sides(const Grid& grid, std::span<const std::int32_t> label, const BorderShare& share)
      : grid_(grid), label_(label), nx_(grid.nx()), ny_(grid.ny()) {
    const std::size_t cells = label.size();
    point_.assign(2 * cells, kNone);
    for (int j = 0; j < ny_; ++j) {
      for (int i = 0; i < nx_; ++i) {
        const Index own = grid.cell(i, j), east = grid.cell((i + 1) % nx_, j);
        add(2 * own, own, east, share);
        if (j + 1 < ny_) add(2 * own + 1, grid.cell(i, j + 1), own, share);
      }
    }
    corners();
  }

  /// A side and whether it is gone along backwards.
  struct Way {
    std::int32_t side;
    bool back;
    [[nodiscard]] std::int32_t number() const { return 2 * side + (back ? 1 : 0); }
  };

  [[nodiscard]] std::int32_t ways() const { return 2 * static_cast<std::int32_t>(point_.size()); }
  [[nodiscard]] static Way way(std::int32_t number) { return {number / 2, number % 2 != 0}; }
  [[nodiscard]] bool is_border(std::int32_t side) const { return point_[side] != kNone; }
  [[nodiscard]] Index left(Way w) const { return w.back ? east_of(w.side) : west_of(w.side); }
  [[nodiscard]] Index right(Way w) const { return w.back ? west_of(w.side) : east_of(w.side); }
  [[nodiscard]] std::int32_t label_left(Way w) const { return label_[left(w)]; }
  [[nodiscard]] std::int32_t label_right(Way w) const { return label_[right(w)]; }
  [[nodiscard]] BorderPoint point(Way w) const {
    return {place_[point_[w.side]], left(w), right(w)};
  }

  [[nodiscard]] std::int32_t start(Way w) const { return w.back ? head(w.side) : tail(w.side); }
  [[nodiscard]] std::int32_t end(Way w) const { return w.back ? tail(w.side) : head(w.side); }
  [[nodiscard]] bool meets_others(std::int32_t corner) const { return out_.at(corner).size() != 2; }
  [[nodiscard]] Vector3 corner_place(std::int32_t corner) const {
    const Window& window = grid_.window();
    const double latitude = -90.0 + 180.0 * (corner / nx_) / ny_;
    return unit_vector_of({latitude, window.west_deg + 360.0 * (corner % nx_) / nx_});
  }
  /// Behind a way, round the same region; along a line that meets no other, its next side.
  [[nodiscard]] Way next(Way w) const {
    // Ways from a corner stand in anticlockwise order; the next one clockwise keeps to the left.
    const auto& out = out_.at(end(w));
    const std::int32_t reverse = Way{w.side, !w.back}.number();
    const auto at = std::find(out.begin(), out.end(), reverse) - out.begin();
    const auto count = static_cast<std::ptrdiff_t>(out.size());
    return way(out[(at + count - 1) % count]);
  }

 private:
  // Side 2 c lies between cell c and its eastern neighbour, from south to north; side 2 c + 1
  // between cell c and its northern neighbour, from west to east.
  [[nodiscard]] Index west_of(std::int32_t side) const {
    const Index cell = side / 2;
    return side % 2 == 0 ? cell : cell + nx_;
  }
  [[nodiscard]] Index east_of(std::int32_t side) const {
    const Index cell = side / 2;
    if (side % 2 != 0) return cell;
    return grid_.cell((grid_.column(cell) + 1) % nx_, grid_.row(cell));
  }
  [[nodiscard]] std::int32_t corner(int column, int row) const {
    const bool is_pole = row == 0 || row == ny_;
    return row * nx_ + (is_pole ? 0 : column % nx_);
  }
  [[nodiscard]] std::int32_t tail(std::int32_t side) const {
    const int i = grid_.column(side / 2), j = grid_.row(side / 2);
    return side % 2 == 0 ? corner(i + 1, j) : corner(i, j + 1);
  }
  [[nodiscard]] std::int32_t head(std::int32_t side) const {
    const int i = grid_.column(side / 2), j = grid_.row(side / 2);
    return corner(i + 1, j + 1);
  }

  void add(std::int32_t side, Index first, Index second, const BorderShare& share) {
    if (label_[first] == label_[second]) return;
    const auto middle = [&](Index cell) {
      return unit_vector_of(grid_.position(grid_.column(cell), grid_.row(cell)));
    };
    const double along = share(first, second);
    point_[side] = static_cast<std::int32_t>(place_.size());
    place_.push_back(
        normalised(geo::add(scaled(middle(first), 1.0 - along), middle(second), along)));
  }

  /// The ways that lead from each corner, anticlockwise as seen from above the planet.
  void corners() {
    std::map<std::int32_t, std::vector<std::pair<double, std::int32_t>>> found;
    for (std::int32_t side = 0; side < static_cast<std::int32_t>(point_.size()); ++side) {
      if (!is_border(side)) continue;
      for (const bool back : {false, true}) {
        const Way w{side, back};
        found[start(w)].emplace_back(bearing(w), w.number());
      }
    }
    for (auto& [corner, ways] : found) {
      std::sort(ways.begin(), ways.end());
      for (const auto& [bearing, number] : ways) out_[corner].push_back(number);
    }
  }
  /// By which ways from one corner are ordered: east, north, west and south; from a pole by
  /// longitude, which runs clockwise there as seen from above the south pole.
  [[nodiscard]] double bearing(Way w) const {
    const std::int32_t from = start(w);
    if (from / nx_ == 0) return -static_cast<double>(grid_.column(w.side / 2));
    if (from / nx_ == ny_) return grid_.column(w.side / 2);
    const double forwards = w.side % 2 == 0 ? 1.0 : 0.0;
    return forwards + (w.back ? 2.0 : 0.0);
  }

  const Grid& grid_;
  std::span<const std::int32_t> label_;
  int nx_, ny_;
  std::vector<std::int32_t> point_;  // of each side, or kNone where labels are equal
  std::vector<Vector3> place_;
  std::map<std::int32_t, std::vector<std::int32_t>> out_;
};

/// From where a line meets others, or from anywhere on a closed one, to its end.
BorderLine line_from(const Sides& sides, Sides::Way way, std::vector<std::uint8_t>& is_done) {
  BorderLine line{sides.label_left(way), sides.label_right(way), {}};
  const std::int32_t start = sides.start(way);
  const auto add_corner = [&](std::int32_t corner) {
    if (sides.meets_others(corner)) line.points.push_back({sides.corner_place(corner)});
  };
  add_corner(start);
  for (;;) {
    is_done[way.side] = 1;
    line.points.push_back(sides.point(way));
    const std::int32_t end = sides.end(way);
    if (sides.meets_others(end)) {
      add_corner(end);
      return line;
    }
    way = sides.next(way);
    if (is_done[way.side] == 0) continue;
    line.points.push_back(line.points.front());
    return line;
  }
}

std::vector<BorderLine> lines_of(const Sides& sides) {
  std::vector<BorderLine> lines;
  std::vector<std::uint8_t> is_done(sides.ways() / 2, 0);
  // First those that end where they meet others; what is left is closed.
  for (const bool from_meetings : {true, false}) {
    for (std::int32_t number = 0; number < sides.ways(); ++number) {
      const Sides::Way way = Sides::way(number);
      if (!sides.is_border(way.side) || is_done[way.side] != 0) continue;
      if (from_meetings && !sides.meets_others(sides.start(way))) continue;
      lines.push_back(line_from(sides, way, is_done));
    }
  }
  return lines;
}

/// The connected region of each cell, counted in the order of their first cells.
std::vector<std::int32_t> connected_regions(const Grid& grid, std::span<const std::int32_t> label) {
  std::vector<std::int32_t> region(label.size(), kNone);
  std::vector<Index> waiting;
  std::int32_t count = 0;
  for (Index first = 0; first < grid.size(); ++first) {
    if (region[first] != kNone || label[first] == kNoLabel) continue;
    region[first] = count;
    waiting.push_back(first);
    while (!waiting.empty()) {
      const Index cell = waiting.back();
      waiting.pop_back();
      for (const int k : {kNorth, kEast, kSouth, kWest}) {
        const int row = grid.row(cell);
        // Cells beside a pole touch the ones across in a corner only.
        if ((k == kNorth && row + 1 == grid.ny()) || (k == kSouth && row == 0)) continue;
        const Index next = grid.neighbour(cell, k);
        if (region[next] != kNone || label[next] != label[first]) continue;
        region[next] = count;
        waiting.push_back(next);
      }
    }
    ++count;
  }
  return region;
}

std::vector<BorderedRegion> regions_of(const Sides& sides, const Grid& grid,
                                       std::span<const std::int32_t> label) {
  const std::vector<std::int32_t> region = connected_regions(grid, label);
  std::map<std::int32_t, std::vector<std::vector<Vector3>>> rings;
  std::vector<std::uint8_t> is_done(sides.ways(), 0);
  for (std::int32_t number = 0; number < sides.ways(); ++number) {
    const Sides::Way first = Sides::way(number);
    if (!sides.is_border(first.side) || is_done[number] != 0) continue;
    if (sides.label_left(first) == kNoLabel) continue;
    auto& ring = rings[region[sides.left(first)]].emplace_back();
    for (Sides::Way way = first; is_done[way.number()] == 0; way = sides.next(way)) {
      is_done[way.number()] = 1;
      ring.push_back(sides.point(way).place);
      if (sides.meets_others(sides.end(way))) ring.push_back(sides.corner_place(sides.end(way)));
    }
    ring.push_back(ring.front());
  }
  std::vector<BorderedRegion> regions;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const auto found = rings.find(region[cell]);
    if (found == rings.end()) continue;
    BorderedRegion& bordered = regions.emplace_back();
    bordered.label = label[cell];
    auto& all = found->second;
    const auto outside = std::min_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
      return area_to_the_left_sr(a) < area_to_the_left_sr(b);
    });
    std::iter_swap(all.begin(), outside);
    bordered.outside = std::move(all.front());
    bordered.holes.assign(std::make_move_iterator(all.begin() + 1),
                          std::make_move_iterator(all.end()));
    rings.erase(found);
  }
  return regions;
}

}  // namespace

RegionBorders::RegionBorders(const Grid& grid, std::span<const std::int32_t> label,
                             const BorderShare& share) {
  check_sizes("region borders", static_cast<std::size_t>(grid.size()), {{"label", label.size()}});
  if (grid.topology() != Topology::sphere) throw Bug("region borders: the grid must be a sphere");
  const Sides sides(grid, label, share);
  lines_ = lines_of(sides);
  regions_ = regions_of(sides, grid, label);
}

double area_to_the_left_sr(std::span<const Vector3> ring) {
  // Triangles with a place beside the line, each signed (Oosterom & Strackee 1983).
  if (ring.size() < 4) return 0.0;
  Vector3 sum{};
  for (const Vector3& at : ring) sum = add(sum, at);
  const Vector3 apex = length(sum) > 1e-9 ? normalised(sum) : Vector3{0.0, 0.0, 1.0};
  double area = 0.0;
  for (std::size_t k = 1; k < ring.size(); ++k) {
    const Vector3 &a = ring[k - 1], &b = ring[k];
    area += 2.0 * std::atan2(dot(apex, cross(a, b)), 1.0 + dot(apex, a) + dot(a, b) + dot(b, apex));
  }
  constexpr double kSphere = 4.0 * std::numbers::pi;
  return area < 0.0 ? area + kSphere : area;
}

}  // namespace geo
