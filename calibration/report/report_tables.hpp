#pragma once

#include <pugixml.hpp>

#include "calibration/result.hpp"

namespace geo::calibration {

void add_parameter_table(pugi::xml_node section, const Result& result);
/// All residuals in units of their deviation; further terms first, the curve folded away.
void add_residual_tables(pugi::xml_node section, const Result& result);
/// Means and spread of each group of planets, then seed by seed.
void add_misfit_tables(pugi::xml_node section, const Result& result);
void add_iteration_table(pugi::xml_node section, const Result& result);
void add_start_table(pugi::xml_node section, const Result& result);
void add_direction_table(pugi::xml_node section, const Result& result);

}  // namespace geo::calibration
