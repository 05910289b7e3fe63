#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "calibration/report/report_markup.hpp"
#include "calibration/report/svg_picture.hpp"

namespace geo::calibration {
namespace {

using io::ChartPanel;
using io::Hue;
using io::Series;
using io::Stroke;

constexpr double kLeft = 96, kRight = 26, kTop = 10, kFoot = 50, kGap = 22;

std::string at(double value) { return fmt::format("{:.1f}", value); }

std::string style_of(const Series& series) {
  std::string style = "ink";
  if (series.hue == Hue::grey) style = "grey";
  if (series.hue == Hue::red) style = "red";
  if (series.hue == Hue::blue) style = "blue";
  if (series.stroke == Stroke::dashed) style += " dashed";
  return style;
}

/// A panel in its place in the picture.
struct Frame {
  const ChartPanel& panel;
  double left, right, top, bottom;

  [[nodiscard]] double x(double value) const {
    return left + (right - left) * panel.x.position(value);
  }
  [[nodiscard]] double y(double value) const {
    return bottom - (bottom - top) * panel.y.position(value);
  }
};

void add_text(pugi::xml_node svg, double x, double y, const std::string& text, const char* anchor,
              const char* style = "label") {
  add(svg, "text", text, {{"x", at(x)}, {"y", at(y)}, {"text-anchor", anchor}, {"class", style}});
}

void add_line(pugi::xml_node svg, double x0, double y0, double x1, double y1, const char* style) {
  add(svg, "line", {},
      {{"x1", at(x0)}, {"y1", at(y0)}, {"x2", at(x1)}, {"y2", at(y1)}, {"class", style}});
}

void add_series(pugi::xml_node svg, const Frame& frame, const Series& series) {
  const std::string style = style_of(series);
  std::string path;
  bool pen_down = false;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double x = frame.x(series.x[i]), y = frame.y(series.y[i]);
    if (!std::isfinite(x) || !std::isfinite(y)) {
      pen_down = false;
      continue;
    }
    if (series.stroke == Stroke::dots) {
      add(svg, "circle", {}, {{"cx", at(x)}, {"cy", at(y)}, {"r", "3.2"}, {"class", style}});
    } else {
      path += fmt::format("{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', x, y);
    }
    pen_down = true;
  }
  if (!path.empty()) add(svg, "path", {}, {{"d", path}, {"class", style}});
}

void add_axes(pugi::xml_node svg, const Frame& frame, bool label_x) {
  const bool is_large = frame.right - frame.left > 400.0;
  const int rows = frame.bottom - frame.top > 200.0 ? 7 : 4;
  for (const double value : frame.panel.y.ticks(rows)) {
    add_line(svg, frame.left, frame.y(value), frame.right, frame.y(value), "grid");
    add_text(svg, frame.left - 7, frame.y(value) + 4, io::tick_label(value), "end");
  }
  for (const double value : frame.panel.x.ticks(is_large ? 6 : 4)) {
    add_line(svg, frame.x(value), frame.top, frame.x(value), frame.bottom, "grid");
    if (label_x) {
      add_text(svg, frame.x(value), frame.bottom + 18, io::tick_label(value), "middle");
    }
  }
  add(svg, "rect", {},
      {{"x", at(frame.left)},
       {"y", at(frame.top)},
       {"width", at(frame.right - frame.left)},
       {"height", at(frame.bottom - frame.top)},
       {"class", "border"}});
  if (label_x) {
    add_text(svg, 0.5 * (frame.left + frame.right), frame.bottom + 40, frame.panel.x.title,
             "middle", "title");
  }
  if (frame.panel.y.title.empty()) return;
  const double middle = 0.5 * (frame.top + frame.bottom);
  add(svg, "text", frame.panel.y.title,
      {{"transform", fmt::format("translate(15 {:.1f}) rotate(-90)", middle)},
       {"text-anchor", "middle"},
       {"class", "title"}});
}

void add_panel(pugi::xml_node svg, const Frame& frame, bool label_x) {
  add_axes(svg, frame, label_x);
  // A nested picture clips what leaves the panel.
  auto inside = add(svg, "svg", {},
                    {{"x", at(frame.left)},
                     {"y", at(frame.top)},
                     {"width", at(frame.right - frame.left)},
                     {"height", at(frame.bottom - frame.top)}});
  const Frame local{frame.panel, 0.0, frame.right - frame.left, 0.0, frame.bottom - frame.top};
  for (const io::Level& level : frame.panel.levels) {
    add_line(inside, 0.0, local.y(level.y), local.right, local.y(level.y), "level");
    if (!level.label.empty()) {
      add_text(inside, local.right - 6, local.y(level.y) - 5, level.label, "end");
    }
  }
  for (const Series& series : frame.panel.series) add_series(inside, local, series);
}

/// Outside the picture, as lines of text break where the page is narrow.
void add_legend(pugi::xml_node figure, const ChartPanel& panel) {
  pugi::xml_node legend;
  for (const Series& series : panel.series) {
    if (series.name.empty()) continue;
    if (!legend) {
      legend = figure.prepend_child("p");
      legend.append_attribute("class") = "legend";
    }
    auto item = add(legend, "span");
    auto swatch = add(item, "svg", {},
                      {{"viewBox", "0 0 30 10"}, {"class", "swatch"}, {"aria-hidden", "true"}});
    const std::string style = style_of(series);
    if (series.stroke == Stroke::dots) {
      add(swatch, "circle", {}, {{"cx", "15"}, {"cy", "5"}, {"r", "3.5"}, {"class", style}});
    } else {
      add(swatch, "path", {}, {{"d", "M1 5L29 5"}, {"class", style}});
    }
    item.append_child(pugi::node_pcdata).set_value((" " + series.name).c_str());
  }
}

}  // namespace

void draw_chart(pugi::xml_node figure, const io::Chart& chart, const SvgSize& size) {
  const double panels = std::accumulate(
      chart.panels.begin(), chart.panels.end(), 0.0,
      [&](double sum, const ChartPanel& panel) { return sum + size.height * panel.height; });
  const double height = kTop + panels + kGap * (chart.panels.size() - 1.0) + kFoot;
  auto svg = figure.prepend_child("svg");
  svg.append_attribute("viewBox") = fmt::format("0 0 {} {:.0f}", size.width, height).c_str();
  svg.append_attribute("class") = size.style;
  svg.append_attribute("role") = "img";
  svg.append_attribute("aria-label") = chart.title.c_str();
  double top = kTop;
  for (const ChartPanel& panel : chart.panels) {
    const double bottom = top + size.height * panel.height;
    add_panel(svg, {panel, kLeft, size.width - kRight, top, bottom},
              &panel == &chart.panels.back());
    top = bottom + kGap;
  }
  add_legend(figure, chart.panels.front());
}

}  // namespace geo::calibration
