// The frame of a map: degrees or kilometres along its edges, graticule, scale bar, border.

#include <cmath>
#include <numbers>

#include "map_canvas.hpp"

namespace geo::io {
namespace {

// Steps that a reader expects on a map, largest first.
constexpr std::array kDegreeSteps{30.0, 15.0, 10.0, 5.0,  2.0,  1.0,
                                  0.5,  0.25, 0.1,  0.05, 0.02, 0.01};

double degree_step(double extent_deg) {
  for (const double step : kDegreeSteps) {
    if (extent_deg / step >= 3.5) return step;
  }
  return kDegreeSteps.back();
}

std::string degrees(double value, const char* positive, const char* negative) {
  const std::string text = label_of(std::abs(value)) + "°";
  if (std::abs(value) < 1e-9 || std::abs(std::abs(value) - 180.0) < 1e-9) return text;
  return text + (value > 0.0 ? positive : negative);
}

double wrapped_longitude(double longitude_deg) {
  return longitude_deg > 180.0 ? longitude_deg - 360.0 : longitude_deg;
}

}  // namespace

void MapCanvas::frame() {
  cairo_set_antialias(pen(), CAIRO_ANTIALIAS_DEFAULT);
  if (grid_->is_latitude_longitude()) {
    graticule();
  } else {
    kilometre_ticks();
  }
  if (grid_->topology() != Topology::sphere) scale_bar();
  colour(kInk);
  cairo_set_line_width(pen(), 1.6 * unit_);
  rectangle(layout_.map_left, layout_.map_top, layout_.map_width, layout_.map_height);
  cairo_stroke(pen());
}

void MapCanvas::graticule() {
  const Window& window = grid_->window();
  const double width = layout_.map_width, height = layout_.map_height;
  const double width_deg = window.east_deg - window.west_deg;
  const double height_deg = window.north_deg - window.south_deg;
  const double step = degree_step(std::min(width_deg, height_deg));
  const double lines = std::max(width_deg, height_deg) / step > 14.0 ? 2.0 * step : step;
  const double left = layout_.map_left, bottom = layout_.map_top + height;
  font(16 * unit_);
  cairo_set_line_width(pen(), unit_);
  const auto tick_first = [](double from, double by) { return std::ceil(from / by - 1e-9) * by; };

  for (double lon = tick_first(window.west_deg, lines); lon < window.east_deg + 1e-9;
       lon += lines) {
    const double x = (lon - window.west_deg) / width_deg * width;
    inside([&] {
      colour(kInk, 0.22);
      cairo_move_to(pen(), x, 0);
      cairo_line_to(pen(), x, height);
      cairo_stroke(pen());
    });
    colour(kInk);
    text(left + x, bottom + 24 * unit_, degrees(wrapped_longitude(lon), "E", "W"), Align::centre);
  }
  for (double lat = tick_first(window.south_deg, lines); lat < window.north_deg + 1e-9;
       lat += lines) {
    const double y = (window.north_deg - lat) / height_deg * height;
    inside([&] {
      colour(kInk, 0.22);
      cairo_move_to(pen(), 0, y);
      cairo_line_to(pen(), width, y);
      cairo_stroke(pen());
    });
    colour(kInk);
    text(left - 10 * unit_, layout_.map_top + y + 6 * unit_, degrees(lat, "N", "S"), Align::right);
  }
}

void MapCanvas::kilometre_ticks() {
  const double width_km = grid_->nx() * grid_->spacing_east_m(0) / 1000.0;
  const double per_km = layout_.map_width / width_km;
  const double height_km = layout_.map_height / per_km;
  const double step = round_down_nicely(std::max(width_km, height_km) / 5.0);
  const double left = layout_.map_left, bottom = layout_.map_top + layout_.map_height;
  font(16 * unit_);
  colour(kInk);
  cairo_set_line_width(pen(), 1.4 * unit_);
  const double tick = 7 * unit_;
  const int across = static_cast<int>(0.5 * width_km / step);
  const int along = static_cast<int>(0.5 * height_km / step);
  for (int i = -across; i <= across; ++i) {
    const double x = left + layout_.map_width / 2.0 + i * step * per_km;
    cairo_move_to(pen(), x, bottom);
    cairo_line_to(pen(), x, bottom + tick);
    cairo_stroke(pen());
    text(x, bottom + tick + 18 * unit_, label_of(i * step) + (i == across ? " km" : ""),
         Align::centre);
  }
  for (int j = -along; j <= along; ++j) {
    const double y = layout_.map_top + layout_.map_height / 2.0 - j * step * per_km;
    cairo_move_to(pen(), left, y);
    cairo_line_to(pen(), left - tick, y);
    cairo_stroke(pen());
    text(left - tick - 5 * unit_, y + 6 * unit_, label_of(j * step), Align::right);
  }
}

void MapCanvas::scale_bar() {
  const double metres_per_px =
      grid_->spacing_east_m(grid_->ny() / 2) * grid_->nx() / layout_.map_width;
  const double length_m = round_down_nicely(metres_per_px * layout_.map_width * 0.18);
  const double length = length_m / metres_per_px, margin = 24 * unit_, thick = 7 * unit_;
  const std::string label =
      length_m >= 1000.0 ? label_of(length_m / 1000.0) + " km" : label_of(length_m) + " m";
  font(17 * unit_);
  const double x = layout_.map_left + margin;
  const double y = layout_.map_top + layout_.map_height - margin;
  colour({1, 1, 1}, 0.8);
  rectangle(x - 12 * unit_, y - 34 * unit_, std::max(length, text_width(label)) + 24 * unit_,
            46 * unit_);
  cairo_fill(pen());
  colour(kInk);
  rectangle(x, y - thick, length / 2, thick);
  cairo_fill(pen());
  cairo_set_line_width(pen(), unit_);
  rectangle(x, y - thick, length, thick);
  cairo_stroke(pen());
  text(x, y - thick - 7 * unit_, label);
}

}  // namespace geo::io
