#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/report/report_markup.hpp"
#include "calibration/report/svg_picture.hpp"

namespace geo::calibration {
namespace {

constexpr double kCell = 46, kHead = 26, kLetter = 7.4;

/// As many decimals as a square has room for.
std::string number_in_square(double value) {
  if (!std::isfinite(value)) return "–";
  const std::string digits = fmt::format("{:.2f}", std::abs(value));
  return value < 0.0 && digits != "0.00" ? "\u2212" + digits : digits;
}

std::string at(double value) { return fmt::format("{:.1f}", value); }

void add_cell(pugi::xml_node svg, double x, double y, double value) {
  auto square = add(svg, "rect", {},
                    {{"x", at(x + 1)},
                     {"y", at(y + 1)},
                     {"width", at(kCell - 2)},
                     {"height", at(kCell - 2)},
                     {"rx", "4"},
                     {"class", value < 0.0 ? "fill-blue" : "fill-red"}});
  // Never so dark that the number in it is hard to read.
  const double strength = std::isfinite(value) ? std::min(std::abs(value), 1.0) : 0.0;
  square.append_attribute("fill-opacity") = fmt::format("{:.2f}", 0.04 + 0.6 * strength).c_str();
  add(svg, "text", number_in_square(value),
      {{"x", at(x + 0.5 * kCell)},
       {"y", at(y + 0.5 * kCell + 4)},
       {"text-anchor", "middle"},
       {"class", "value"}});
}

}  // namespace

void draw_matrix(pugi::xml_node figure, const std::string& title,
                 const std::vector<std::string>& rows,
                 const std::vector<std::vector<double>>& values) {
  std::size_t longest = 0, columns = 0;
  for (const auto& row : rows) longest = std::max(longest, row.size());
  for (const auto& row : values) columns = std::max(columns, row.size());
  const double left = kLetter * static_cast<double>(longest) + 12;
  const double width = left + kCell * static_cast<double>(columns) + 2;
  const double height = kHead + kCell * static_cast<double>(rows.size()) + 2;
  auto scroll = figure.prepend_child("div");
  scroll.append_attribute("class") = "wide";
  auto svg = add(scroll, "svg", {},
                 {{"viewBox", fmt::format("0 0 {:.0f} {:.0f}", width, height)},
                  {"class", "matrix"},
                  {"style", fmt::format("width: {:.0f}px", width)},
                  {"role", "img"},
                  {"aria-label", title}});
  for (std::size_t j = 0; j < columns; ++j) {
    add(svg, "text", fmt::format("{}", j + 1),
        {{"x", at(left + (static_cast<double>(j) + 0.5) * kCell)},
         {"y", at(kHead - 8)},
         {"text-anchor", "middle"},
         {"class", "label"}});
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = kHead + kCell * static_cast<double>(i);
    add(svg, "text", rows[i],
        {{"x", at(left - 8)},
         {"y", at(y + 0.5 * kCell + 4)},
         {"text-anchor", "end"},
         {"class", "label"}});
    for (std::size_t j = 0; j < values[i].size(); ++j) {
      add_cell(svg, left + kCell * static_cast<double>(j), y, values[i][j]);
    }
  }
}

}  // namespace geo::calibration
