#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

namespace geo::calibration {

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

/// An element below another, with its attributes and a text in it.
pugi::xml_node add(pugi::xml_node parent, const char* tag, const std::string& text = {},
                   Attributes attributes = {});

/// A cell of a table and how it is set.
struct Cell {
  std::string text;
  const char* style = "";  ///< class: "number", "within", "outside"
};

/// Numbers stand in cells of class "number".
Cell number_cell(double value, int digits = 3);

/// A table that scrolls by itself where the page is narrow. The first cell of each row is its head.
pugi::xml_node add_table(pugi::xml_node parent, const std::vector<std::string>& heads,
                         const std::vector<std::vector<Cell>>& rows);

/// A part of the page that the reader opens. Returns its node.
pugi::xml_node add_details(pugi::xml_node parent, const std::string& summary);

/// A figure; the picture goes into the returned node's place `figure.prepend_child`.
pugi::xml_node add_figure(pugi::xml_node parent, const std::string& title,
                          const std::string& caption);

}  // namespace geo::calibration
