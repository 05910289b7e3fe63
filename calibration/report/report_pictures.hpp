#pragma once

#include <pugixml.hpp>

#include "calibration/result.hpp"

namespace geo::calibration {

void add_curve_picture(pugi::xml_node section, const Result& result);
void add_residual_picture(pugi::xml_node section, const Result& result);
/// Cost of every start, step by step.
void add_convergence_picture(pugi::xml_node section, const Result& result);
void add_correlation_picture(pugi::xml_node section, const Result& result);
void add_direction_picture(pugi::xml_node section, const Result& result);
void add_profile_pictures(pugi::xml_node section, const Result& result);

}  // namespace geo::calibration
