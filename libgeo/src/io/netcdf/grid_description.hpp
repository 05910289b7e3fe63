#pragma once

#include "geo/core/grid.hpp"
#include "netcdf_file.hpp"

namespace geo::io {

/// Ids of what a stage file says about its grid.
struct GridVariables {
  int row_dimension = -1;
  int column_dimension = -1;
  bool has_mapping = false;      ///< variable `crs`
  bool has_coordinates = false;  ///< auxiliary `lat` and `lon` of a plane
};

/// Defines dimensions, coordinates with bounds, cell areas, the grid mapping, and the global
/// attributes from which `read_grid` builds the very same grid again.
GridVariables define_grid(const nc::File& file, const Grid& grid);
/// Writes the values of those variables; cell areas are left to `row_areas`.
void write_coordinates(const nc::File& file, const Grid& grid);
/// Gives a grid mapping the figure of its planet, a sphere or an ellipsoid.
void put_figure(const nc::File& file, int mapping, const Ellipsoid& figure);
/// Area of the cells of each row, m2.
std::vector<double> row_areas(const Grid& grid);

/// The grid of a stage file. Throws InputError without the path when the description is missing
/// or makes no sense.
Grid read_grid(const nc::File& file);

/// Names of the row and column dimensions.
struct DimensionNames {
  const char* row;
  const char* column;
};
DimensionNames dimension_names(const Grid& grid);

inline constexpr const char* kCellArea = "cell_area";
inline constexpr const char* kMapping = "crs";

}  // namespace geo::io
