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

/// Points on the arcs of great circles between places, not more than a degree apart.
std::vector<Centre> arcs(const std::vector<Centre>& path) {
  std::vector<Centre> line{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vector3 from = unit_vector_of(path[i - 1]), to = unit_vector_of(path[i]);
    const double angle = angle_between(from, to);
    const Vector3 axis = normalised(cross(from, to));
    const int steps = std::max(1, static_cast<int>(std::ceil(angle / kRadians)));
    for (int step = 1; step <= steps; ++step) {
      line.push_back(place_of(rotated(from, scaled(axis, angle * step / steps))));
    }
  }
  return line;
}

std::vector<Centre> circle(const Centre& centre, double radius) {
  constexpr int kSides = 90;
  const Vector3 middle = unit_vector_of(centre);
  const Vector3 aside = normalised(
      cross(middle, std::abs(middle[2]) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0}));
  const Vector3 first = rotated(middle, scaled(aside, radius));
  std::vector<Centre> line;
  for (int side = 0; side <= kSides; ++side) {
    line.push_back(
        place_of(rotated(first, scaled(middle, 2.0 * std::numbers::pi * side / kSides))));
  }
  return line;
}

/// Lines, and the path that stands, with a pale edge, to be seen on any ground.
void stroke(MapCanvas& canvas, const PageLines& lines, double width) {
  cairo_t* pen = canvas.pen();
  for (const auto& line : lines) {
    cairo_new_sub_path(pen);
    for (const PagePoint& point : line) cairo_line_to(pen, point.x, point.y);
  }
  canvas.colour({1, 1, 1}, 0.65);
  cairo_set_line_width(pen, width + 2.2 * canvas.unit());
  cairo_stroke_preserve(pen);
  canvas.colour(kMark);
  cairo_set_line_width(pen, width);
  cairo_stroke(pen);
}

void label(MapCanvas& canvas, PagePoint at, double offset, const std::string& name) {
  if (name.empty()) return;
  canvas.font(17 * canvas.unit(), true);
  const bool left = at.x + offset + canvas.text_width(name) > canvas.layout().map_width;
  canvas.text_on_map(left ? at.x - offset : at.x + offset, at.y + 6 * canvas.unit(), name,
                     left ? Align::right : Align::left, kMark);
}

void draw_path(MapCanvas& canvas, const MapPage::Projector& projector, const EventMark& mark) {
  const double unit = canvas.unit();
  const double dashes[] = {9 * unit, 7 * unit};
  cairo_set_dash(canvas.pen(), dashes, 2, 0.0);
  stroke(canvas, projector.line_through(arcs(mark.path)), 1.8 * unit);
  cairo_set_dash(canvas.pen(), nullptr, 0, 0.0);
  if (const auto at = projector.point_of(mark.path.front()))
    label(canvas, *at, 9 * unit, mark.name);
}

void draw_crater(MapCanvas& canvas, const MapFrame& frame, const MapPage::Projector& projector,
                 const EventMark& mark) {
  const auto at = projector.point_of(mark.place);
  if (!at) return;
  const Grid& grid = frame.grid();
  const double unit = canvas.unit(), radius_px = 1e3 * mark.radius_km / frame.pixel_m();
  const double drawn_px = std::max(radius_px, 7 * unit);
  if (radius_px == drawn_px && grid.is_latitude_longitude()) {
    stroke(
        canvas,
        projector.line_through(circle(mark.place, 1e3 * mark.radius_km / grid.figure().radius_m)),
        1.8 * unit);
  } else {
    cairo_arc(canvas.pen(), at->x, at->y, drawn_px, 0.0, 2.0 * std::numbers::pi);
    stroke(canvas, {}, 1.8 * unit);
  }
  label(canvas, *at, drawn_px + 6 * unit, mark.name);
}

}  // namespace

void draw_events(MapCanvas& canvas, const MapFrame& frame, std::span<const EventMark> marks) {
  if (marks.empty() || !frame.grid().is_geographic()) return;
  const MapPage::Projector projector(frame.page());
  canvas.inside([&] {
    for (const EventMark& mark : marks) {
      if (mark.path.empty()) {
        draw_crater(canvas, frame, projector, mark);
      } else {
        draw_path(canvas, projector, mark);
      }
    }
  });
}

}  // namespace geo::io
