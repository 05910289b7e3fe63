#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geo/io/drawing/chart.hpp"
#include "map_canvas.hpp"

namespace geo::io {
namespace {

constexpr int kWidth = 1400;
constexpr double kLeft = 130, kRight = 1360;
constexpr double kTitleBaseline = 52, kLineHeight = 28, kLegendHeight = 44;
constexpr double kUnitHeight = 560, kGap = 46, kFoot = 84;

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

/// A panel in its place on the canvas.
struct Frame {
  const ChartPanel& panel;
  double top, bottom;

  [[nodiscard]] double x(double value) const {
    return kLeft + (kRight - kLeft) * panel.x.position(value);
  }
  [[nodiscard]] double y(double value) const {
    return bottom - (bottom - top) * panel.y.position(value);
  }
};

void begin_stroke(Canvas& canvas, const Series& series) {
  constexpr std::array kDashes{12.0, 7.0};
  cairo_new_path(canvas.pen());  // text leaves a point behind
  canvas.colour(colour_of(series.hue));
  cairo_set_line_join(canvas.pen(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(canvas.pen(), series.hue == Hue::grey ? 3.0 : 3.6);
  cairo_set_dash(canvas.pen(), kDashes.data(), series.stroke == Stroke::dashed ? 2 : 0, 0);
}

void end_stroke(Canvas& canvas) {
  cairo_stroke(canvas.pen());
  cairo_set_dash(canvas.pen(), nullptr, 0, 0);
}

void dot(Canvas& canvas, double x, double y) {
  cairo_new_sub_path(canvas.pen());
  cairo_arc(canvas.pen(), x, y, 5.0, 0.0, 2.0 * std::numbers::pi);
  cairo_fill(canvas.pen());
}

void draw_series(Canvas& canvas, const Frame& frame, const Series& series) {
  begin_stroke(canvas, series);
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double x = frame.x(series.x[i]), y = frame.y(series.y[i]);
    if (!std::isfinite(x) || !std::isfinite(y)) {
      end_stroke(canvas);
      begin_stroke(canvas, series);
    } else if (series.stroke == Stroke::dots) {
      dot(canvas, x, y);
    } else {
      cairo_line_to(canvas.pen(), x, y);
    }
  }
  end_stroke(canvas);
}

void line(Canvas& canvas, double x0, double y0, double x1, double y1) {
  cairo_move_to(canvas.pen(), x0, y0);
  cairo_line_to(canvas.pen(), x1, y1);
  cairo_stroke(canvas.pen());
}

void draw_axes(Canvas& canvas, const Frame& frame, bool label_x) {
  canvas.font(20);
  cairo_set_line_width(canvas.pen(), 1.0);
  for (const double value : frame.panel.y.ticks(frame.panel.height > 0.5 ? 8 : 4)) {
    canvas.colour(kInk, 0.13);
    line(canvas, kLeft, frame.y(value), kRight, frame.y(value));
    canvas.colour(kInk);
    canvas.text(kLeft - 12, frame.y(value) + 7, tick_label(value), Align::right);
  }
  for (const double value : frame.panel.x.ticks(11)) {
    canvas.colour(kInk, 0.13);
    line(canvas, frame.x(value), frame.top, frame.x(value), frame.bottom);
    canvas.colour(kInk);
    if (label_x) canvas.text(frame.x(value), frame.bottom + 30, tick_label(value), Align::centre);
  }
  canvas.colour(kFaintInk);
  if (label_x) {
    canvas.text(0.5 * (kLeft + kRight), frame.bottom + 66, frame.panel.x.title, Align::centre);
  }
  cairo_save(canvas.pen());
  cairo_translate(canvas.pen(), 34, 0.5 * (frame.top + frame.bottom));
  cairo_rotate(canvas.pen(), -0.5 * std::numbers::pi);
  canvas.text(0, 0, frame.panel.y.title, Align::centre);
  cairo_restore(canvas.pen());
}

void draw_panel(Canvas& canvas, const Frame& frame, bool label_x) {
  draw_axes(canvas, frame, label_x);
  cairo_save(canvas.pen());
  canvas.rectangle(kLeft, frame.top, kRight - kLeft, frame.bottom - frame.top);
  cairo_clip(canvas.pen());
  for (const Level& level : frame.panel.levels) {
    canvas.colour(kInk, 0.75);
    cairo_set_line_width(canvas.pen(), 1.6);
    line(canvas, kLeft, frame.y(level.y), kRight, frame.y(level.y));
    canvas.colour(kFaintInk);
    canvas.text(kRight - 12, frame.y(level.y) - 9, level.label, Align::right);
  }
  for (const Series& series : frame.panel.series) draw_series(canvas, frame, series);
  cairo_restore(canvas.pen());
  canvas.colour(kInk);
  cairo_set_line_width(canvas.pen(), 1.6);
  canvas.rectangle(kLeft, frame.top, kRight - kLeft, frame.bottom - frame.top);
  cairo_stroke(canvas.pen());
}

void draw_legend(Canvas& canvas, const ChartPanel& panel, double y) {
  double x = kLeft;
  canvas.font(21);
  for (const Series& series : panel.series) {
    if (series.name.empty()) continue;
    begin_stroke(canvas, series);
    if (series.stroke == Stroke::dots) {
      dot(canvas, x + 28, y - 7);
    } else {
      cairo_move_to(canvas.pen(), x, y - 7);
      cairo_line_to(canvas.pen(), x + 56, y - 7);
    }
    end_stroke(canvas);
    canvas.colour(kInk);
    canvas.text(x + 68, y, series.name);
    x += 68 + canvas.text_width(series.name) + 44;
  }
}

}  // namespace

void write_chart(const std::filesystem::path& path, const Chart& chart) {
  const double head = kTitleBaseline + kLineHeight * chart.notes.size() + kLegendHeight + 24;
  const double panels = std::accumulate(
      chart.panels.begin(), chart.panels.end(), 0.0,
      [](double sum, const ChartPanel& panel) { return sum + kUnitHeight * panel.height; });
  const double gaps = kGap * (chart.panels.size() - 1.0);
  Canvas canvas(kWidth, static_cast<int>(std::lround(head + panels + gaps + kFoot)));

  canvas.colour(kInk);
  canvas.font(30, true);
  canvas.text(kLeft, kTitleBaseline, chart.title);
  canvas.colour(kFaintInk);
  canvas.font(20);
  double baseline = kTitleBaseline;
  for (const auto& note : chart.notes) canvas.text(kLeft, baseline += kLineHeight, note);
  draw_legend(canvas, chart.panels.front(), baseline + kLegendHeight);

  double top = head;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const double bottom = top + kUnitHeight * chart.panels[i].height;
    draw_panel(canvas, {chart.panels[i], top, bottom}, i + 1 == chart.panels.size());
    top = bottom + kGap;
  }
  canvas.save(path);
}

}  // namespace geo::io
