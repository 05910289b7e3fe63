#pragma once

#include <pugixml.hpp>
#include <string>

#include "geo/io/score/scorecard.hpp"

namespace geo::io {

/// An element with a text in it, below another.
pugi::xml_node add_element(pugi::xml_node parent, const char* tag, const std::string& text = {});

/// The scorecard as a section of the report: a table by groups, what lies within Earth's tolerance
/// marked by sign and colour.
void add_scorecard(pugi::xml_node main, const Scorecard& card);

}  // namespace geo::io
