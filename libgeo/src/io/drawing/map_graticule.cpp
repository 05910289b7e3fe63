// The frame of a map: degrees or kilometres along its edges, graticule, scale bar, border.

#include <cmath>
#include <numbers>

#include "map_canvas.hpp"

namespace geo::io {
namespace {

// Steps that a reader expects on a map, largest first.
constexpr std::array kDegreeSteps{30.0, 15.0, 10.0, 5.0,  2.0,  1.0,
                                  0.5,  0.25, 0.1,  0.05, 0.02, 0.01};
// Curved lines are drawn as arcs of this.
constexpr double kArcDeg = 0.5;
// A scale bar holds within this share over the whole map.
constexpr double kOneScale = 1.25;
constexpr double kGraticuleAlpha = 0.22;

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

std::string longitude_label(double longitude_deg) {
  return degrees(std::remainder(longitude_deg, 360.0), "E", "W");
}

std::string latitude_label(double latitude_deg) { return degrees(latitude_deg, "N", "S"); }

/// Multiples of a step within a range.
std::vector<double> multiples(double step, double from, double to) {
  std::vector<double> values;
  for (double k = std::ceil(from / step - 1e-9); k * step < to + 1e-9; k += 1.0) {
    values.push_back(k * step);
  }
  return values;
}

/// Degrees between the lines of a map of that extent.
double line_step(const Window& region) {
  const double width = region.east_deg - region.west_deg;
  const double height = region.north_deg - region.south_deg;
  const double step = degree_step(std::min(width, height));
  return std::max(width, height) / step > 14.0 ? 2.0 * step : step;
}

}  // namespace

void MapCanvas::frame() {
  cairo_set_antialias(pen(), CAIRO_ANTIALIAS_DEFAULT);
  if (!page_->grid().is_latitude_longitude()) {
    kilometre_ticks();
  } else if (page_->is_cylindrical()) {
    straight_graticule();
  } else {
    curved_graticule();
  }
  scale_bar();
  colour(kInk);
  cairo_set_line_width(pen(), 1.6 * unit_);
  if (page_->is_aligned()) {
    rectangle(layout_.map_left, layout_.map_top, layout_.map_width, layout_.map_height);
    cairo_stroke(pen());
    return;
  }
  cairo_save(pen());
  cairo_translate(pen(), layout_.map_left, layout_.map_top);
  cairo_set_line_join(pen(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(pen(), CAIRO_LINE_CAP_ROUND);
  stroke(page_->edge());
  cairo_restore(pen());
}

void MapCanvas::straight_graticule() {
  const Window& region = page_->region();
  const double step = line_step(region), lon_0 = page_->centre().longitude_deg;
  const double left = layout_.map_left, bottom = layout_.map_top + layout_.map_height;
  const MapPage::Projector projector(*page_);
  font(16 * unit_);
  cairo_set_line_width(pen(), unit_);
  const auto line = [&](double x0, double y0, double x1, double y1) {
    inside([&] {
      colour(kInk, kGraticuleAlpha);
      cairo_move_to(pen(), x0, y0);
      cairo_line_to(pen(), x1, y1);
      cairo_stroke(pen());
    });
    colour(kInk);
  };
  for (const double lon : multiples(step, lon_0 + region.west_deg, lon_0 + region.east_deg)) {
    const double x = projector.point_east_of_centre(lon - lon_0, region.south_deg)->x;
    line(x, 0, x, layout_.map_height);
    text(left + x, bottom + 24 * unit_, longitude_label(lon), Align::centre);
  }
  for (const double lat : multiples(step, region.south_deg, region.north_deg)) {
    const double y = projector.point_east_of_centre(region.west_deg, lat)->y;
    line(0, y, layout_.map_width, y);
    text(left - 10 * unit_, layout_.map_top + y + 6 * unit_, latitude_label(lat), Align::right);
  }
}

void MapCanvas::curved_graticule() {
  const Window& region = page_->region();
  const bool whole = region.east_deg - region.west_deg > 359.9;
  double step = line_step(region);
  if (page_->is_azimuthal() && whole) step = 15.0;
  const double lon_0 = page_->centre().longitude_deg;
  const MapPage::Projector projector(*page_);
  const auto draw = [&](const auto& place_at, double from, double to) {
    std::vector<PagePoint> line;
    const int pieces = std::max(2, static_cast<int>(std::ceil((to - from) / kArcDeg)));
    for (int i = 0; i <= pieces; ++i) {
      const auto [east, lat] = place_at(from + (to - from) * i / pieces);
      if (const auto point = projector.point_east_of_centre(east, lat)) {
        line.push_back(*point);
      } else {
        stroke({line});
        line.clear();
      }
    }
    stroke({line});
  };
  inside([&] {
    colour(kInk, kGraticuleAlpha);
    cairo_set_line_width(pen(), unit_);
    for (const double lon : multiples(step, lon_0 + region.west_deg, lon_0 + region.east_deg)) {
      const double east = lon - lon_0;
      if (whole && east > region.east_deg - 1e-6) continue;
      // Near the poles only every other or every third meridian goes on.
      const bool goes_on = std::abs(std::remainder(lon, 6.0 * step)) < 1e-6;
      const double most = goes_on ? 90.0 : 90.0 - step;
      draw(
          [&](double lat) {
            return std::pair{east, lat};
          },
          std::max(region.south_deg, -most), std::min(region.north_deg, most));
    }
    for (const double lat : multiples(step, region.south_deg, region.north_deg)) {
      if (std::abs(lat) > 89.999) continue;
      draw([&](double east) { return std::pair{east, lat}; }, region.west_deg, region.east_deg);
    }
  });
  label_curved_graticule(step);
}

void MapCanvas::label_polar_graticule(double step) {
  const Window& region = page_->region();
  const auto [lat_0, lon_0] = page_->centre();
  const MapPage::Projector projector(*page_);
  const bool whole = region.east_deg - region.west_deg > 359.9;
  const double sign = lat_0 > 0.0 ? 1.0 : -1.0, most = 90.0 - page_->reach_deg() + 1e-6;
  const double rim =
      sign > 0.0 ? std::max(region.south_deg, most) : std::min(region.north_deg, -most);
  const double middle = 0.5 * (region.west_deg + region.east_deg);
  colour(kInk);
  font(16 * unit_);
  for (const double lon : multiples(2.0 * step, lon_0 + region.west_deg, lon_0 + region.east_deg)) {
    const double east = lon - lon_0;
    const auto at = projector.point_east_of_centre(east, rim);
    if (!at || (whole && east > region.east_deg - 1e-6)) continue;
    const double angle = east * std::numbers::pi / 180.0, out = 12 * unit_;
    const double right = std::sin(angle), down = sign * std::cos(angle);
    text(layout_.map_left + at->x + out * right,
         layout_.map_top + at->y + out * down + 6 * unit_ + 5 * unit_ * down, longitude_label(lon),
         right > 0.3    ? Align::left
         : right < -0.3 ? Align::right
                        : Align::centre);
  }
  font(14 * unit_);
  for (const double lat : multiples(step, region.south_deg, region.north_deg)) {
    if (std::abs(lat) > 89.9 || std::abs(lat - rim) < 0.5 * step) continue;
    const auto at = projector.point_east_of_centre(middle + (whole ? step : 0.0), lat);
    if (!at) continue;
    text_on_map(layout_.map_left + at->x, layout_.map_top + at->y + 5 * unit_, latitude_label(lat),
                Align::centre, kInk);
  }
}

void MapCanvas::label_curved_graticule(double step) {
  if (page_->is_polar()) return label_polar_graticule(step);
  if (page_->is_azimuthal()) return label_azimuthal_graticule(step);
  label_parallels(step);
  label_meridians(step);
}

/// A label on a line of the map; none stands across its edge.
void MapCanvas::label_line(std::optional<PagePoint> at, const std::string& label) {
  font(14 * unit_);
  const double room = 12 * unit_, width = layout_.map_width, height = layout_.map_height;
  if (!at || at->y < room || at->y > height - room) return;
  const double half = 0.5 * text_width(label);
  for (const double end : {at->x - half, at->x + half}) {
    if (end < 0.0 || end >= width) return;
    if (!frame_->shows(static_cast<int>(end), static_cast<int>(at->y))) return;
  }
  text_on_map(layout_.map_left + at->x, layout_.map_top + at->y + 5 * unit_, label, Align::centre,
              kInk);
}

/// Labels follow the lines through the middle of the map.
void MapCanvas::label_azimuthal_graticule(double step) {
  const Window& region = page_->region();
  const auto [lat_0, lon_0] = page_->centre();
  const MapPage::Projector projector(*page_);
  const double middle_lat = step * std::round(lat_0 / step);
  const double middle_east =
      step * std::round((lon_0 + 0.5 * (region.west_deg + region.east_deg)) / step) - lon_0;
  const double level = std::abs(middle_lat) > 75.0 ? std::copysign(75.0, middle_lat) : middle_lat;
  for (const double lat :
       multiples(step, region.south_deg + 0.2 * step, region.north_deg - 0.2 * step)) {
    if (std::abs(lat) > 89.9 || std::abs(lat - level) < 1e-6) continue;
    label_line(projector.point_east_of_centre(middle_east, lat), latitude_label(lat));
  }
  for (const double lon : multiples(2.0 * step, lon_0 + region.west_deg, lon_0 + region.east_deg)) {
    label_line(projector.point_east_of_centre(std::remainder(lon - lon_0, 360.0), level),
               longitude_label(lon));
  }
}

/// Latitudes beside the map's western edge.
void MapCanvas::label_parallels(double step) {
  const Window& region = page_->region();
  const MapPage::Projector projector(*page_);
  colour(kInk);
  font(16 * unit_);
  for (const double lat : multiples(step, region.south_deg, region.north_deg)) {
    const auto at = projector.point_east_of_centre(region.west_deg, lat);
    if (!at || std::abs(lat) > 89.9) continue;
    // Clear of the longitudes below the corner.
    const bool at_corner = lat - region.south_deg < 1e-6;
    const double lean = at_corner ? 6 * unit_ : 10 * unit_ * lat / 90.0;
    text(layout_.map_left + at->x - 10 * unit_, layout_.map_top + at->y + 6 * unit_ - lean,
         latitude_label(lat), Align::right);
  }
}

/// Longitudes below the southern edge, or where meridians meet there, along the equator.
void MapCanvas::label_meridians(double step) {
  const Window& region = page_->region();
  const double lon_0 = page_->centre().longitude_deg, south = region.south_deg;
  const MapPage::Projector projector(*page_);
  const auto west_end = projector.point_east_of_centre(region.west_deg, south);
  const auto east_end = projector.point_east_of_centre(region.east_deg, south);
  const bool has_room = west_end && east_end && east_end->x - west_end->x > 0.3 * layout_.map_width;
  const double width = has_room ? east_end->x - west_end->x : layout_.map_width;
  const double between = width * step / (region.east_deg - region.west_deg);
  font(16 * unit_);
  const double every = text_width("150°W") + 6 * unit_ > between ? 2.0 * step : step;
  for (const double lon : multiples(step, lon_0 + region.west_deg, lon_0 + region.east_deg)) {
    if (std::abs(std::remainder(lon, every)) > 1e-6) continue;
    const double east = lon - lon_0;
    if (has_room) {
      colour(kInk);
      font(16 * unit_);
      const auto at = projector.point_east_of_centre(east, south);
      if (!at) continue;
      text(layout_.map_left + at->x, layout_.map_top + at->y + 24 * unit_, longitude_label(lon),
           Align::centre);
    } else {
      const double level = std::clamp(0.0, region.south_deg, region.north_deg);
      label_line(projector.point_east_of_centre(east, level), longitude_label(lon));
    }
  }
}

void MapCanvas::kilometre_ticks() {
  const Grid& grid = page_->grid();
  const double width_km = grid.nx() * grid.spacing_east_m(0) / 1000.0;
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

bool MapCanvas::crosses_edge(double left, double width, double height, double above) const {
  int shown = 0;
  const double bottom = layout_.map_height - above + 12 * unit_;
  const std::array xs{left, left + 0.5 * width, left + width};
  const std::array ys{bottom - height, bottom};
  for (const double x : xs) {
    for (const double y : ys) {
      shown += frame_->shows(static_cast<int>(x), static_cast<int>(y)) ? 1 : 0;
    }
  }
  return shown != 0 && shown != static_cast<int>(xs.size() * ys.size());
}

void MapCanvas::scale_bar() {
  const auto [metres_per_px, varies] = frame_->scale();
  if (varies > kOneScale) return;
  const double length_m = round_down_nicely(metres_per_px * layout_.map_width * 0.18);
  const double length = length_m / metres_per_px, margin = 24 * unit_, thick = 7 * unit_;
  const std::string label =
      length_m >= 1000.0 ? label_of(length_m / 1000.0) + " km" : label_of(length_m) + " m";
  font(17 * unit_);
  // In the lower left, moved on until the edge of the planet does not run through it.
  const double box = std::max(length, text_width(label)) + 24 * unit_;
  double from = margin - 12 * unit_;
  while (from < 0.4 * layout_.map_width && crosses_edge(from, box, 46 * unit_, margin)) {
    from += 12 * unit_;
  }
  const double x = layout_.map_left + from + 12 * unit_;
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
