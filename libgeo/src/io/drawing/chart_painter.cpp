#include "geo/io/drawing/chart_painter.hpp"

#include <algorithm>

namespace geo::io {
namespace {

/// A panel in its place on the picture.
struct PlacedPanel {
  const ChartPanel& panel;
  Box box;
  double em;

  [[nodiscard]] double x(double value) const {
    return box.left + (box.right - box.left) * panel.x.position(value);
  }
  [[nodiscard]] double y(double value) const {
    return box.bottom - (box.bottom - box.top) * panel.y.position(value);
  }
  /// As many ticks as labels have room for.
  [[nodiscard]] std::vector<double> x_ticks() const {
    return panel.x.ticks(static_cast<int>((box.right - box.left) / (5.5 * em)));
  }
  [[nodiscard]] std::vector<double> y_ticks() const {
    return panel.y.ticks(std::max(4, static_cast<int>((box.bottom - box.top) / (3.5 * em))));
  }
};

void paint_axes(const PlacedPanel& at, bool label_x, ChartPen& pen) {
  const Box& box = at.box;
  for (const double value : at.y_ticks()) {
    pen.line(box.left, at.y(value), box.right, at.y(value), ChartPen::Line::grid);
    pen.text(box.left - 0.6 * at.em, at.y(value) + 0.35 * at.em, tick_label(value), Align::right,
             ChartPen::Text::tick);
  }
  for (const double value : at.x_ticks()) {
    pen.line(at.x(value), box.top, at.x(value), box.bottom, ChartPen::Line::grid);
    if (!label_x) continue;
    pen.text(at.x(value), box.bottom + 1.5 * at.em, tick_label(value), Align::centre,
             ChartPen::Text::tick);
  }
  if (label_x) {
    pen.text(0.5 * (box.left + box.right), box.bottom + 3.3 * at.em, at.panel.x.title,
             Align::centre, ChartPen::Text::title);
  }
  if (at.panel.y.title.empty()) return;
  pen.upright_text(1.7 * at.em, 0.5 * (box.top + box.bottom), at.panel.y.title);
}

void paint_level(const PlacedPanel& at, const Level& level, ChartPen& pen) {
  const double y = at.y(level.y);
  pen.line(at.box.left, y, at.box.right, y, ChartPen::Line::level);
  if (level.label.empty()) return;
  pen.text(at.box.right - 0.6 * at.em, y - 0.45 * at.em, level.label, Align::right,
           ChartPen::Text::level);
}

void paint_series(const PlacedPanel& at, Series series, ChartPen& pen) {
  for (double& x : series.x) x = at.x(x);
  for (double& y : series.y) y = at.y(y);
  pen.series(series);
}

}  // namespace

double chart_bottom(const Chart& chart, const ChartLayout& layout) {
  double bottom = layout.top - layout.gap;
  for (const ChartPanel& panel : chart.panels) {
    bottom += layout.gap + layout.panel_height * panel.height;
  }
  return bottom;
}

void paint_panels(const Chart& chart, const ChartLayout& layout, ChartPen& pen) {
  double top = layout.top;
  for (const ChartPanel& panel : chart.panels) {
    const double bottom = top + layout.panel_height * panel.height;
    const PlacedPanel at{panel, {layout.left, top, layout.right, bottom}, layout.em};
    paint_axes(at, /*label_x=*/&panel == &chart.panels.back(), pen);
    pen.inside(at.box, [&] {
      for (const Level& level : panel.levels) paint_level(at, level, pen);
      for (const Series& series : panel.series) paint_series(at, series, pen);
    });
    pen.border(at.box);
    top = bottom + layout.gap;
  }
}

}  // namespace geo::io
