#include "calibration/report/report_markup.hpp"

#include "calibration/report/report_words.hpp"

namespace geo::calibration {

pugi::xml_node add(pugi::xml_node parent, const char* tag, const std::string& text,
                   Attributes attributes) {
  auto node = parent.append_child(tag);
  for (const auto& [name, value] : attributes) node.append_attribute(name) = value.c_str();
  if (!text.empty()) node.append_child(pugi::node_pcdata).set_value(text.c_str());
  return node;
}

Cell number_cell(double value, int digits) { return {shown(value, digits), "number"}; }

pugi::xml_node add_table(pugi::xml_node parent, const std::vector<std::string>& heads,
                         const std::vector<std::vector<Cell>>& rows) {
  auto table = add(add(parent, "div", {}, {{"class", "wide"}}), "table");
  auto head_row = add(add(table, "thead"), "tr");
  for (const auto& head : heads) add(head_row, "th", head, {{"scope", "col"}});
  auto body = add(table, "tbody");
  for (const auto& cells : rows) {
    auto row = add(body, "tr");
    for (const Cell& cell : cells) {
      const bool first = &cell == &cells.front();
      auto node = add(row, first ? "th" : "td", cell.text);
      if (first) node.append_attribute("scope") = "row";
      if (cell.style[0] != '\0') node.append_attribute("class") = cell.style;
    }
  }
  return table;
}

pugi::xml_node add_details(pugi::xml_node parent, const std::string& summary) {
  auto details = add(parent, "details", {}, {{"class", "small"}});
  add(details, "summary", summary);
  return details;
}

pugi::xml_node add_figure(pugi::xml_node parent, const std::string& title,
                          const std::string& caption) {
  auto figure = add(parent, "figure");
  auto words = add(figure, "figcaption");
  if (!title.empty()) add(words, "strong", title);
  words.append_child(pugi::node_pcdata).set_value((" " + caption).c_str());
  return figure;
}

}  // namespace geo::calibration
