#include "report_scorecard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace geo::io {
namespace {

/// Four figures, without an exponent.
std::string shown(double value) {
  if (value == 0.0) return "0";
  const int digits = std::max(0, 3 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  std::string text = fmt::format("{:.{}f}", value, std::min(digits, 4));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

void add_cell(pugi::xml_node row, const char* style, const std::string& text) {
  add_element(row, "td", text).append_attribute("class") = style;
}

void add_line(pugi::xml_node body, const ScoreLine& line) {
  auto row = add_element(body, "tr");
  auto name = add_element(row, "th", line.words);
  name.append_attribute("scope") = "row";
  add_cell(row, "number", shown(line.value));
  add_cell(row, "number", shown(line.earth));
  add_cell(row, "number",
           fmt::format("\u00b1 {}{}", shown(line.tolerance), line.judged ? "*" : ""));
  add_element(row, "td", line.unit == "1" ? "" : line.unit);
  const bool within = line.within();
  auto mark = add_element(row, "td", within ? "\u2713 within" : "\u2717 outside");
  mark.append_attribute("class") = within ? "within" : "outside";
}

}  // namespace

pugi::xml_node add_element(pugi::xml_node parent, const char* tag, const std::string& text) {
  auto node = parent.append_child(tag);
  if (!text.empty()) node.append_child(pugi::node_pcdata).set_value(text.c_str());
  return node;
}

void add_scorecard(pugi::xml_node main, const Scorecard& card) {
  add_element(main, "h2", "Beside Earth").append_attribute("id") = "beside-earth";
  add_element(main, "p",
              fmt::format("{} of {} figures lie within tolerance of Earth's. A star marks "
                          "tolerances that are our judgement.",
                          card.count_within(), card.lines.size()));
  auto scroll = add_element(main, "div");
  scroll.append_attribute("class") = "wide";
  auto table = add_element(scroll, "table");
  table.append_attribute("class") = "scorecard";
  auto heads = add_element(add_element(table, "thead"), "tr");
  for (const char* head : {"figure", "planet", "Earth", "tolerance", "unit", ""}) {
    add_element(heads, "th", head).append_attribute("scope") = "col";
  }
  pugi::xml_node body;
  std::string group;
  for (const auto& line : card.lines) {
    if (line.group != group) {
      group = line.group;
      body = add_element(table, "tbody");
      auto title = add_element(add_element(body, "tr"), "th", group);
      title.append_attribute("class") = "group";
      title.append_attribute("colspan") = 6;
      title.append_attribute("scope") = "rowgroup";
    }
    add_line(body, line);
  }
  if (card.left_out.empty()) return;
  auto details = add_element(main, "details");
  details.append_attribute("class") = "small";
  add_element(details, "summary", "Figures left out");
  auto list = add_element(details, "ul");
  for (const auto& sentence : card.left_out) add_element(list, "li", sentence);
}

}  // namespace geo::io
