#include "map_plates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "map_outlines.hpp"

namespace geo::io {
namespace {

constexpr Rgb kWhite{1.0F, 1.0F, 1.0F};

Raster sample_plates(const MapFrame& frame, std::span<const std::int16_t> plate_id) {
  Raster plates(frame, std::numeric_limits<float>::quiet_NaN());
  for (int y = 0; y < plates.height; ++y) {
    for (int x = 0; x < plates.width; ++x) {
      if (frame.shows(x, y)) plates.at(x, y) = plate_id[frame.cell_at(x, y)];
    }
  }
  return plates;
}

/// A number of a colour for each plate, so that no neighbours share one and all are used about
/// equally: the largest plates choose first.
std::map<int, int> colour_numbers(const Raster& plates, int colours) {
  std::map<int, int> pixels;
  std::map<int, std::set<int>> neighbours;
  const auto meet = [&](int a, int b) {
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  };
  for (int y = 0; y < plates.height; ++y) {
    const int below = std::min(y + 1, plates.height - 1);
    int run = 0;
    for (int x = 0; x < plates.width; ++x) {
      const float own = plates.at(x, y);
      if (own != own) continue;  // beyond the edge of the map
      const float east = plates.at(plates.east_of(x), y), south = plates.at(x, below);
      if (east == east && east != own) meet(static_cast<int>(own), static_cast<int>(east));
      if (south == south && south != own) meet(static_cast<int>(own), static_cast<int>(south));
      ++run;
      if (x + 1 == plates.width || plates.at(x + 1, y) != own) {
        pixels[static_cast<int>(own)] += run;
        run = 0;
      }
    }
  }
  std::vector<int> order;
  for (const auto& [plate, count] : pixels) order.push_back(plate);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return pixels[a] > pixels[b]; });
  std::map<int, int> chosen;
  std::vector<int> used(colours, 0);
  for (const int plate : order) {
    int best = 0, least = std::numeric_limits<int>::max();
    for (int colour = 0; colour < colours; ++colour) {
      int cost = used[colour];
      for (const int other : neighbours[plate]) {
        const auto at = chosen.find(other);
        if (at != chosen.end() && at->second == colour) cost += 1000;
      }
      if (cost < least) {
        least = cost;
        best = colour;
      }
    }
    chosen[plate] = best;
    ++used[best];
  }
  return chosen;
}

/// Which boundary lies at a point of the map: the most frequent type of the cells around it.
class BoundaryTypes {
 public:
  BoundaryTypes(const MapFrame& frame, std::span<const std::int8_t> types)
      : frame_(frame),
        types_(types),
        reach_(std::max(1, static_cast<int>(std::ceil(1.5 / frame.pixels_per_row())))) {}

  [[nodiscard]] int at(const OutlinePoint& point) const {
    const Grid& grid = frame_.grid();
    const Index here =
        frame_.cell_at(std::clamp(static_cast<int>(point.x), 0, frame_.width() - 1),
                       std::clamp(static_cast<int>(point.y), 0, frame_.height() - 1));
    if (here == kNoCell) return 0;
    const int column = grid.column(here), row = grid.row(here);
    std::array<int, 4> count{};
    for (int j = std::max(row - reach_, 0); j <= std::min(row + reach_, grid.ny() - 1); ++j) {
      for (int i = column - reach_; i <= column + reach_; ++i) {
        if (grid.topology() == Topology::plane && (i < 0 || i >= grid.nx())) continue;
        const int type = types_[grid.cell((i % grid.nx() + grid.nx()) % grid.nx(), j)];
        if (type > 0 && type < 4) ++count[type];
      }
    }
    const auto most = std::max_element(count.begin() + 1, count.end());
    return *most > 0 ? static_cast<int>(most - count.begin()) : 0;
  }

 private:
  const MapFrame& frame_;
  std::span<const std::int8_t> types_;
  int reach_;
};

void stroke(MapCanvas& canvas, const Outline& line, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i <= end; ++i) cairo_line_to(canvas.pen(), line[i].x, line[i].y);
  cairo_stroke(canvas.pen());
}

constexpr double kLinePx = 3.0, kCasingPx = 5.4;

/// Which types of boundary a map shows; the type 0 is that of plates that hardly move past each
/// other.
using ShownTypes = std::set<int>;

ShownTypes draw_boundaries(MapCanvas& canvas, const std::vector<BoundaryLine>& lines) {
  const ColourMap colours("boundary_type");
  cairo_t* pen = canvas.pen();
  ShownTypes shown;
  canvas.inside([&] {
    cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(pen, CAIRO_LINE_CAP_ROUND);
    canvas.colour(kWhite, 0.75);
    cairo_set_line_width(pen, kCasingPx * canvas.unit());
    for (const auto& line : lines) stroke(canvas, line.points, 0, line.points.size() - 1);
    cairo_set_line_cap(pen, CAIRO_LINE_CAP_BUTT);
    cairo_set_line_width(pen, kLinePx * canvas.unit());
    for (const auto& line : lines) {
      for (const auto& piece : line.pieces) {
        canvas.colour(colours.category(piece.type)->colour);
        stroke(canvas, line.points, piece.begin, piece.end);
        shown.insert(piece.type);
      }
    }
  });
  return shown;
}

void draw_arrow(MapCanvas& canvas, double x, double y, double dx, double dy) {
  cairo_t* pen = canvas.pen();
  const double length = std::hypot(dx, dy), head = std::min(9.0 * canvas.unit(), 0.5 * length);
  const double ux = dx / length, uy = dy / length;
  cairo_move_to(pen, x, y);
  cairo_line_to(pen, x + dx - 0.8 * head * ux, y + dy - 0.8 * head * uy);
  cairo_stroke(pen);
  cairo_move_to(pen, x + dx, y + dy);
  cairo_line_to(pen, x + dx - head * ux - 0.42 * head * uy, y + dy - head * uy + 0.42 * head * ux);
  cairo_line_to(pen, x + dx - head * ux + 0.42 * head * uy, y + dy - head * uy - 0.42 * head * ux);
  cairo_close_path(pen);
  cairo_fill(pen);
}

constexpr double kArrowSpacingPx = 62.0;

/// Length of an arrow per mm/yr, so that all but the fastest twentieth fit one spacing: small
/// plates that race must not make the others look at rest.
double arrow_scale(const MapCanvas& canvas, std::span<const float> east,
                   std::span<const float> north) {
  std::vector<float> speeds;
  for (std::size_t c = 0; c < east.size(); c += 61) speeds.push_back(std::hypot(east[c], north[c]));
  const auto fast = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() * 95 / 100);
  std::nth_element(speeds.begin(), fast, speeds.end());
  return kArrowSpacingPx * canvas.unit() / std::max(*fast, 1.0F);
}

// On an aligned page arrows may run into the border, on others not over the edge of the planet.
bool is_on_map(const MapFrame& frame, double x, double y) {
  if (frame.is_aligned()) return true;
  const bool inside = x >= 0.0 && y >= 0.0 && x < frame.width() && y < frame.height();
  return inside && frame.shows(static_cast<int>(x), static_cast<int>(y));
}

void draw_velocities(MapCanvas& canvas, const MapFrame& frame, std::span<const float> east,
                     std::span<const float> north, double px_per_mm_yr) {
  const int columns =
      std::max(2, static_cast<int>(std::lround(frame.width() / (kArrowSpacingPx * canvas.unit()))));
  const double spacing = double(frame.width()) / columns;
  canvas.inside([&] {
    canvas.colour(kInk, 0.85);
    cairo_set_line_width(canvas.pen(), 1.6 * canvas.unit());
    int row = 0;
    for (double y = 0.5 * spacing; y < frame.height(); y += 0.866 * spacing, ++row) {
      for (int i = 0; i < columns; ++i) {
        const double x = (i + (row % 2 == 0 ? 0.25 : 0.75)) * spacing;
        const int px = static_cast<int>(x), py = static_cast<int>(y);
        const Index c = frame.cell_at(px, py);
        if (c == kNoCell) continue;
        const PagePoint way = frame.on_page(px, py, east[c], north[c]);
        const double dx = px_per_mm_yr * way.x, dy = px_per_mm_yr * way.y;
        if (std::hypot(dx, dy) < 3.0 * canvas.unit()) continue;
        if (!is_on_map(frame, x - 0.5 * dx, y - 0.5 * dy) ||
            !is_on_map(frame, x + 0.5 * dx, y + 0.5 * dy)) {
          continue;
        }
        // About its place, so that arrows of neighbours keep apart.
        draw_arrow(canvas, x - 0.5 * dx, y - 0.5 * dy, dx, dy);
      }
    }
  });
}

std::map<int, Rgb> colours_of(const Raster& plates) {
  const ColourMap colours("plates");
  std::map<int, Rgb> chosen;
  for (const auto& [plate, number] :
       colour_numbers(plates, static_cast<int>(colours.stops().size()))) {
    chosen[plate] = colours.stops()[number].colour;
  }
  return chosen;
}

/// What a line of this type says. Where no types are known all lines are of type 0.
std::string words_of_line(const ColourMap::Stop& stop, bool types_are_known) {
  if (stop.value != 0.0F) return stop.name;
  return types_are_known ? "hardly moving" : "plate boundary";
}

void draw_legend(MapCanvas& canvas, const ShownTypes& shown, bool types_are_known,
                 double px_per_mm_yr) {
  const ColourMap colours("boundary_type");
  cairo_t* pen = canvas.pen();
  const double unit = canvas.unit(), sample = 60 * unit, gap = 12 * unit;
  const auto& layout = canvas.layout();
  const double y = std::floor(layout.map_top + layout.map_height + 62 * unit) + 0.5;
  double x = layout.map_left;
  canvas.font(18 * unit);
  for (const auto& stop : colours.stops()) {
    const bool is_grey = stop.value == 0.0F;
    if (is_grey ? !shown.contains(0) : !types_are_known) continue;
    const std::string words = words_of_line(stop, types_are_known);
    canvas.colour(stop.colour);
    cairo_set_line_width(pen, 1.3 * kLinePx * unit);
    cairo_move_to(pen, x, y);
    cairo_line_to(pen, x + sample, y);
    cairo_stroke(pen);
    canvas.colour(kInk);
    canvas.text(x + sample + gap, y + 6 * unit, words);
    x += sample + gap + canvas.text_width(words) + 44 * unit;
  }
  if (!(px_per_mm_yr > 0.0)) return;
  const double speed = round_down_nicely(kArrowSpacingPx * unit / px_per_mm_yr * 1.001);
  const double length = speed * px_per_mm_yr;
  canvas.colour(kInk);
  cairo_set_line_width(pen, 1.6 * unit);
  draw_arrow(canvas, x, y, length, 0.0);
  canvas.text(x + length + gap, y + 6 * unit, label_of(speed) + " mm per year");
}

}  // namespace

std::map<int, Rgb> plate_colours(const MapFrame& frame, const State& state) {
  return colours_of(sample_plates(frame, state.read(field::plate_id)));
}

std::vector<BoundaryLine> boundary_lines(const MapFrame& frame, const State& state) {
  const Raster plates = sample_plates(frame, state.read(field::plate_id));
  std::optional<BoundaryTypes> known;
  if (state.has(field::boundary_type)) known.emplace(frame, state.read(field::boundary_type));
  std::vector<BoundaryLine> lines;
  // Where cells are larger than pixels their steps are, too.
  for (Outline& outline : trace_outlines(plates, 1.2 * std::max(1.5, frame.pixels_per_row()))) {
    BoundaryLine line{std::move(outline), {}};
    const auto type_at = [&](std::size_t i) { return known ? known->at(line.points[i]) : 0; };
    for (std::size_t begin = 0; begin + 1 < line.points.size();) {
      std::size_t end = begin + 1;
      while (end + 1 < line.points.size() && type_at(end) == type_at(begin)) ++end;
      line.pieces.push_back({begin, end, type_at(begin)});
      begin = end;
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

void draw_plates(MapCanvas& canvas, const MapFrame& frame, const State& state,
                 const MapBase& base) {
  const Raster plates = sample_plates(frame, state.read(field::plate_id));
  auto colour_of = colours_of(plates);
  const bool has_relief = state.has(field::elevation);
  canvas.paint_rows([&](int y, ColourRow& row) {
    int seen = -1;
    Rgb own{}, at_sea{}, on_land{};
    for (int x = 0; x < plates.width; ++x) {
      if (plates.at(x, y) != plates.at(x, y)) continue;  // beyond the edge of the map
      const int plate = static_cast<int>(plates.at(x, y));
      if (plate != seen) {  // plates come in long runs
        own = colour_of[plate];
        at_sea = mix(own, kWhite, 0.45F);
        on_land = mix(own, kInk, 0.08F);
        seen = plate;
      }
      const float land = base.land_cover.at(x, y);
      row.set(x, has_relief ? mix(at_sea, on_land, land) : own, 0.26F + 0.3F * land);
    }
    if (!has_relief) return;
    shade(row, base, y);
    draw_coast(row, base, y, 0.35F);
  });
  const bool typed = state.has(field::boundary_type);
  const ShownTypes shown = draw_boundaries(canvas, boundary_lines(frame, state));
  double px_per_mm_yr = 0.0;
  if (state.has(field::plate_velocity_east) && state.has(field::plate_velocity_north)) {
    const auto east = state.read(field::plate_velocity_east);
    const auto north = state.read(field::plate_velocity_north);
    px_per_mm_yr = arrow_scale(canvas, east, north);
    draw_velocities(canvas, frame, east, north, px_per_mm_yr);
  }
  canvas.frame();
  draw_legend(canvas, shown, typed, px_per_mm_yr);
}

}  // namespace geo::io
