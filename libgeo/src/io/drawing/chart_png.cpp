#include <array>
#include <cmath>
#include <numbers>

#include "geo/io/drawing/chart_painter.hpp"
#include "map_canvas.hpp"

namespace geo::io {
namespace {

constexpr int kWidth = 1400;
constexpr double kTitleBaseline = 52, kLineHeight = 28, kLegendHeight = 44;

Rgb colour_of(Hue hue) {
  switch (hue) {
    case Hue::grey:
      return {0.55F, 0.58F, 0.62F};
    case Hue::red:
      return {0.74F, 0.22F, 0.16F};
    case Hue::blue:
      return {0.10F, 0.38F, 0.68F};
    case Hue::ink:
      break;
  }
  return kInk;
}

/// Draws a chart with Cairo.
class CanvasPen final : public ChartPen {
 public:
  explicit CanvasPen(Canvas& canvas) : canvas_(canvas) { canvas.font(20); }

  void line(double x0, double y0, double x1, double y1, Line kind) override {
    const bool is_grid = kind == Line::grid;
    canvas_.colour(kInk, is_grid ? 0.13 : 0.75);
    cairo_set_line_width(pen(), is_grid ? 1.0 : 1.6);
    cairo_move_to(pen(), x0, y0);
    cairo_line_to(pen(), x1, y1);
    cairo_stroke(pen());
  }
  void border(const Box& box) override {
    canvas_.colour(kInk);
    cairo_set_line_width(pen(), 1.6);
    trace(box);
    cairo_stroke(pen());
  }
  void text(double x, double y, const std::string& text, Align align, Text kind) override {
    canvas_.colour(kind == Text::tick ? kInk : kFaintInk);
    canvas_.text(x, y, text, align);
  }
  void upright_text(double x, double y, const std::string& text) override {
    canvas_.colour(kFaintInk);
    cairo_save(pen());
    cairo_translate(pen(), x, y);
    cairo_rotate(pen(), -0.5 * std::numbers::pi);
    canvas_.text(0, 0, text, Align::centre);
    cairo_restore(pen());
  }
  void series(const Series& series) override {
    begin_stroke(series);
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const double x = series.x[i], y = series.y[i];
      if (!std::isfinite(x) || !std::isfinite(y)) {
        end_stroke();
        begin_stroke(series);
      } else if (series.stroke == Stroke::dots) {
        dot(x, y);
      } else {
        cairo_line_to(pen(), x, y);
      }
    }
    end_stroke();
  }
  void inside(const Box& box, const std::function<void()>& draw) override {
    cairo_save(pen());
    trace(box);
    cairo_clip(pen());
    draw();
    cairo_restore(pen());
  }

 private:
  [[nodiscard]] cairo_t* pen() const { return canvas_.pen(); }
  void trace(const Box& box) const {
    canvas_.rectangle(box.left, box.top, box.right - box.left, box.bottom - box.top);
  }
  void begin_stroke(const Series& series) {
    constexpr std::array kDashes{12.0, 7.0};
    cairo_new_path(pen());  // text leaves a point behind
    canvas_.colour(colour_of(series.hue));
    cairo_set_line_join(pen(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(pen(), series.hue == Hue::grey ? 3.0 : 3.6);
    cairo_set_dash(pen(), kDashes.data(), series.stroke == Stroke::dashed ? 2 : 0, 0);
  }
  void end_stroke() {
    cairo_stroke(pen());
    cairo_set_dash(pen(), nullptr, 0, 0);
  }
  void dot(double x, double y) {
    cairo_new_sub_path(pen());
    cairo_arc(pen(), x, y, 5.0, 0.0, 2.0 * std::numbers::pi);
    cairo_fill(pen());
  }

  Canvas& canvas_;
};

void draw_legend(Canvas& canvas, const ChartPanel& panel, double left, double y) {
  CanvasPen pen(canvas);
  canvas.font(21);
  double x = left;
  for (const Series& series : panel.series) {
    if (series.name.empty()) continue;
    Series swatch{{}, {x, x + 56}, {y - 7, y - 7}, series.hue, series.stroke};
    if (series.stroke == Stroke::dots) swatch.x = {x + 28}, swatch.y = {y - 7};
    pen.series(swatch);
    canvas.colour(kInk);
    canvas.text(x + 68, y, series.name);
    x += 68 + canvas.text_width(series.name) + 44;
  }
}

}  // namespace

void write_chart(const std::filesystem::path& path, const Chart& chart) {
  const double head = kTitleBaseline + kLineHeight * chart.notes.size() + kLegendHeight + 24;
  const ChartLayout layout{
      .left = 130, .right = 1360, .top = head, .panel_height = 560, .gap = 46, .em = 20};
  const double height = chart_bottom(chart, layout) + kChartFoot_em * layout.em;
  Canvas canvas(kWidth, static_cast<int>(std::lround(height)));

  canvas.colour(kInk);
  canvas.font(30, true);
  canvas.text(layout.left, kTitleBaseline, chart.title);
  canvas.colour(kFaintInk);
  canvas.font(20);
  double baseline = kTitleBaseline;
  for (const auto& note : chart.notes) canvas.text(layout.left, baseline += kLineHeight, note);
  draw_legend(canvas, chart.panels.front(), layout.left, baseline + kLegendHeight);

  CanvasPen pen(canvas);
  paint_panels(chart, layout, pen);
  canvas.save(path);
}

}  // namespace geo::io
