#include "map_wind.hpp"

#include <algorithm>
#include <cmath>

namespace geo::io {
namespace {

constexpr double kSpacingPx = 38.0;
constexpr double kStepPx = 1.5;

struct Point {
  double x, y;
};

class Arrows {
 public:
  Arrows(const WindRasters& wind, bool wraps_east) : wind_(wind), wraps_east_(wraps_east) {}

  // The way of the air through a point, as long as its speed there asks for.
  [[nodiscard]] std::vector<Point> path(Point start, double length_px) const {
    auto back = walk(start, 0.5 * length_px, -1.0);
    std::reverse(back.begin(), back.end());
    const auto on = walk(start, 0.5 * length_px, 1.0);
    back.insert(back.end(), on.begin() + 1, on.end());
    return back;
  }

  [[nodiscard]] float speed(Point at) const { return value(wind_.speed, at); }

 private:
  [[nodiscard]] float value(const Raster& raster, Point at) const {
    int x = static_cast<int>(std::floor(at.x));
    x = wraps_east_ ? (x % raster.width + raster.width) % raster.width
                    : std::clamp(x, 0, raster.width - 1);
    const int y = std::clamp(static_cast<int>(std::floor(at.y)), 0, raster.height - 1);
    return raster.at(x, y);
  }

  [[nodiscard]] std::vector<Point> walk(Point at, double length_px, double sense) const {
    std::vector<Point> way{at};
    for (double gone = 0.0; gone < length_px; gone += kStepPx) {
      const double right = value(wind_.right, at), down = value(wind_.down, at);
      const double norm = std::hypot(right, down);
      if (!(norm > 1e-6)) break;
      at.x += sense * kStepPx * right / norm;
      at.y += sense * kStepPx * down / norm;
      if (at.y < 0 || at.y > wind_.speed.height) break;
      way.push_back(at);
    }
    return way;
  }

  const WindRasters& wind_;
  bool wraps_east_;
};

void draw_arrow(MapCanvas& canvas, const std::vector<Point>& way, double shift_px) {
  cairo_t* pen = canvas.pen();
  const double head = 5.5 * canvas.unit();
  const Point tip = way.back();
  const Point before = way[way.size() > 4 ? way.size() - 4 : 0];
  const double norm = std::max(std::hypot(tip.x - before.x, tip.y - before.y), 1e-9);
  const double ux = (tip.x - before.x) / norm, uy = (tip.y - before.y) / norm;
  cairo_set_line_width(pen, 1.3 * canvas.unit());
  for (const auto& point : way) cairo_line_to(pen, point.x + shift_px, point.y);
  cairo_stroke(pen);
  cairo_move_to(pen, tip.x + shift_px + ux * head, tip.y + uy * head);
  cairo_line_to(pen, tip.x + shift_px - uy * head * 0.5, tip.y + ux * head * 0.5);
  cairo_line_to(pen, tip.x + shift_px + uy * head * 0.5, tip.y - ux * head * 0.5);
  cairo_close_path(pen);
  cairo_fill(pen);
}

float high_speed(const Raster& speed) {
  std::vector<float> some;
  for (std::size_t i = 0; i < speed.values.size(); i += 97) {
    if (speed.values[i] == speed.values[i]) some.push_back(speed.values[i]);
  }
  const auto at = some.begin() + static_cast<std::ptrdiff_t>(some.size() * 95 / 100);
  std::nth_element(some.begin(), at, some.end());
  return std::max(*at, 1e-3F);
}

}  // namespace

WindRasters sample_wind(const MapFrame& frame, const State& state) {
  const auto sampled = [&](const Field<float>& component) {
    const auto values = state.read(component);
    // Air that is not there moves nothing.
    return sample_mean(frame, Filter::linear,
                       [&](Index i) { return values[i] == values[i] ? values[i] : 0.0F; });
  };
  WindRasters wind{sampled(field::wind_east), sampled(field::wind_north), Raster(frame)};
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const float east = wind.right.at(x, y), north = wind.down.at(x, y);
      wind.speed.at(x, y) = std::sqrt(east * east + north * north);
      if (!frame.shows(x, y)) continue;
      const PagePoint way = frame.on_page(x, y, east, north);
      wind.right.at(x, y) = static_cast<float>(way.x);
      wind.down.at(x, y) = static_cast<float>(way.y);
    }
  }
  return wind;
}

void draw_wind_arrows(MapCanvas& canvas, const WindRasters& wind, bool wraps_east) {
  const Arrows arrows(wind, wraps_east);
  const double width = wind.speed.width, height = wind.speed.height;
  const int columns =
      std::max(2, static_cast<int>(std::lround(width / (kSpacingPx * canvas.unit()))));
  const double spacing = width / columns;
  const float fast = high_speed(wind.speed);
  canvas.inside([&] {
    canvas.colour(kInk, 0.85);
    cairo_set_line_cap(canvas.pen(), CAIRO_LINE_CAP_ROUND);
    int row = 0;
    for (double y = 0.5 * spacing; y < height; y += 0.866 * spacing, ++row) {
      for (int i = 0; i < columns; ++i) {
        const Point start{(i + (row % 2 == 0 ? 0.25 : 0.75)) * spacing, y};
        const float relative = std::min(arrows.speed(start) / fast, 1.2F);
        if (!(relative >= 0.05F)) continue;
        const auto way = arrows.path(start, (0.15 + 0.85 * relative) * spacing);
        draw_arrow(canvas, way, 0.0);
        if (wraps_east && start.x < spacing) draw_arrow(canvas, way, width);
        if (wraps_east && start.x > width - spacing) draw_arrow(canvas, way, -width);
      }
    }
  });
}

}  // namespace geo::io
