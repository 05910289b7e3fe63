#include "map_events.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/place.hpp"
#include "geo/core/vector3.hpp"

namespace geo::io {
namespace {

constexpr Rgb kMark{0.70F, 0.07F, 0.13F};
constexpr double kRadians = std::numbers::pi / 180.0;

Centre place_of(const Vector3& at) {
  return {std::asin(std::clamp(at[2], -1.0, 1.0)) / kRadians, std::atan2(at[1], at[0]) / kRadians};
}

struct Point {
  double x, y;
};

/// Places on the map, pixels from its upper left corner.
class Chart {
 public:
  Chart(const Grid& grid, const MapLayout& layout) : grid_(grid), layout_(layout) {}

  [[nodiscard]] Point point_of(const Centre& place) const {
    if (!grid_.is_latitude_longitude()) return point_of_nearest_cell(unit_vector_of(place));
    const Window& window = grid_.window();
    const double width_deg = window.east_deg - window.west_deg;
    const double middle_deg = 0.5 * (window.east_deg + window.west_deg);
    const double east_deg = std::remainder(place.longitude_deg - middle_deg, 360.0);
    return {(0.5 + east_deg / width_deg) * layout_.map_width,
            (window.north_deg - place.latitude_deg) / (window.north_deg - window.south_deg) *
                layout_.map_height};
  }
  /// Moves the pen along a line on the sphere, lifting it where the map ends and begins again.
  void trace(cairo_t* pen, const std::vector<Vector3>& line) const {
    Point last{0.0, 0.0};
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Point next = point_of(place_of(line[i]));
      const bool jumps = std::abs(next.x - last.x) > 0.5 * layout_.map_width;
      if (i == 0 || jumps) {
        cairo_move_to(pen, next.x, next.y);
      } else {
        cairo_line_to(pen, next.x, next.y);
      }
      last = next;
    }
  }
  [[nodiscard]] double metres_per_px() const {
    return grid_.area_m2(grid_.ny() / 2) / grid_.spacing_east_m(grid_.ny() / 2) * grid_.ny() /
           layout_.map_height;
  }

 private:
  [[nodiscard]] Point point_of_nearest_cell(const Vector3& at) const {
    double nearest = 2.0;
    Point point{-1.0, -1.0};
    for (int j = 0; j < grid_.ny(); ++j) {
      for (int i = 0; i < grid_.nx(); ++i) {
        const double apart = length(add(grid_.unit_vector(i, j), at, -1.0));
        if (apart >= nearest) continue;
        nearest = apart;
        point = {(i + 0.5) / grid_.nx() * layout_.map_width,
                 (grid_.ny() - j - 0.5) / grid_.ny() * layout_.map_height};
      }
    }
    return point;
  }
  const Grid& grid_;
  const MapLayout& layout_;
};

/// Points on the arcs of great circles between places, not more than a degree apart.
std::vector<Vector3> arcs(const std::vector<Centre>& path) {
  std::vector<Vector3> line{unit_vector_of(path.front())};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vector3 from = unit_vector_of(path[i - 1]), to = unit_vector_of(path[i]);
    const double angle = angle_between(from, to);
    const Vector3 axis = normalised(cross(from, to));
    const int steps = std::max(1, static_cast<int>(std::ceil(angle / kRadians)));
    for (int step = 1; step <= steps; ++step) {
      line.push_back(rotated(from, scaled(axis, angle * step / steps)));
    }
  }
  return line;
}

std::vector<Vector3> circle(const Centre& centre, double radius) {
  constexpr int kSides = 90;
  const Vector3 middle = unit_vector_of(centre);
  const Vector3 aside = normalised(
      cross(middle, std::abs(middle[2]) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0}));
  const Vector3 first = rotated(middle, scaled(aside, radius));
  std::vector<Vector3> line;
  for (int side = 0; side <= kSides; ++side) {
    line.push_back(rotated(first, scaled(middle, 2.0 * std::numbers::pi * side / kSides)));
  }
  return line;
}

/// Lines and letters with a pale edge, to be seen on any ground.
void stroke(MapCanvas& canvas, double width) {
  cairo_t* pen = canvas.pen();
  canvas.colour({1, 1, 1}, 0.65);
  cairo_set_line_width(pen, width + 2.2 * canvas.unit());
  cairo_stroke_preserve(pen);
  canvas.colour(kMark);
  cairo_set_line_width(pen, width);
  cairo_stroke(pen);
}

void label(MapCanvas& canvas, Point at, double offset, const std::string& name) {
  if (name.empty()) return;
  canvas.font(17 * canvas.unit(), true);
  const double width = canvas.text_width(name);
  const bool left = at.x + offset + width > canvas.layout().map_width;
  cairo_move_to(canvas.pen(), left ? at.x - offset - width : at.x + offset,
                at.y + 6 * canvas.unit());
  cairo_text_path(canvas.pen(), name.c_str());
  canvas.colour({1, 1, 1}, 0.75);
  cairo_set_line_width(canvas.pen(), 3.5 * canvas.unit());
  cairo_stroke_preserve(canvas.pen());
  canvas.colour(kMark);
  cairo_fill(canvas.pen());
}

}  // namespace

void draw_events(MapCanvas& canvas, const Grid& grid, std::span<const EventMark> marks) {
  if (marks.empty() || !grid.is_geographic()) return;
  const Chart chart(grid, canvas.layout());
  const double unit = canvas.unit();
  canvas.inside([&] {
    cairo_t* pen = canvas.pen();
    for (const EventMark& mark : marks) {
      if (!mark.path.empty()) {
        chart.trace(pen, arcs(mark.path));
        const double dashes[] = {9 * unit, 7 * unit};
        cairo_set_dash(pen, dashes, 2, 0.0);
        stroke(canvas, 1.8 * unit);
        cairo_set_dash(pen, nullptr, 0, 0.0);
        label(canvas, chart.point_of(mark.path.front()), 9 * unit, mark.name);
        continue;
      }
      const Point at = chart.point_of(mark.place);
      const double radius_px = 1e3 * mark.radius_km / chart.metres_per_px();
      const double smallest_px = 7 * unit;
      if (radius_px > smallest_px && grid.is_latitude_longitude()) {
        chart.trace(pen, circle(mark.place, 1e3 * mark.radius_km / grid.figure().radius_m));
      } else {
        cairo_arc(pen, at.x, at.y, std::max(radius_px, smallest_px), 0.0, 2.0 * std::numbers::pi);
      }
      stroke(canvas, 1.8 * unit);
      label(canvas, at, std::max(radius_px, smallest_px) + 6 * unit, mark.name);
    }
  });
}

}  // namespace geo::io
