#include "map_rivers.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>

#include "geo/core/cell_set.hpp"

namespace geo::io {
namespace {

// Pixels of line per square pixel of land: about one river every 18 pixels.
constexpr double kLineDensity = 0.055;
// Side of the square that a river drains before it is drawn: in pixels so that lines keep apart, in
// cells so that the parallel paths of a plain, one a cell, are no rivers.
constexpr double kSourcePx = 7.0, kSourceCells = 5.0;

// Sixteen bins per factor of two, straight from the bits of a positive float.
constexpr int kBins = 1 << 12;
int bin_of(float value) { return static_cast<int>(std::bit_cast<std::uint32_t>(value) >> 19U); }
float value_of(int bin) { return std::bit_cast<float>(static_cast<std::uint32_t>(bin) << 19U); }

/// What rivers are drawn by where there is no discharge.
std::vector<float> flow_by_area(const State& state) {
  if (state.has(field::discharge)) return {};
  const auto area = state.read(field::drainage_area);
  return {area.begin(), area.end()};
}

struct Step {
  int columns, rows;
};

/// A point of a river on the grid: columns run on round the planet, rows over the poles.
struct GridPoint {
  double column, row;
  float flow;
  Index cell;
};

/// A river from its source until it ends in the sea or a lake, or joins another.
struct GridLine {
  std::vector<GridPoint> points;
  bool joins = false;
  bool is_smooth = false;
};

/// Where a river passes a cell in which others join it.
struct Junction {
  std::size_t line, point;
};

class Tracer {
 public:
  Tracer(const MapFrame& frame, const State& state)
      : frame_(frame),
        grid_(frame.grid()),
        receiver_(state.read(field::flow_receiver)),
        area_flow_(flow_by_area(state)),
        flow_(area_flow_.empty() ? state.read(field::discharge) : area_flow_),
        // Lines of small maps are relatively wider and need more room.
        pixel_m_(frame.pixel_m() * map_unit(frame.width())) {
    if (state.has(field::drainage_area)) area_m2_ = state.read(field::drainage_area);
    const double cell_m = grid_.spacing_north_m(grid_.ny() / 2);
    source_m2_ = std::pow(std::max(kSourcePx * pixel_m_, kSourceCells * cell_m), 2);
    if (state.has(field::elevation)) elevation_ = state.read(field::elevation);
    if (state.has(field::lake_depth)) lake_depth_ = state.read(field::lake_depth);
    set_rank(state);
    if (!frame.is_aligned()) projector_.emplace(frame.page());
  }

  RiverNetwork trace() {
    least_rank_ = least_rank();
    find_main_donors();
    std::vector<GridLine> lines;
    rank_.set()->visit([&](Index i) {
      if (is_drawn(i) && main_donor_.of(i) == kNoCell) follow(i, lines);
    });
    std::unordered_map<Index, Junction> junctions;
    for (const GridLine& line : lines) {
      if (line.joins) junctions.try_emplace(line.points.back().cell);
    }
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const auto& points = lines[k].points;
      for (std::size_t at = 0; at + 1 < points.size(); ++at) {
        if (const auto here = junctions.find(points[at].cell); here != junctions.end()) {
          here->second = {k, at};
        }
      }
    }
    RiverNetwork network;
    for (GridLine& line : lines) {
      smooth(line, lines, junctions);
      place(line.points, network);
    }
    measure(network);
    return network;
  }

 private:
  // What decides which rivers are drawn: (Q^2 A)^(1/3). By discharge alone wet lands would have all
  // the lines, by area alone deserts as many. 0 where none can be.
  void set_rank(const State& state) {
    const bool both = state.has(field::discharge) && state.has(field::drainage_area);
    const auto rank_of = [&](Index i) {
      return both ? std::cbrt(flow_[i] * flow_[i] * static_cast<float>(area_m2_[i])) : flow_[i];
    };
    const FrozenGround ice(state);
    const auto may_be_drawn = [&](Index i) {
      const Index to = receiver_[i];
      return to >= 0 && to != i && is_land(i) && (area_m2_.empty() || area_m2_[i] >= source_m2_) &&
             !ice.at(i) && rank_of(i) > 0.0F;
    };
    const auto rivers = std::make_shared<const CellSet>(grid_.size(), may_be_drawn);
    rank_ = SparseValues<float>(rivers);
    rivers->visit([&](Index i) { rank_.of(i) = rank_of(i); });
  }

  [[nodiscard]] bool is_land(Index i) const { return elevation_.empty() || elevation_[i] >= 0.0F; }
  [[nodiscard]] bool is_lake(Index i) const {
    return !lake_depth_.empty() && lake_depth_[i] > 0.0F;
  }
  [[nodiscard]] bool is_river(Index i) const { return rank_.set()->holds(i); }
  [[nodiscard]] bool is_drawn(Index i) const {
    return is_river(i) && rank_.of(i) >= least_rank_ && !(is_lake(i) && is_lake(receiver_[i]));
  }

  [[nodiscard]] Step step(Index from, Index to) const {
    int columns = grid_.column(to) - grid_.column(from);
    if (grid_.topology() != Topology::plane) {
      if (2 * columns > grid_.nx()) columns -= grid_.nx();
      if (2 * columns < -grid_.nx()) columns += grid_.nx();
    }
    return {columns, grid_.row(to) - grid_.row(from)};
  }

  // The rank above which the rivers are as long as the map has room for.
  [[nodiscard]] float least_rank() const {
    std::vector<double> length_m(kBins, 0.0);
    double land_m2 = 0.0;
    for (Index i = 0; i < grid_.size(); ++i) {
      if (!is_land(i)) continue;
      const int row = grid_.row(i);
      land_m2 += grid_.area_m2(row);
      if (!is_river(i)) continue;
      const Step to = step(i, receiver_[i]);
      length_m[bin_of(rank_.of(i))] +=
          std::hypot(to.columns * grid_.spacing_east_m(row), to.rows * grid_.spacing_north_m(row));
    }
    double room_m = kLineDensity * land_m2 / pixel_m_;
    for (int bin = kBins - 1; bin > 0; --bin) {
      room_m -= length_m[bin];
      if (room_m < 0.0) return value_of(bin + 1);
    }
    return value_of(1);
  }

  // Of the drawn rivers that meet in a cell, the largest goes on; of equal ones the first.
  void find_main_donors() {
    main_donor_ = SparseValues<Index>(rank_.set(), kNoCell);
    rank_.set()->visit([&](Index i) {
      if (!is_drawn(i) || !is_river(receiver_[i])) return;
      Index& main = main_donor_.of(receiver_[i]);
      if (main == kNoCell || flow_[i] > flow_[main]) main = i;
    });
  }

  void follow(Index cell, std::vector<GridLine>& lines) const {
    double column = grid_.column(cell), row = grid_.row(cell);
    auto* line = &lines.emplace_back();
    const auto add = [&](Index i) { line->points.push_back({column, row, flow_[i], i}); };
    add(cell);
    while (is_drawn(cell)) {
      const Index to = receiver_[cell];
      const Step by = step(cell, to);
      const bool over_pole = std::abs(by.columns) > 1 || std::abs(by.rows) > 1;
      if (over_pole) {  // a new line beyond it
        row = grid_.row(to) < grid_.ny() / 2 ? -1.0 - grid_.row(to)
                                             : 2.0 * grid_.ny() - 1.0 - grid_.row(to);
      } else {
        column += by.columns;
        row += by.rows;
      }
      add(to);
      if (!is_river(to) || main_donor_.of(to) != cell) {
        line->joins = !over_pole && is_drawn(to);
        return;
      }
      if (over_pole) {
        line = &lines.emplace_back();
        column = grid_.column(to);
        row = grid_.row(to);
        add(to);
      }
      cell = to;
    }
  }

  // A line on the pixels of the map, cut where the map does not show it.
  void place(std::span<const GridPoint> line, RiverNetwork& network) const {
    if (frame_.is_aligned()) {
      auto& drawn = network.lines.emplace_back();
      for (const GridPoint& point : line) {
        drawn.push_back({(point.column + 0.5) * frame_.pixels_per_column(),
                         frame_.height() - (point.row + 0.5) * frame_.pixels_per_row(),
                         point.flow});
      }
      return;
    }
    const Window& window = grid_.window();
    const double column_deg = (window.east_deg - window.west_deg) / grid_.nx();
    const double row_deg = (window.north_deg - window.south_deg) / grid_.ny();
    const double lon_0 = frame_.page().centre().longitude_deg;
    bool pen_down = false;
    double east_before = 0.0;
    for (const GridPoint& point : line) {
      Centre here{window.south_deg + (point.row + 0.5) * row_deg,
                  window.west_deg + (point.column + 0.5) * column_deg};
      if (std::abs(here.latitude_deg) > 90.0) {
        here = {std::copysign(180.0, here.latitude_deg) - here.latitude_deg,
                here.longitude_deg + 180.0};
      }
      const double east = std::remainder(here.longitude_deg - lon_0, 360.0);
      const bool cut = !frame_.page().is_azimuthal() && std::abs(east - east_before) > 180.0;
      const auto at = projector_->point_of(here);
      if (at && (!pen_down || cut)) network.lines.emplace_back();
      if (at) network.lines.back().push_back({at->x, at->y, point.flow});
      pen_down = at.has_value();
      east_before = east;
    }
  }

  static void measure(RiverNetwork& network) {
    bool first = true;
    for (const auto& line : network.lines) {
      for (const RiverPoint& point : line) {
        network.least_flow = first ? point.flow : std::min(network.least_flow, point.flow);
        network.most_flow = first ? point.flow : std::max(network.most_flow, point.flow);
        first = false;
      }
    }
  }

  // Binomial smoothing with fixed ends takes away the steps of the eight directions. A river that
  // joins another then ends where smoothing has put that one.
  void smooth(GridLine& line, std::vector<GridLine>& lines,
              const std::unordered_map<Index, Junction>& junctions) const {
    if (line.is_smooth) return;
    line.is_smooth = true;
    auto& points = line.points;
    const int passes = frame_.pixels_per_row() < 0.75 ? 3 : 5;
    for (int pass = 0; pass < passes && points.size() > 2; ++pass) {
      GridPoint before = points.front();
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const GridPoint here = points[i];
        points[i].column = 0.25 * before.column + 0.5 * here.column + 0.25 * points[i + 1].column;
        points[i].row = 0.25 * before.row + 0.5 * here.row + 0.25 * points[i + 1].row;
        before = here;
      }
    }
    if (!line.joins) return;
    const Index cell = points.back().cell;
    const Junction& junction = junctions.at(cell);
    smooth(lines[junction.line], lines, junctions);
    const GridPoint& host = lines[junction.line].points[junction.point];
    double columns = host.column - grid_.column(cell);
    if (grid_.topology() != Topology::plane) columns = std::remainder(columns, grid_.nx());
    const double rows = host.row - grid_.row(cell);
    double share = 1.0;
    for (auto point = points.rbegin(); point != points.rend() && share > 0.05; ++point) {
      point->column += share * columns;
      point->row += share * rows;
      share *= 0.6;
    }
  }

  const MapFrame& frame_;
  const Grid& grid_;
  std::span<const std::int32_t> receiver_;
  std::vector<float> area_flow_;
  std::span<const float> flow_;
  SparseValues<float> rank_;
  SparseValues<Index> main_donor_;
  double pixel_m_, source_m2_ = 0.0;
  std::optional<MapPage::Projector> projector_;
  float least_rank_ = 0.0F;
  std::span<const float> elevation_, lake_depth_;
  std::span<const double> area_m2_;
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

FrozenGround::FrozenGround(const State& state) {
  if (state.has(field::ice_thickness)) ice_m_ = state.read(field::ice_thickness);
  if (!state.has(field::temperature) || !state.has(field::temperature_range)) return;
  mean_c_ = state.read(field::temperature);
  range_k_ = state.read(field::temperature_range);
}

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
  constexpr double kMostLines = 4.0;
  const double last = std::floor(std::log10(rivers.most_flow / unit));
  const double first =
      std::max(std::ceil(std::log10(rivers.least_flow / unit)), last - kMostLines + 1.0);
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
