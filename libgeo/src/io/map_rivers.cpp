#include "map_rivers.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace geo::io {
namespace {

// Pixels of line per square pixel of land: about one river every 22 pixels.
constexpr double kLineDensity = 0.045;

// Sixteen bins per factor of two, straight from the bits of a positive float.
constexpr int kBins = 1 << 12;
int flow_bin(float flow) { return static_cast<int>(std::bit_cast<std::uint32_t>(flow) >> 19U); }
float flow_of_bin(int bin) { return std::bit_cast<float>(static_cast<std::uint32_t>(bin) << 19U); }

std::vector<float> flow_of(const State& state) {
  if (state.has(field::discharge)) {
    const auto discharge = state.read(field::discharge);
    return {discharge.begin(), discharge.end()};
  }
  const auto area = state.read(field::drainage_area);
  return {area.begin(), area.end()};
}

struct Step {
  int columns, rows;
};

class Tracer {
 public:
  Tracer(const MapFrame& frame, const State& state)
      : frame_(frame),
        grid_(frame.grid()),
        receiver_(state.read(field::flow_receiver)),
        flow_(flow_of(state)) {
    if (state.has(field::elevation)) elevation_ = state.read(field::elevation);
    if (state.has(field::lake_depth)) lake_depth_ = state.read(field::lake_depth);
  }

  RiverNetwork trace() {
    RiverNetwork network;
    network.least_flow = threshold();
    std::vector<std::uint8_t> has_donor(receiver_.size(), 0), drawn(receiver_.size(), 0);
    std::vector<Index> cells;
    for (Index i = 0; i < grid_.size(); ++i) {
      if (!is_drawn(i, network.least_flow)) continue;
      cells.push_back(i);
      has_donor[receiver_[i]] = 1;
      network.most_flow = std::max(network.most_flow, flow_[i]);
    }
    for (const Index source : cells) {
      if (has_donor[source] == 0) follow(source, network, drawn);
    }
    for (auto& line : network.lines) smooth(line);
    return network;
  }

 private:
  [[nodiscard]] bool is_land(Index i) const { return elevation_.empty() || elevation_[i] >= 0.0F; }
  [[nodiscard]] bool is_lake(Index i) const {
    return !lake_depth_.empty() && lake_depth_[i] > 0.0F;
  }
  [[nodiscard]] bool is_drawn(Index i, float least_flow) const {
    const Index to = receiver_[i];
    return to >= 0 && to != i && flow_[i] >= least_flow && is_land(i) &&
           !(is_lake(i) && is_lake(to));
  }

  [[nodiscard]] Step step(Index from, Index to) const {
    int columns = grid_.column(to) - grid_.column(from);
    if (frame_.wraps_east()) {
      if (2 * columns > grid_.nx()) columns -= grid_.nx();
      if (2 * columns < -grid_.nx()) columns += grid_.nx();
    }
    return {columns, grid_.row(to) - grid_.row(from)};
  }

  // The flow above which the rivers are as long as the map has room for.
  [[nodiscard]] float threshold() const {
    std::vector<double> length_m(kBins, 0.0);
    double land_m2 = 0.0;
    for (Index i = 0; i < grid_.size(); ++i) {
      if (!is_land(i)) continue;
      const int row = grid_.row(i);
      land_m2 += grid_.area_m2(row);
      if (receiver_[i] < 0 || receiver_[i] == i || !(flow_[i] > 0.0F)) continue;
      const Step to = step(i, receiver_[i]);
      length_m[flow_bin(flow_[i])] +=
          std::hypot(to.columns * grid_.spacing_east_m(row), to.rows * grid_.spacing_north_m(row));
    }
    // Lines of small maps are relatively wider and need more room.
    const double pixel_m = frame_.pixel_north_m(frame_.height() / 2) * map_unit(frame_.width());
    double room_m = kLineDensity * land_m2 / pixel_m;
    for (int bin = kBins - 1; bin > 0; --bin) {
      room_m -= length_m[bin];
      if (room_m < 0.0) return flow_of_bin(bin + 1);
    }
    return flow_of_bin(1);
  }

  void follow(Index cell, RiverNetwork& network, std::vector<std::uint8_t>& drawn) {
    double column = grid_.column(cell), row = grid_.row(cell);
    auto* line = &network.lines.emplace_back();
    const auto add = [&](Index i) {
      line->push_back({frame_.x_of(column), frame_.y_of(row), flow_[i]});
    };
    add(cell);
    while (is_drawn(cell, network.least_flow) && drawn[cell] == 0) {
      drawn[cell] = 1;
      const Index to = receiver_[cell];
      const Step by = step(cell, to);
      if (std::abs(by.columns) > 1 || std::abs(by.rows) > 1) {  // over a pole: the pen is lifted
        line = &network.lines.emplace_back();
        column = grid_.column(to);
        row = grid_.row(to);
      } else {
        column += by.columns;
        row += by.rows;
      }
      add(to);
      cell = to;
    }
  }

  // Binomial smoothing with fixed ends takes away the steps of the eight directions.
  void smooth(std::vector<RiverPoint>& line) const {
    const int passes = frame_.pixels_per_row() < 0.75 ? 3 : 5;
    for (int pass = 0; pass < passes && line.size() > 2; ++pass) {
      RiverPoint before = line.front();
      for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        const RiverPoint here = line[i];
        line[i].x = 0.25 * before.x + 0.5 * here.x + 0.25 * line[i + 1].x;
        line[i].y = 0.25 * before.y + 0.5 * here.y + 0.25 * line[i + 1].y;
        before = here;
      }
    }
  }

  const MapFrame& frame_;
  const Grid& grid_;
  std::span<const std::int32_t> receiver_;
  std::vector<float> flow_;
  std::span<const float> elevation_, lake_depth_;
};

// One line from point to point, in strokes of constant width; points closer than a pixel are
// passed over.
void draw_line(MapCanvas& canvas, const std::vector<RiverPoint>& line, double shift_px,
               const RiverNetwork& rivers) {
  cairo_t* pen = canvas.pen();
  double width = 0.0, x = 0.0, y = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto& point = line[i];
    if (i == 0) {
      cairo_move_to(pen, x = point.x + shift_px, y = point.y);
      width = river_width_px(rivers, point.flow);
      continue;
    }
    const bool last = i + 1 == line.size();
    if (!last && std::hypot(point.x + shift_px - x, point.y - y) < 0.9) continue;
    cairo_line_to(pen, x = point.x + shift_px, y = point.y);
    const double next = river_width_px(rivers, point.flow);
    if (last || next != width) {
      cairo_set_line_width(pen, width * canvas.unit());
      cairo_stroke(pen);
      cairo_move_to(pen, x, y);
      width = next;
    }
  }
  cairo_new_path(pen);
}

}  // namespace

bool has_rivers(const State& state) {
  return state.has(field::flow_receiver) &&
         (state.has(field::discharge) || state.has(field::drainage_area));
}

RiverNetwork trace_rivers(const MapFrame& frame, const State& state) {
  return Tracer(frame, state).trace();
}

double river_width_px(const RiverNetwork& rivers, float flow) {
  constexpr double kThin = 0.8, kThick = 4.6, kQuantum = 0.2;
  const double least = std::sqrt(rivers.least_flow);
  const double span = std::max(std::sqrt(rivers.most_flow) - least, 1e-30);
  const double relative = std::clamp((std::sqrt(flow) - least) / span, 0.0, 1.0);
  return std::round((kThin + (kThick - kThin) * relative) / kQuantum) * kQuantum;
}

std::vector<std::pair<double, std::string>> river_key(const RiverNetwork& rivers,
                                                      const State& state) {
  std::vector<std::pair<double, std::string>> key;
  if (rivers.lines.empty()) return key;
  const bool discharge = state.has(field::discharge);
  const double unit = discharge ? 1.0 : 1e6;  // areas in km²
  const auto first = std::ceil(std::log10(rivers.least_flow / unit));
  for (double power = first; std::pow(10.0, power) * unit <= rivers.most_flow; power += 1.0) {
    const double value = std::pow(10.0, power);
    key.emplace_back(river_width_px(rivers, static_cast<float>(value * unit)),
                     label_of(value) + (discharge ? " m³/s" : " km²"));
  }
  return key;
}

void draw_rivers(MapCanvas& canvas, const RiverNetwork& rivers, Rgb colour) {
  const double width = canvas.layout().map_width;
  canvas.inside([&] {
    canvas.colour(colour);
    cairo_set_line_cap(canvas.pen(), CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(canvas.pen(), CAIRO_LINE_JOIN_ROUND);
    for (const auto& line : rivers.lines) {
      const auto [west, east] =
          std::minmax_element(line.begin(), line.end(),
                              [](const RiverPoint& a, const RiverPoint& b) { return a.x < b.x; });
      if (line.size() < 2) continue;
      draw_line(canvas, line, 0.0, rivers);
      if (west->x < 0.0) draw_line(canvas, line, width, rivers);
      if (east->x > width) draw_line(canvas, line, -width, rivers);
    }
  });
}

}  // namespace geo::io
