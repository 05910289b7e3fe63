// What stands below a map: its colour bar or the names of its categories.

#include <algorithm>
#include <cmath>

#include "map_canvas.hpp"

namespace geo::io {
namespace {

constexpr double kLegendTop = 48.0;  // below the map, in units of type

}  // namespace

void MapCanvas::colour_bar(std::span<const ColourMap* const> maps, bool classed) {
  int intervals = 0;
  for (const ColourMap* map : maps) intervals += static_cast<int>(map->stops().size()) - 1;
  const double width = (intervals > 18 ? 0.94 : 0.8) * layout_.map_width, height = 26 * unit_;
  const double step = width / intervals;
  const double left = layout_.map_left + 0.5 * (layout_.map_width - width);
  const double top = layout_.map_top + layout_.map_height + kLegendTop * unit_;
  font(16 * unit_);

  double x = left, label_end = 0.0;
  for (const ColourMap* map : maps) {
    const auto& stops = map->stops();
    cairo_pattern_t* ramp = cairo_pattern_create_linear(x, 0, x + step * (stops.size() - 1), 0);
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const Rgb c = stops[i].colour;
      cairo_pattern_add_color_stop_rgb(ramp, double(i) / double(stops.size() - 1), c.r, c.g, c.b);
    }
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      const double from = x + step * static_cast<double>(i);
      cairo_save(pen());
      if (classed) {
        colour(map->class_colour(static_cast<int>(i)));
      } else {
        cairo_set_source(pen(), ramp);
      }
      // Without smoothing neighbours leave no hairline between them.
      cairo_set_antialias(pen(), CAIRO_ANTIALIAS_NONE);
      rectangle(from, top, step, height);
      cairo_fill(pen());
      cairo_restore(pen());
    }
    cairo_pattern_destroy(ramp);
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const double at = x + step * static_cast<double>(i);
      const std::string label = label_of(stops[i].value);
      const double half = 0.5 * text_width(label);
      if (at - half < label_end) continue;
      colour(kInk);
      cairo_set_line_width(pen(), unit_);
      cairo_move_to(pen(), at, top + height);
      cairo_line_to(pen(), at, top + height + 5 * unit_);
      cairo_stroke(pen());
      text(at, top + height + 23 * unit_, label, Align::centre);
      label_end = at + half + 6 * unit_;
    }
    x += step * static_cast<double>(stops.size() - 1);
  }
  colour(kInk);
  cairo_set_line_width(pen(), 1.2 * unit_);
  rectangle(left, top, width, height);
  cairo_stroke(pen());
}

void MapCanvas::category_legend(const std::vector<std::pair<Rgb, std::string>>& items) {
  if (items.empty()) return;
  constexpr int kRows = 2;
  const int columns = (static_cast<int>(items.size()) + kRows - 1) / kRows;
  const double pitch = static_cast<double>(layout_.map_width) / columns;
  const double swatch = std::min(34 * unit_, 0.4 * pitch), height = 22 * unit_, gap = 9 * unit_;
  double size = 18 * unit_;
  for (const auto& [rgb, name] : items) {
    font(18 * unit_);
    size = std::min(size, 18 * unit_ * (pitch - swatch - 2 * gap) / text_width(name));
  }
  font(size);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const double x = layout_.map_left + pitch * static_cast<double>(i % columns);
    const double y = layout_.map_top + layout_.map_height + kLegendTop * unit_ +
                     36 * unit_ * static_cast<double>(i / columns);
    colour(items[i].first);
    rectangle(x, y, swatch, height);
    cairo_fill_preserve(pen());
    colour(kInk, 0.6);
    cairo_set_line_width(pen(), unit_);
    cairo_stroke(pen());
    colour(kInk);
    text(x + swatch + gap, y + 0.5 * height + 0.36 * size, items[i].second);
  }
}

void MapCanvas::remark(const std::string& words) {
  font(18 * unit_);
  colour(kInk);
  text(layout_.map_left + 0.5 * layout_.map_width,
       layout_.map_top + layout_.map_height + (kLegendTop + 20) * unit_, words, Align::centre);
}

void MapCanvas::line_legend(Rgb rgb, const std::vector<std::pair<double, std::string>>& lines,
                            const std::vector<std::pair<Rgb, std::string>>& areas) {
  const double y =
      std::floor(layout_.map_top + layout_.map_height + (kLegendTop + 14) * unit_) + 0.5;
  const double sample = 64 * unit_, gap = 12 * unit_, between = 46 * unit_;
  double x = layout_.map_left;
  font(18 * unit_);
  for (const auto& [width, label] : lines) {
    colour(rgb);
    cairo_set_line_width(pen(), width * unit_);
    cairo_move_to(pen(), x, y);
    cairo_line_to(pen(), x + sample, y);
    cairo_stroke(pen());
    colour(kInk);
    text(x + sample + gap, y + 6 * unit_, label);
    x += sample + gap + text_width(label) + between;
  }
  const double side = 34 * unit_;
  for (const auto& [fill, label] : areas) {
    colour(fill);
    rectangle(x, y - 11 * unit_, side, 22 * unit_);
    cairo_fill_preserve(pen());
    colour(kFaintInk);
    cairo_set_line_width(pen(), unit_);
    cairo_stroke(pen());
    colour(kInk);
    text(x + side + gap, y + 6 * unit_, label);
    x += side + gap + text_width(label) + between;
  }
}

}  // namespace geo::io
