#include <fmt/format.h>

#include <cmath>

#include "calibration/report/report_markup.hpp"
#include "calibration/report/svg_picture.hpp"
#include "geo/io/drawing/chart_painter.hpp"

namespace geo::calibration {
namespace {

using io::Align;
using io::Box;
using io::Hue;
using io::Series;
using io::Stroke;

std::string at(double value) { return fmt::format("{:.1f}", value); }

std::string style_of(const Series& series) {
  std::string style = "ink";
  if (series.hue == Hue::grey) style = "grey";
  if (series.hue == Hue::red) style = "red";
  if (series.hue == Hue::blue) style = "blue";
  if (series.stroke == Stroke::dashed) style += " dashed";
  return style;
}

const char* anchor_of(Align align) {
  return align == Align::left ? "start" : align == Align::centre ? "middle" : "end";
}

/// Draws a chart as elements of a page, in the colours of its stylesheet.
class SvgPen final : public io::ChartPen {
 public:
  explicit SvgPen(pugi::xml_node svg) : svg_(svg) {}

  void line(double x0, double y0, double x1, double y1, Line kind) override {
    add(svg_, "line", {},
        {{"x1", at(x0)},
         {"y1", at(y0)},
         {"x2", at(x1)},
         {"y2", at(y1)},
         {"class", kind == Line::grid ? "grid" : "level"}});
  }
  void border(const Box& box) override { add_box("rect", box, "class", "border"); }
  void text(double x, double y, const std::string& text, Align align, Text kind) override {
    add(svg_, "text", text,
        {{"x", at(x)},
         {"y", at(y)},
         {"text-anchor", anchor_of(align)},
         {"class", kind == Text::title ? "title" : "label"}});
  }
  void upright_text(double x, double y, const std::string& text) override {
    add(svg_, "text", text,
        {{"transform", fmt::format("translate({:.1f} {:.1f}) rotate(-90)", x, y)},
         {"text-anchor", "middle"},
         {"class", "title"}});
  }
  void series(const Series& series) override {
    const std::string style = style_of(series);
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const double x = series.x[i], y = series.y[i];
      const bool is_there = std::isfinite(x) && std::isfinite(y);
      if (is_there && series.stroke == Stroke::dots) {
        add(svg_, "circle", {}, {{"cx", at(x)}, {"cy", at(y)}, {"r", "3.2"}, {"class", style}});
      } else if (is_there) {
        path += fmt::format("{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', x, y);
      }
      pen_down = is_there;
    }
    if (!path.empty()) add(svg_, "path", {}, {{"d", path}, {"class", style}});
  }
  /// A nested picture cuts off what leaves it; it keeps the coordinates of the outer one.
  void inside(const Box& box, const std::function<void()>& draw) override {
    const pugi::xml_node outer = svg_;
    svg_ = add_box("svg", box, "viewBox",
                   fmt::format("{:.1f} {:.1f} {:.1f} {:.1f}", box.left, box.top,
                               box.right - box.left, box.bottom - box.top));
    draw();
    svg_ = outer;
  }

 private:
  pugi::xml_node add_box(const char* tag, const Box& box, const char* key,
                         const std::string& value) {
    return add(svg_, tag, {},
               {{"x", at(box.left)},
                {"y", at(box.top)},
                {"width", at(box.right - box.left)},
                {"height", at(box.bottom - box.top)},
                {key, value}});
  }

  pugi::xml_node svg_;
};

/// Outside the picture, as lines of text break where the page is narrow.
void add_legend(pugi::xml_node figure, const io::ChartPanel& panel) {
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
    Series sample{{}, {1, 29}, {5, 5}, series.hue, series.stroke};
    if (series.stroke == Stroke::dots) sample.x = {15}, sample.y = {5};
    SvgPen(swatch).series(sample);
    item.append_child(pugi::node_pcdata).set_value((" " + series.name).c_str());
  }
}

}  // namespace

void draw_chart(pugi::xml_node figure, const io::Chart& chart, const SvgSize& size) {
  const io::ChartLayout layout{.left = 96,
                               .right = size.width - 26,
                               .top = 10,
                               .panel_height = size.height,
                               .gap = 22,
                               .em = 12};
  const double height = io::chart_bottom(chart, layout) + io::kChartFoot_em * layout.em;
  auto svg = add(figure, "svg", {},
                 {{"viewBox", fmt::format("0 0 {} {:.0f}", size.width, height)},
                  {"class", size.style},
                  {"role", "img"},
                  {"aria-label", chart.title}});
  figure.prepend_move(svg);
  SvgPen pen(svg);
  io::paint_panels(chart, layout, pen);
  add_legend(figure, chart.panels.front());
}

}  // namespace geo::calibration
