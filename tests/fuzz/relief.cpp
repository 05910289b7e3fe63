// Reliefs and other rasters of others, as --dem and [fields] name them.
#include <cmath>

#include "geo/io/input/dem.hpp"
#include "made_netcdf.hpp"

namespace {

using geo::fuzz::Bytes;
using geo::fuzz::MadeNetcdf;

constexpr const char* kUnits[] = {"degrees_north", "degrees_east", "m", "km", "feet",
                                  "m/yr",          "degrees",      "1", "K"};
constexpr const char* kStandardNames[] = {
    "latitude",         "longitude",    "projection_x_coordinate", "projection_y_coordinate",
    "surface_altitude", "grid_latitude"};
constexpr const char* kNames[] = {"lat", "lon", "y", "x", "z", "elevation", "crs", "bnds"};
constexpr const char* kSystems[] = {
    "+proj=utm +zone=32 +datum=WGS84", "EPSG:3035", "+proj=laea +lat_0=90",
    "GEOGCRS[\"a\",DATUM[\"b\",ELLIPSOID[\"c\",6371000,0]]]", "+proj=longlat"};

void describe(MadeNetcdf& file, Bytes& bytes, int variable) {
  if (variable < 0) return;
  for (int odd = bytes.byte() % 3; odd > 0; --odd) {
    switch (bytes.below(10)) {
      case 0:
        return file.text(variable, "units", bytes.word(kUnits));
      case 1:
        return file.text(variable, "standard_name", bytes.word(kStandardNames));
      case 2:
        return file.numbers(variable, "scale_factor", {file.any_number()});
      case 3:
        return file.numbers(variable, "add_offset", {file.any_number()});
      case 4:
        return file.numbers(variable, "_FillValue", {file.any_number()});
      case 5:
        return file.numbers(variable, "missing_value", {file.any_number()});
      case 6:
        return file.numbers(variable, "valid_range", {file.any_number(), file.any_number()});
      case 7:
        return file.text(variable, "grid_mapping", bytes.word(kNames));
      case 8:
        return file.text(variable, "axis", bytes.one_in(2) ? "X" : "Y");
      default:
        return file.numbers(variable, "valid_min", {file.any_number()});
    }
  }
}

void make(const std::string& path, Bytes& bytes) {
  MadeNetcdf file(path, bytes);
  const bool metric = bytes.one_in(4), part = bytes.one_in(3);
  const int ny = 4 + bytes.below(9), nx = 2 * (2 + bytes.below(9));
  const char* const row = metric ? "y" : "lat";
  const char* const column = metric ? "x" : "lon";
  const int rows = file.dimension(row, ny), columns = file.dimension(column, nx);
  const double south = metric ? 0.0 : part ? 10.0 : -90.0 + 90.0 / ny;
  const double north = metric ? 5e4 : part ? 30.0 : 90.0 - 90.0 / ny;
  const double west = metric ? 0.0 : part ? 5.0 : -180.0 + 180.0 / nx;
  const double east = metric ? 9e4 : part ? 45.0 : 180.0 - 180.0 / nx;
  const bool reversed = bytes.one_in(4);
  const int y =
      file.variable(row, NC_DOUBLE, {rows}, reversed ? north : south, reversed ? south : north);
  const int x = file.variable(column, NC_DOUBLE, {columns}, west, east);
  if (y >= 0) file.text(y, "units", metric ? "m" : "degrees_north");
  if (x >= 0) file.text(x, "units", metric ? "m" : "degrees_east");
  const int z =
      file.variable(bytes.one_in(4) ? bytes.word(kNames) : "z",
                    bytes.one_in(2) ? NC_SHORT : NC_FLOAT, {rows, columns}, -4000.0, 3000.0);
  if (bytes.one_in(4)) {
    const int crs = file.variable("crs", NC_INT, {}, 0.0, 0.0);
    if (crs >= 0) file.text(crs, bytes.one_in(2) ? "crs_wkt" : "spatial_ref", bytes.word(kSystems));
    if (z >= 0) file.text(z, "grid_mapping", "crs");
  }
  if (bytes.one_in(6)) {
    const int lat = file.variable("lat", NC_DOUBLE, {rows, columns}, -50.0, 60.0);
    const int lon = file.variable("lon", NC_DOUBLE, {rows, columns}, -50.0, 60.0);
    if (lat >= 0) file.text(lat, "standard_name", "latitude");
    if (lon >= 0) file.text(lon, "standard_name", "longitude");
  }
  if (bytes.one_in(6)) describe(file, bytes, file.variable("w", NC_INT, {rows, columns}, 0.0, 9.0));
  for (const int variable : {y, x, z}) describe(file, bytes, variable);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.nc");
  static const geo::Grid grid = geo::Grid::sphere(12, 6);
  Bytes bytes(data, size);
  make(file.path(), bytes);
  geo::fuzz::expect_value_or_refusal([&] {
    const geo::io::Dem dem = geo::io::read_dem(file.path(), {});
    geo::fuzz::claim(dem.elevation_m.size() == static_cast<std::size_t>(dem.grid.size()),
                     "a DEM has a value for each cell");
    for (const float elevation_m : dem.elevation_m) {
      geo::fuzz::claim(!std::isnan(elevation_m), "a DEM has no gaps unless they are allowed");
    }
    if (dem.grid.is_latitude_longitude()) static_cast<void>(geo::io::resample(dem, grid));
  });
  geo::fuzz::expect_value_or_refusal([&] {
    static_cast<void>(geo::io::read_dem_with_gaps(file.path() + ":" + bytes.word(kNames), {}));
  });
  geo::fuzz::expect_value_or_refusal(
      [&] { static_cast<void>(geo::io::read_field(file.path(), geo::field::erodibility, {})); });
  return 0;
}
