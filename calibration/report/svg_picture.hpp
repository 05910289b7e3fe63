#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "geo/io/drawing/chart.hpp"

namespace geo::calibration {

/// How large a picture is drawn: its size in its own units, and whether its type may grow where the
/// page is narrow (class "chart" of the stylesheet) or stays ("small").
struct SvgSize {
  double width, height;
  const char* style;
};
inline constexpr SvgSize kWideChart{720, 330, "chart"};
inline constexpr SvgSize kSmallChart{330, 210, "small"};

/// Puts a chart as SVG before the first child of `figure`. Colours come from the page's stylesheet,
/// so that the picture suits a light and a dark page. `size.height` is that of a panel of height 1.
void draw_chart(pugi::xml_node figure, const io::Chart& chart, const SvgSize& size);

/// Numbers from -1 to 1 as a matrix of coloured squares, blue below and red above 0. Rows carry
/// their names, columns their numbers from 1.
void draw_matrix(pugi::xml_node figure, const std::string& title,
                 const std::vector<std::string>& rows,
                 const std::vector<std::vector<double>>& values);

}  // namespace geo::calibration
