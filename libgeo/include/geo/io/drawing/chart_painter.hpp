#pragma once

#include <functional>
#include <string>

#include "geo/io/drawing/chart.hpp"

namespace geo::io {

enum class Align { left, centre, right };

/// A rectangle of a picture, in its own units; y goes down.
struct Box {
  double left, top, right, bottom;
};

/// What a chart is drawn with: colours, type and the file are its own.
class ChartPen {
 public:
  enum class Line { grid, level };
  enum class Text { tick, level, title };

  virtual ~ChartPen() = default;
  virtual void line(double x0, double y0, double x1, double y1, Line kind) = 0;
  virtual void border(const Box& box) = 0;
  /// Text whose baseline is at y.
  virtual void text(double x, double y, const std::string& text, Align align, Text kind) = 0;
  /// Text that reads upwards, centred on a place of its baseline.
  virtual void upright_text(double x, double y, const std::string& text) = 0;
  /// A series in its places on the picture; those that are not finite break it.
  virtual void series(const Series& series) = 0;
  /// Draws so that what leaves `box` is cut off.
  virtual void inside(const Box& box, const std::function<void()>& draw) = 0;
};

/// Where the panels of a chart stand. `em`, the size of the type, sets the room between things.
struct ChartLayout {
  double left, right, top;
  double panel_height;  ///< of a panel of height 1
  double gap;           ///< between panels
  double em;
};

/// Where the last panel ends; labels and title of its x axis follow within `kChartFoot_em`.
double chart_bottom(const Chart& chart, const ChartLayout& layout);
inline constexpr double kChartFoot_em = 4.2;

/// Draws the panels of a chart: grid, ticks, titles of axes, levels, series. Its title, notes and
/// legend stand elsewhere.
void paint_panels(const Chart& chart, const ChartLayout& layout, ChartPen& pen);

}  // namespace geo::io
