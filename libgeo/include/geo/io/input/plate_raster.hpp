#pragma once

#include <string>
#include <vector>

#include "geo/core/initial_conditions.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/input/table.hpp"

namespace geo::io {

/// Plates of a raster of their numbers, in the order of these, with the motions of a table.
///
/// `numbers` holds a whole number for each cell, NaN for cells of no plate. `rotations` has the
/// columns plate_id, pole_latitude_deg, pole_longitude_deg and rate_deg_myr (anticlockwise), and
/// others as it likes; of several rows for one plate the last counts, so that the rotations which a
/// drift leaves, step by step, give the motions at its end. The outline of a plate is made of the
/// edges of its cells. Throws InputError that names the file and what is wrong: no whole number,
/// fewer than 2 or more than 200 plates, a plate without a row, a pole or rate out of range.
[[nodiscard]] std::vector<PlateOutline> plates_of_raster(const Dem& numbers,
                                                         const Table& rotations);

}  // namespace geo::io
