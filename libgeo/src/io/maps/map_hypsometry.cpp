#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geo/io/files/embedded_data.hpp"
#include "geo/io/maps/maps.hpp"
#include "io/drawing/map_canvas.hpp"

namespace geo::io {
namespace {

/// How the elevation of a planet is spread over its area: the share of the area below each of a
/// rising sequence of elevations, linear in between.
class Hypsometry {
 public:
  Hypsometry(std::vector<double> elevation_m, std::vector<double> below)
      : elevation_m_(std::move(elevation_m)), below_(std::move(below)) {}

  static Hypsometry of_relief(const Grid& grid, std::span<const float> elevation_m) {
    constexpr int kBins = 8192;
    const auto [low, high] = std::minmax_element(elevation_m.begin(), elevation_m.end());
    const double base = *low, bin_m = std::max((double(*high) - base) / kBins, 1e-6);
    std::vector<double> edges(kBins + 1), below(kBins + 1, 0.0);
    for (int i = 0; i <= kBins; ++i) edges[i] = base + i * bin_m;
    for (Index i = 0; i < grid.size(); ++i) {
      const int bin = std::min(static_cast<int>((elevation_m[i] - base) / bin_m), kBins - 1);
      below[bin + 1] += grid.area_m2(grid.row(i));
    }
    std::partial_sum(below.begin(), below.end(), below.begin());
    for (double& share : below) share /= grid.total_area_m2();
    return {std::move(edges), std::move(below)};
  }

  static Hypsometry of_earth() {
    std::vector<double> elevation_m, below;
    const Table table = embedded_table("targets/earth.csv");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      below.push_back(table.number(row, 0));
      elevation_m.push_back(table.number(row, 1));
    }
    return {std::move(elevation_m), std::move(below)};
  }

  [[nodiscard]] double lowest_m() const { return elevation_m_.front(); }
  [[nodiscard]] double highest_m() const { return elevation_m_.back(); }
  [[nodiscard]] const std::vector<double>& elevations_m() const { return elevation_m_; }
  [[nodiscard]] const std::vector<double>& below() const { return below_; }

  [[nodiscard]] double share_below(double elevation_m) const {
    const auto above = std::lower_bound(elevation_m_.begin(), elevation_m_.end(), elevation_m);
    if (above == elevation_m_.begin()) return 0.0;
    if (above == elevation_m_.end()) return 1.0;
    const auto i = above - elevation_m_.begin();
    const double t = (elevation_m - elevation_m_[i - 1]) / (elevation_m_[i] - elevation_m_[i - 1]);
    return below_[i - 1] + t * (below_[i] - below_[i - 1]);
  }
  /// "land 28.5 %, mean height 835 m, mean depth 3650 m"
  [[nodiscard]] std::string in_words() const {
    double land = 0.0, land_sum = 0.0, sea = 0.0, sea_sum = 0.0;
    for (std::size_t i = 1; i < below_.size(); ++i) {
      const double share = below_[i] - below_[i - 1];
      const double middle = 0.5 * (elevation_m_[i] + elevation_m_[i - 1]);
      (middle >= 0.0 ? land : sea) += share;
      (middle >= 0.0 ? land_sum : sea_sum) += share * middle;
    }
    std::string words = fmt::format("land {:.1f} %", 100.0 * (1.0 - share_below(0.0)));
    if (land > 0.0) words += fmt::format(", mean height {:.0f} m", land_sum / land);
    if (sea > 0.0) words += fmt::format(", mean depth {:.0f} m", -sea_sum / sea);
    return words;
  }

 private:
  std::vector<double> elevation_m_, below_;
};

constexpr Rgb kEarthInk{0.74F, 0.22F, 0.16F};
constexpr int kWidth = 1400, kHeight = 860;
constexpr double kTop = 150, kBottom = 770;
constexpr double kBinM = 250.0;

/// One panel: elevation upwards, a share of the area to the right.
struct Panel {
  double left, right;
  double low_m, high_m, most;

  [[nodiscard]] double x(double share) const { return left + (right - left) * share / most; }
  [[nodiscard]] double y(double elevation_m) const {
    return kBottom - (kBottom - kTop) * (elevation_m - low_m) / (high_m - low_m);
  }
};

Rgb tint(const ColourMap& land, const ColourMap& sea, double elevation_m) {
  const auto e = static_cast<float>(elevation_m);
  return elevation_m < 0.0 ? sea.smooth(e) : land.smooth(e);
}

void axes(Canvas& canvas, const Panel& panel, double share_step, const std::string& title,
          bool label_elevation) {
  cairo_t* pen = canvas.pen();
  canvas.font(17);
  cairo_set_line_width(pen, 1.0);
  for (double e = std::ceil(panel.low_m / 2000) * 2000; e <= panel.high_m; e += 2000) {
    canvas.colour(kInk, e == 0.0 ? 0.7 : 0.15);
    cairo_move_to(pen, panel.left, panel.y(e));
    cairo_line_to(pen, panel.right, panel.y(e));
    cairo_stroke(pen);
    canvas.colour(kInk);
    if (label_elevation) {
      canvas.text(panel.left - 12, panel.y(e) + 6, label_of(e) + (e == 0.0 ? " m" : ""),
                  Align::right);
    }
  }
  for (double share = 0.0; share <= panel.most + 1e-9; share += share_step) {
    canvas.colour(kInk, 0.12);
    cairo_move_to(pen, panel.x(share), kTop);
    cairo_line_to(pen, panel.x(share), kBottom);
    cairo_stroke(pen);
    canvas.colour(kInk);
    canvas.text(panel.x(share), kBottom + 26, label_of(100.0 * share), Align::centre);
  }
  canvas.colour(kFaintInk);
  canvas.text(0.5 * (panel.left + panel.right), kBottom + 58, title, Align::centre);
  canvas.colour(kInk);
  cairo_set_line_width(pen, 1.5);
  canvas.rectangle(panel.left, kTop, panel.right - panel.left, kBottom - kTop);
  cairo_stroke(pen);
}

void curve(Canvas& canvas, const Panel& panel, const Hypsometry& hypsometry) {
  for (std::size_t i = hypsometry.below().size(); i-- > 0;) {
    cairo_line_to(canvas.pen(), panel.x(1.0 - hypsometry.below()[i]),
                  panel.y(hypsometry.elevations_m()[i]));
  }
}

void cumulative(Canvas& canvas, const Panel& panel, const Hypsometry& planet,
                const Hypsometry& earth, const ColourMap& land, const ColourMap& sea) {
  cairo_t* pen = canvas.pen();
  cairo_pattern_t* ramp = cairo_pattern_create_linear(0, kBottom, 0, kTop);
  for (const ColourMap* map : {&sea, &land}) {
    for (const auto& stop : map->stops()) {
      const double at = (stop.value - panel.low_m) / (panel.high_m - panel.low_m);
      if (at >= 0.0 && at <= 1.0) {
        cairo_pattern_add_color_stop_rgb(ramp, at, stop.colour.r, stop.colour.g, stop.colour.b);
      }
    }
  }
  cairo_move_to(pen, panel.left, kBottom);
  cairo_line_to(pen, panel.left, panel.y(planet.highest_m()));
  curve(canvas, panel, planet);
  cairo_line_to(pen, panel.right, kBottom);
  cairo_close_path(pen);
  cairo_set_source(pen, ramp);
  cairo_fill(pen);
  cairo_pattern_destroy(ramp);
  cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
  canvas.colour(kInk);
  cairo_set_line_width(pen, 2.6);
  curve(canvas, panel, planet);
  cairo_stroke(pen);
  constexpr std::array kDashes{9.0, 6.0};
  cairo_set_dash(pen, kDashes.data(), kDashes.size(), 0);
  canvas.colour(kEarthInk);
  curve(canvas, panel, earth);
  cairo_stroke(pen);
  cairo_set_dash(pen, nullptr, 0, 0);
}

double share_of_bin(const Hypsometry& hypsometry, double low_m) {
  return hypsometry.share_below(low_m + kBinM) - hypsometry.share_below(low_m);
}

void histogram(Canvas& canvas, const Panel& panel, const Hypsometry& planet,
               const Hypsometry& earth, const ColourMap& land, const ColourMap& sea) {
  cairo_t* pen = canvas.pen();
  for (double low = panel.low_m; low < panel.high_m; low += kBinM) {
    const double top = panel.y(low + kBinM);
    canvas.colour(tint(land, sea, low + 0.5 * kBinM));
    canvas.rectangle(panel.left, top + 0.5, panel.x(share_of_bin(planet, low)) - panel.left,
                     panel.y(low) - top - 1.0);
    cairo_fill_preserve(pen);
    canvas.colour(kInk, 0.45);
    cairo_set_line_width(pen, 0.8);
    cairo_stroke(pen);
  }
  canvas.colour(kEarthInk);
  cairo_set_line_width(pen, 2.2);
  for (double low = panel.low_m; low < panel.high_m; low += kBinM) {
    const double x = panel.x(share_of_bin(earth, low));
    cairo_line_to(pen, x, panel.y(low));
    cairo_line_to(pen, x, panel.y(low + kBinM));
  }
  cairo_stroke(pen);
}

double largest_bin(const Hypsometry& planet, const Hypsometry& earth, double low_m, double high_m) {
  double most = 0.0;
  for (double low = low_m; low < high_m; low += kBinM) {
    most = std::max({most, share_of_bin(planet, low), share_of_bin(earth, low)});
  }
  return most;
}

void words(Canvas& canvas, const Hypsometry& planet, const Hypsometry& earth, double right,
           std::string_view note) {
  canvas.colour(kInk);
  canvas.font(30, true);
  const std::string title = "Hypsometry";
  canvas.text(110, 52, title);
  const double after_title = 110 + canvas.text_width(title) + 18;
  canvas.colour(kFaintInk);
  canvas.font(18);
  canvas.text(after_title, 52, "share of the true area by elevation");
  canvas.text(right, 52, std::string(note), Align::right);
  cairo_set_line_width(canvas.pen(), 2.6);
  const auto line = [&](double y, Rgb colour, bool dashed, const std::string& text) {
    constexpr std::array kDashes{9.0, 6.0};
    cairo_set_dash(canvas.pen(), kDashes.data(), dashed ? kDashes.size() : 0, 0);
    canvas.colour(colour);
    cairo_move_to(canvas.pen(), 110, y - 6);
    cairo_line_to(canvas.pen(), 160, y - 6);
    cairo_stroke(canvas.pen());
    cairo_set_dash(canvas.pen(), nullptr, 0, 0);
    canvas.colour(kInk);
    canvas.text(174, y, text);
  };
  line(94, kInk, false, "This planet: " + planet.in_words());
  line(124, kEarthInk, true, "Earth (ETOPO5): " + earth.in_words());
}

}  // namespace

MapFile draw_hypsometry_file(const State& state, const std::filesystem::path& folder,
                             std::string_view note) {
  make_folder(folder);
  const auto planet = Hypsometry::of_relief(state.grid(), state.read(field::elevation));
  const auto earth = Hypsometry::of_earth();
  const ColourMap land("land_elevation"), sea("sea_depth");
  const double low = std::floor(std::min(planet.lowest_m(), earth.lowest_m()) / 1000.0) * 1000.0;
  const double high = std::ceil(std::max(planet.highest_m(), earth.highest_m()) / 1000.0) * 1000.0;
  const double most = largest_bin(planet, earth, low, high);
  const double step = round_down_nicely(most / 3.0);

  Canvas canvas(kWidth, kHeight);
  const Panel shares{110, 900, low, high, 1.0};
  const Panel bins{950, 1350, low, high, std::ceil(most / step) * step};
  cumulative(canvas, shares, planet, earth, land, sea);
  histogram(canvas, bins, planet, earth, land, sea);
  axes(canvas, shares, 0.1, "% of the area lies higher", true);
  axes(canvas, bins, step, "% of the area in each 250 m", false);
  words(canvas, planet, earth, bins.right, note);
  const auto path = folder / "hypsometry.png";
  canvas.save(path);
  return {path, "Hypsometry",
          "Share of the area above each elevation, and in each 250 m, beside Earth's.", kWidth,
          kHeight};
}

std::filesystem::path draw_hypsometry(const State& state, const std::filesystem::path& folder) {
  return draw_hypsometry_file(state, folder).path;
}

}  // namespace geo::io
