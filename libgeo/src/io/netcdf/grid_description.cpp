#include "grid_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/projection.hpp"
#include "geo/kernels/remapping/resample.hpp"
#include "io/drawing/map_projection.hpp"

namespace geo::io {
namespace {

constexpr const char* kTopology = "terrane_grid";
constexpr const char* kEdges = "terrane_grid_edges";
constexpr const char* kSpacing = "terrane_grid_spacing_m";
constexpr const char* kWindow = "terrane_grid_window_deg";
constexpr const char* kCentre = "terrane_grid_centre_deg";
constexpr const char* kRadius = "terrane_grid_radius_m";
constexpr const char* kTurn = "terrane_grid_turn";
constexpr const char* kFlattening = "terrane_grid_flattening";

struct CoordinateNames {
  const char *name, *bounds, *standard_name, *long_name, *units;
};
constexpr CoordinateNames kLatitude{"lat", "lat_bnds", "latitude", "latitude of cell centres",
                                    "degrees_north"};
constexpr CoordinateNames kLongitude{"lon", "lon_bnds", "longitude", "longitude of cell centres",
                                     "degrees_east"};
// No standard name and no axis: the plane has no map projection, and clients that take it for one
// would wrap it onto a sphere.
constexpr CoordinateNames kY{"y", "y_bnds", "", "distance northwards from the middle", "m"};
constexpr CoordinateNames kX{"x", "x_bnds", "", "distance eastwards from the middle", "m"};

// Without `axis`: ParaView would wrap the map onto a sphere.
constexpr CoordinateNames kNorthing{"y", "y_bnds", "projection_y_coordinate", "northing", "m"};
constexpr CoordinateNames kEasting{"x", "x_bnds", "projection_x_coordinate", "easting", "m"};

CoordinateNames row_names(const Grid& grid) {
  return grid.is_latitude_longitude() ? kLatitude : grid.is_projected() ? kNorthing : kY;
}
CoordinateNames column_names(const Grid& grid) {
  return grid.is_latitude_longitude() ? kLongitude : grid.is_projected() ? kEasting : kX;
}

void define_coordinate(const nc::File& file, const CoordinateNames& names, int dimension,
                       int bounds_dimension) {
  const int variable = file.define_variable(names.name, NC_DOUBLE, std::array{dimension});
  file.put(variable, "standard_name", names.standard_name);
  file.put(variable, "long_name", names.long_name);
  file.put(variable, "units", names.units);
  file.put(variable, "bounds", names.bounds);
  file.define_variable(names.bounds, NC_DOUBLE, std::array{dimension, bounds_dimension});
}

void define_mapping(const nc::File& file, const Grid& grid) {
  const Ellipsoid& figure = grid.figure();
  const int crs = file.define_variable(kMapping, NC_INT, {});
  if (grid.is_projected()) {
    file.put(crs, "grid_mapping_name", "lambert_azimuthal_equal_area");
    file.put(crs, "latitude_of_projection_origin", grid.centre()->latitude_deg);
    file.put(crs, "longitude_of_projection_origin", grid.centre()->longitude_deg);
    file.put(crs, "false_easting", 0.0);
    file.put(crs, "false_northing", 0.0);
    file.put(crs, "crs_wkt", equal_area_wkt(*grid.centre(), figure));
  } else {
    file.put(crs, "grid_mapping_name", "latitude_longitude");
  }
  file.put(crs, "longitude_of_prime_meridian", 0.0);
  put_figure(file, crs, figure);
}

constexpr std::size_t kCorners = 4, kCornerRows = 64;  // of a cell; written and compressed together

void define_plane_positions(const nc::File& file, const Grid& grid, const GridVariables& ids) {
  const int corners = grid.is_projected() ? file.define_dimension("corners", kCorners) : -1;
  for (const CoordinateNames& names : {kLatitude, kLongitude}) {
    const int variable = file.define_variable(names.name, NC_DOUBLE,
                                              std::array{ids.row_dimension, ids.column_dimension});
    file.put(variable, "standard_name", names.standard_name);
    file.put(variable, "long_name", names.long_name);
    file.put(variable, "units", names.units);
    nc::check(nc_def_var_deflate(file.id(), variable, 1, 1, 1));
    if (!grid.is_projected()) continue;
    file.put(variable, "bounds", names.bounds);
    const int bounds = file.define_variable(
        names.bounds, NC_DOUBLE, std::array{ids.row_dimension, ids.column_dimension, corners});
    const std::array chunks{std::min<std::size_t>(grid.ny(), kCornerRows),
                            std::min<std::size_t>(grid.nx(), 4 * kCornerRows), kCorners};
    nc::check(nc_def_var_chunking(file.id(), bounds, NC_CHUNKED, chunks.data()));
    nc::check(nc_def_var_deflate(file.id(), bounds, 1, 1, 1));
  }
}

void put_rebuilding_attributes(const nc::File& file, const Grid& grid) {
  const auto put = [&](const char* name, auto... values) {
    const std::array<double, sizeof...(values)> array{values...};
    file.put(NC_GLOBAL, name, array);
  };
  const bool window = grid.topology() == Topology::plane && grid.is_latitude_longitude();
  file.put(NC_GLOBAL, kTopology,
           window                                ? "window"
           : grid.is_projected()                 ? "equal_area"
           : grid.topology() == Topology::plane  ? "plane"
           : grid.topology() == Topology::sphere ? "sphere"
                                                 : "torus");
  if (grid.topology() == Topology::plane) {
    file.put(NC_GLOBAL, kEdges, grid.edges() == Edges::open ? "open" : "closed");
  }
  if (window) {
    const Window& w = grid.window();
    put(kWindow, w.south_deg, w.north_deg, w.west_deg, w.east_deg);
  }
  if (!grid.is_latitude_longitude()) {
    put(kSpacing, grid.spacing_east_m(0), grid.step_north_m());
  }
  if (const auto& centre = grid.centre()) put(kCentre, centre->latitude_deg, centre->longitude_deg);
  put(kRadius, grid.figure().radius_m);
  put(kFlattening, grid.figure().flattening);
  const auto& turn = grid.turn();
  if (turn != std::array<double, 3>{}) put(kTurn, turn[0], turn[1], turn[2]);
}

void write_axis(const nc::File& file, const CoordinateNames& names, const Axis& axis) {
  std::vector<double> bounds;
  for (int i = 0; i < axis.size(); ++i) {
    bounds.push_back(axis.edges[i]);
    bounds.push_back(axis.edges[i + 1]);
  }
  nc::check(nc_put_var_double(file.id(), *file.find_variable(names.name), axis.centres.data()));
  nc::check(nc_put_var_double(file.id(), *file.find_variable(names.bounds), bounds.data()));
}

void write_plane_positions(const nc::File& file, const Grid& grid) {
  std::vector<double> latitudes(grid.size()), longitudes(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const Centre position = grid.position(grid.column(cell), grid.row(cell));
    latitudes[cell] = position.latitude_deg;
    longitudes[cell] = position.longitude_deg;
  }
  nc::check(nc_put_var_double(file.id(), *file.find_variable("lat"), latitudes.data()));
  nc::check(nc_put_var_double(file.id(), *file.find_variable("lon"), longitudes.data()));
}

/// Positions of the corners along the south of a row of cells, rounded to a power of two of a
/// degree below 1/256 of a cell: finer digits would only fill the file.
std::vector<Centre> corners_south_of(const Grid& grid, const EqualAreaProjection& projection,
                                     int row) {
  const double cell_deg = std::min(grid.spacing_east_m(0), grid.step_north_m()) /
                          grid.figure().radius_m * 180.0 / std::numbers::pi;
  const double step_deg = std::exp2(std::floor(std::log2(cell_deg / 256.0)));
  const auto rounded = [&](double degrees) { return step_deg * std::round(degrees / step_deg); };
  std::vector<Centre> corners;
  for (int i = 0; i <= grid.nx(); ++i) {
    const Centre exact = projection.unproject((i - 0.5 * grid.nx()) * grid.spacing_east_m(0),
                                              (row - 0.5 * grid.ny()) * grid.step_north_m());
    corners.push_back(
        {std::clamp(rounded(exact.latitude_deg), -90.0, 90.0), rounded(exact.longitude_deg)});
  }
  return corners;
}

/// Corners of each cell, anticlockwise from the south-west of the map, with longitudes that lie
/// within half a turn of the centre's.
void write_corners(const nc::File& file, const Grid& grid) {
  const EqualAreaProjection projection(*grid.centre(), grid.figure());
  const int latitude_id = *file.find_variable(kLatitude.bounds);
  const int longitude_id = *file.find_variable(kLongitude.bounds);
  constexpr int kTogether = kCornerRows;
  const auto nx = static_cast<std::size_t>(grid.nx());
  std::vector<double> latitudes, longitudes;
  std::vector<Centre> south = corners_south_of(grid, projection, 0);
  for (int first = 0; first < grid.ny(); first += kTogether) {
    const int rows = std::min(kTogether, grid.ny() - first);
    latitudes.clear();
    longitudes.clear();
    for (int j = first; j < first + rows; ++j) {
      std::vector<Centre> north = corners_south_of(grid, projection, j + 1);
      for (std::size_t i = 0; i < nx; ++i) {
        const double middle_deg = grid.position(static_cast<int>(i), j).longitude_deg;
        for (const Centre& corner : {south[i], south[i + 1], north[i + 1], north[i]}) {
          const double away_deg = corner.longitude_deg - middle_deg;
          latitudes.push_back(corner.latitude_deg);
          longitudes.push_back(corner.longitude_deg - 360.0 * std::round(away_deg / 360.0));
        }
      }
      south = std::move(north);
    }
    const std::array<std::size_t, 3> start{static_cast<std::size_t>(first), 0, 0};
    const std::array<std::size_t, 3> count{static_cast<std::size_t>(rows), nx, kCorners};
    nc::check(
        nc_put_vara_double(file.id(), latitude_id, start.data(), count.data(), latitudes.data()));
    nc::check(
        nc_put_vara_double(file.id(), longitude_id, start.data(), count.data(), longitudes.data()));
  }
}

std::vector<double> required_numbers(const nc::File& file, const char* name, std::size_t count) {
  auto values = file.numbers(NC_GLOBAL, name);
  if (values.size() != count) {
    throw InputError(fmt::format("global attribute {} must hold {} number(s), it holds {}", name,
                                 count, values.size()));
  }
  return values;
}

int dimension_size(const nc::File& file, const char* name) {
  int dimension = -1;
  if (nc_inq_dimid(file.id(), name, &dimension) != NC_NOERR) {
    throw InputError(fmt::format("dimension {} is missing", name));
  }
  return file.length_of(dimension);
}

}  // namespace

DimensionNames dimension_names(const Grid& grid) {
  return {row_names(grid).name, column_names(grid).name};
}

GridVariables define_grid(const nc::File& file, const Grid& grid) {
  GridVariables ids;
  ids.row_dimension = file.define_dimension(row_names(grid).name, grid.ny());
  ids.column_dimension = file.define_dimension(column_names(grid).name, grid.nx());
  const int bounds = file.define_dimension("bnds", 2);
  define_coordinate(file, row_names(grid), ids.row_dimension, bounds);
  define_coordinate(file, column_names(grid), ids.column_dimension, bounds);
  ids.has_mapping = grid.is_latitude_longitude() || grid.is_projected();
  ids.has_coordinates = grid.is_geographic() && !grid.is_latitude_longitude();
  if (ids.has_mapping) define_mapping(file, grid);
  if (ids.has_coordinates) define_plane_positions(file, grid, ids);
  put_rebuilding_attributes(file, grid);
  return ids;
}

void write_coordinates(const nc::File& file, const Grid& grid) {
  const Raster raster = grid.is_latitude_longitude() ? raster_of(grid) : metric_raster_of(grid);
  write_axis(file, row_names(grid), raster.rows);
  write_axis(file, column_names(grid), raster.columns);
  if (grid.is_geographic() && !grid.is_latitude_longitude()) write_plane_positions(file, grid);
  if (grid.is_projected()) write_corners(file, grid);
  if (const auto mapping = file.find_variable(kMapping)) {
    constexpr int kNoMeaning = 0;  // its attributes tell; left out, every reader would find another
    nc::check(nc_put_var_int(file.id(), *mapping, &kNoMeaning));
  }
}

void put_figure(const nc::File& file, int mapping, const Ellipsoid& figure) {
  if (figure.flattening == 0.0) {
    file.put(mapping, "earth_radius", figure.radius_m);
  } else {
    file.put(mapping, "semi_major_axis", figure.radius_m);
    file.put(mapping, "inverse_flattening", 1.0 / figure.flattening);
  }
}

std::vector<double> row_areas(const Grid& grid) {
  std::vector<double> areas(grid.ny());
  for (int j = 0; j < grid.ny(); ++j) areas[j] = grid.area_m2(j);
  return areas;
}

Grid read_grid(const nc::File& file) {
  const auto topology = file.text(NC_GLOBAL, kTopology);
  if (!topology) {
    throw InputError(fmt::format("not a stage file: global attribute {} is missing", kTopology));
  }
  const bool latitude_longitude = *topology == "sphere" || *topology == "window";
  const int ny = dimension_size(file, latitude_longitude ? "lat" : "y");
  const int nx = dimension_size(file, latitude_longitude ? "lon" : "x");
  file.check_cells(nx, ny);  // a grid takes memory for each of its rows
  const Ellipsoid figure{required_numbers(file, kRadius, 1)[0],
                         required_numbers(file, kFlattening, 1)[0]};
  constexpr double kLargest_m = 1e12;
  if (!(figure.radius_m >= 1.0 && figure.radius_m <= kLargest_m)) {
    throw InputError(fmt::format("global attribute {} is {:g} m, must be within 1 and {:g}",
                                 kRadius, figure.radius_m, kLargest_m));
  }
  const Edges edges =
      file.text(NC_GLOBAL, kEdges).value_or("open") == "closed" ? Edges::closed : Edges::open;
  try {
    if (*topology == "sphere") {
      const auto turn = file.numbers(NC_GLOBAL, kTurn);
      if (turn.size() != 3) return Grid::sphere(nx, ny, figure);
      return Grid::sphere(nx, ny, figure, {turn[0], turn[1], turn[2]});
    }
    if (*topology == "window") {
      const auto w = required_numbers(file, kWindow, 4);
      return Grid::window(nx, ny, {w[0], w[1], w[2], w[3]}, figure, edges);
    }
    const auto step = required_numbers(file, kSpacing, 2);
    if (!(step[0] > 0.0 && step[0] <= kLargest_m && step[1] > 0.0 && step[1] <= kLargest_m)) {
      throw InputError(fmt::format("global attribute {}: cells must be within 0 and {:g} m",
                                   kSpacing, kLargest_m));
    }
    if (*topology == "torus") return Grid::torus(nx, ny, step[0], step[1]);
    if (*topology == "equal_area") {
      const auto c = required_numbers(file, kCentre, 2);
      return Grid::equal_area(nx, ny, step[0], {c[0], c[1]}, figure, edges);
    }
    if (*topology == "plane") {
      const auto c = file.numbers(NC_GLOBAL, kCentre);
      const auto centre = c.size() == 2 ? std::optional(Centre{c[0], c[1]}) : std::nullopt;
      if (centre && !(std::abs(c[0]) <= 90.0 && std::abs(c[1]) <= 360.0)) {
        throw InputError(fmt::format("global attribute {} is no place", kCentre));
      }
      return Grid::plane(nx, ny, step[0], step[1], edges, centre, figure);
    }
  } catch (const ConfigurationError& error) {
    throw InputError(error.what());
  }
  throw InputError(
      fmt::format("global attribute {} is \"{}\", must be sphere, window, plane, "
                  "equal_area or torus",
                  kTopology, *topology));
}

}  // namespace geo::io
