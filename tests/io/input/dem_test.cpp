#include "geo/io/input/dem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "geo/core/error.hpp"
#include "io/temporary_folder.hpp"
#include "support/text_of.hpp"

namespace geo::io {
namespace {

using testing::HasSubstr;

/// A small elevation model of any shape, described as one describes it to a colleague.
struct DemFile {
  std::vector<double> rows, columns;
  std::string row_name = "lat", column_name = "lon";
  std::string row_units = "degrees_north", column_units = "degrees_east";
  std::string variable = "z", units = "m", standard_name;
  nc_type type = NC_FLOAT;
  int format = NC_NETCDF4;
  double scale = 0.0, offset = 0.0;
  std::optional<double> fill;
  bool time = false;
  std::string second_variable;
  std::string global_crs;
  std::function<double(double row, double column)> elevation = [](double row, double column) {
    return 100.0 * row + column;
  };

  void write(const std::filesystem::path& path) const;
};

void good(int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); }

void DemFile::write(const std::filesystem::path& path) const {
  int id = 0, y = 0, x = 0, t = 0, yv = 0, xv = 0, zv = 0;
  good(nc_create(path.c_str(), format | NC_CLOBBER, &id));
  if (time) good(nc_def_dim(id, "time", NC_UNLIMITED, &t));
  good(nc_def_dim(id, row_name.c_str(), rows.size(), &y));
  good(nc_def_dim(id, column_name.c_str(), columns.size(), &x));
  good(nc_def_var(id, row_name.c_str(), NC_DOUBLE, 1, &y, &yv));
  good(nc_def_var(id, column_name.c_str(), NC_DOUBLE, 1, &x, &xv));
  const auto put = [&](int variable, const char* name, const std::string& text) {
    if (!text.empty()) good(nc_put_att_text(id, variable, name, text.size(), text.data()));
  };
  put(yv, "units", row_units);
  put(xv, "units", column_units);
  put(NC_GLOBAL, "crs", global_crs);
  const int dimensions[3] = {t, y, x};
  const auto define = [&](const std::string& name) {
    good(nc_def_var(id, name.c_str(), type, time ? 3 : 2, dimensions + (time ? 0 : 1), &zv));
    put(zv, "units", units);
  };
  if (!second_variable.empty()) define(second_variable);
  define(variable);
  put(zv, "standard_name", standard_name);
  if (scale != 0.0) {
    good(nc_put_att_double(id, zv, "scale_factor", NC_DOUBLE, 1, &scale));
    good(nc_put_att_double(id, zv, "add_offset", NC_DOUBLE, 1, &offset));
  }
  if (fill) good(nc_put_att_double(id, zv, "_FillValue", type, 1, &*fill));
  good(nc_enddef(id));
  good(nc_put_var_double(id, yv, rows.data()));
  good(nc_put_var_double(id, xv, columns.data()));
  std::vector<double> values;
  for (const double row : rows) {
    for (const double column : columns) {
      const double metres = elevation(row, column);
      values.push_back(scale != 0.0 ? std::round((metres - offset) / scale) : metres);
    }
  }
  const std::size_t start[3] = {0, 0, 0}, count[3] = {1, rows.size(), columns.size()};
  good(nc_put_vara_double(id, zv, start + (time ? 0 : 1), count + (time ? 0 : 1), values.data()));
  good(nc_close(id));
}

std::vector<double> steps(double first, double step, int size) {
  std::vector<double> values;
  for (int i = 0; i < size; ++i) values.push_back(first + i * step);
  return values;
}

std::vector<double> reversed(std::vector<double> values) {
  return {values.rbegin(), values.rend()};
}

/// 24 x 12 cells of 15 degrees from 180 W.
DemFile planet_file() {
  DemFile file;
  file.rows = steps(-82.5, 15.0, 12);
  file.columns = steps(-172.5, 15.0, 24);
  // Of period 360 in longitude, told apart everywhere, even in sign.
  file.elevation = [](double row, double column) {
    return 1000.0 * std::sin(column * M_PI / 180.0) + 300.0 * std::cos(column * M_PI / 180.0) +
           10.0 * row;
  };
  return file;
}

Dem read(const DemFile& file, const std::string& variable = "") {
  const TemporaryFolder folder;
  file.write(folder / "relief.nc");
  return read_dem((folder / "relief.nc").string() + (variable.empty() ? "" : ":") + variable,
                  Planet{});
}

std::string complaint(const DemFile& file, const std::string& variable = "") {
  try {
    read(file, variable);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("relief.nc"));
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

void expect_planet(const Dem& relief, double tolerance_m = 1e-3) {
  const DemFile plain = planet_file();
  const Grid& grid = relief.grid;
  ASSERT_EQ(grid.topology(), Topology::sphere);
  ASSERT_EQ(grid.nx(), 24);
  ASSERT_EQ(grid.ny(), 12);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double expected =
        plain.elevation(grid.latitude_deg(grid.row(cell)), grid.longitude_deg(grid.column(cell)));
    ASSERT_NEAR(relief.elevation_m[cell], expected, tolerance_m) << "cell " << cell;
  }
}

TEST(Dem, PlainPlanetIsReadAsItIs) { expect_planet(read(planet_file())); }

TEST(Dem, NorthernRowsMayComeFirst) {
  DemFile file = planet_file();
  file.rows = reversed(file.rows);
  expect_planet(read(file));
}

TEST(Dem, LongitudesMayRunFromAnyMeridian) {
  for (const double west : {7.5, 22.5, -352.5, 187.5, -7.5}) {
    DemFile file = planet_file();
    file.columns = steps(west, 15.0, 24);
    expect_planet(read(file));
  }
}

TEST(Dem, LongitudesMayRunWestwards) {
  DemFile file = planet_file();
  file.columns = reversed(steps(7.5, 15.0, 24));
  expect_planet(read(file));
}

TEST(Dem, RepeatedEndColumnIsDropped) {
  DemFile file = planet_file();
  file.columns = steps(7.5, 15.0, 25);
  expect_planet(read(file));
  file.columns = reversed(file.columns);
  expect_planet(read(file));
}

TEST(Dem, EveryFormatOfNetcdfIsRead) {
  for (const int format :
       {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4, NC_NETCDF4 | NC_CLASSIC_MODEL}) {
    DemFile file = planet_file();
    file.format = format;
    expect_planet(read(file));
    file.time = true;
    expect_planet(read(file));
  }
}

TEST(Dem, PackedIntegersAreUnpacked) {
  DemFile file = planet_file();
  file.type = NC_SHORT;
  file.scale = 0.5;
  file.offset = 100.0;
  file.fill = -32768;
  expect_planet(read(file), 0.2501);
}

TEST(Dem, UnitsOfLengthAreConverted) {
  DemFile file = planet_file();
  const auto metres = file.elevation;
  for (const auto& [units, per_metre] :
       std::vector<std::pair<std::string, double>>{{"km", 1e-3},
                                                   {"feet", 1 / 0.3048},
                                                   {"METERS", 1.0},
                                                   {"metres", 1.0},
                                                   {"cm", 100.0},
                                                   {"", 1.0}}) {
    SCOPED_TRACE(units);
    file.units = units;
    file.elevation = [&, per_metre = per_metre](double row, double column) {
      return per_metre * metres(row, column);
    };
    expect_planet(read(file), 2e-3);
  }
}

TEST(Dem, WrongUnitsAreRefused) {
  for (const char* units : {"K", "Pa", "m2", "m-1", "s", "degrees", "nonsense", "1"}) {
    DemFile file = planet_file();
    file.units = units;
    const std::string message = complaint(file);
    EXPECT_THAT(message, HasSubstr("variable z"));
    EXPECT_THAT(message, HasSubstr(units));
    EXPECT_THAT(message, HasSubstr("must be a length"));
  }
}

TEST(Dem, MissingCellsAreCountedAndTheFirstIsNamed) {
  DemFile file = planet_file();
  const auto whole = file.elevation;
  for (const double hole : {std::numeric_limits<double>::quiet_NaN(), -9999.0}) {
    file.fill = -9999.0;
    file.elevation = [&](double row, double column) {
      return row == -52.5 && column > 150.0 ? hole : whole(row, column);
    };
    const std::string message = complaint(file);
    EXPECT_THAT(message, HasSubstr("2 cell(s)"));
    EXPECT_THAT(message, HasSubstr("row 2, column 22"));
    EXPECT_THAT(message, HasSubstr("latitude -52.5, longitude 157.5"));
    EXPECT_THAT(message, HasSubstr("fill"));
  }
}

TEST(Dem, NodesAtThePolesAreHalfCells) {
  DemFile file = planet_file();
  file.rows = steps(-90.0, 15.0, 13);
  file.columns = steps(0.0, 15.0, 24);
  file.elevation = [](double row, double) { return row == 90.0 ? 1300.0 : 0.0; };
  const Dem relief = read(file);
  ASSERT_EQ(relief.grid.ny(), 12);
  double volume = 0.0;
  for (Index cell = 0; cell < relief.grid.size(); ++cell) {
    volume += relief.elevation_m[cell] * relief.grid.area_m2(relief.grid.row(cell));
  }
  // The node stands for the cap north of 82.5 N.
  const double share = 0.5 * (1.0 - std::sin(82.5 * M_PI / 180.0));
  EXPECT_NEAR(volume / relief.grid.total_area_m2() / (1300.0 * share), 1.0, 1e-6);
}

TEST(Dem, OddNumberOfColumnsGetsAGridThatCanCrossThePole) {
  DemFile file = planet_file();
  file.columns = steps(0.0, 360.0 / 23, 23);
  const Dem relief = read(file);
  EXPECT_EQ(relief.grid.nx(), 24);
  EXPECT_EQ(relief.elevation_m.size(), 24U * 12U);
}

TEST(Dem, RegionBecomesAWindow) {
  DemFile file;
  file.rows = steps(40.25, 0.5, 20);
  file.columns = steps(355.25, 0.5, 30);
  const Dem relief = read(file);
  EXPECT_EQ(relief.grid.topology(), Topology::plane);
  EXPECT_TRUE(relief.grid.is_latitude_longitude());
  EXPECT_NEAR(relief.grid.window().south_deg, 40.0, 1e-12);
  EXPECT_NEAR(relief.grid.window().west_deg, -5.0, 1e-12);
  EXPECT_NEAR(relief.grid.window().east_deg, 10.0, 1e-12);
  EXPECT_EQ(relief.elevation_m[0], 100.0F * 40.25F + 355.25F);
}

TEST(Dem, ProjectedMetresBecomeAPlaneWithItsCentre) {
  DemFile file;
  file.row_name = "y";
  file.column_name = "x";
  file.row_units = file.column_units = "m";
  file.rows = reversed(steps(3788000.0, 30.0, 40));
  file.columns = steps(376000.0, 30.0, 50);
  file.elevation = [](double row, double column) {
    return (row - 3788000.0) * 100 + (column - 376000.0);
  };
  const Dem bare = read(file);
  EXPECT_EQ(bare.grid.topology(), Topology::plane);
  EXPECT_FALSE(bare.grid.centre().has_value());
  EXPECT_DOUBLE_EQ(bare.grid.spacing_east_m(0), 30.0);
  EXPECT_EQ(bare.elevation_m[0], 0.0F);
  EXPECT_EQ(bare.elevation_m[51], 3030.0F);

  file.global_crs = "EPSG:32611";
  const Dem placed = read(file);
  ASSERT_TRUE(placed.grid.centre().has_value());
  // By hand with `cs2cs EPSG:32611 EPSG:4326`.
  EXPECT_NEAR(placed.grid.centre()->latitude_deg, 34.2314, 0.01);
  EXPECT_NEAR(placed.grid.centre()->longitude_deg, -118.3382, 0.01);

  file.row_units = file.column_units = "km";
  for (double& value : file.rows) value *= 1e-3;
  for (double& value : file.columns) value *= 1e-3;
  EXPECT_NEAR(read(file).grid.spacing_east_m(0), 30.0, 1e-6);
}

TEST(Dem, VariableIsFoundByStandardNameThenNameThenLoneliness) {
  DemFile file = planet_file();
  file.variable = "something";
  EXPECT_EQ(read(file).variable, "something");
  file.second_variable = "other";
  EXPECT_THAT(complaint(file), HasSubstr("other, something; say FILE:VARIABLE"));
  EXPECT_EQ(read(file, "something").variable, "something");
  file.variable = "Band1";
  EXPECT_EQ(read(file).variable, "Band1");
  file.variable = "something";
  file.second_variable = "topo";
  file.standard_name = "surface_altitude";
  EXPECT_EQ(read(file).variable, "something");
}

TEST(Dem, AbsentVariableIsNamedWithThoseThatAreThere) {
  const std::string message = complaint(planet_file(), "height");
  EXPECT_THAT(message, HasSubstr("variable height is missing"));
  EXPECT_THAT(message, HasSubstr("holds z"));
}

TEST(Dem, UnevenAxisIsRefused) {
  DemFile file = planet_file();
  file.rows[5] += 1.0;
  EXPECT_THAT(complaint(file), HasSubstr("axis lat: steps are uneven at index 5"));
}

TEST(Dem, AxisLongerThanAnyGridIsRefused) {
  const TemporaryFolder folder;
  int id = 0, dimension[2] = {}, latitude = 0, longitude = 0, z = 0;
  // Classic format without fill: a file of holes.
  good(nc_create((folder / "long.nc").c_str(), NC_64BIT_DATA, &id));
  good(nc_set_fill(id, NC_NOFILL, nullptr));
  good(nc_def_dim(id, "lat", std::size_t{1} << 28, &dimension[0]));
  good(nc_def_dim(id, "lon", 4, &dimension[1]));
  good(nc_def_var(id, "lat", NC_BYTE, 1, dimension, &latitude));
  good(nc_put_att_text(id, latitude, "units", 13, "degrees_north"));
  good(nc_def_var(id, "lon", NC_BYTE, 1, dimension + 1, &longitude));
  good(nc_put_att_text(id, longitude, "units", 12, "degrees_east"));
  good(nc_def_var(id, "z", NC_BYTE, 2, dimension, &z));
  good(nc_put_att_text(id, z, "units", 1, "m"));
  good(nc_enddef(id));
  good(nc_close(id));
  try {
    static_cast<void>(read_dem((folder / "long.nc").string(), Planet{}));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("axis lat: 268435456 values, must have 178956970 at most"));
  }
}

TEST(Dem, AxesWithoutMeaningAreRefused) {
  DemFile file = planet_file();
  file.row_name = "j";
  file.row_units = "";
  EXPECT_THAT(complaint(file), HasSubstr("dimension j has no coordinates"));
}

TEST(Dem, TransposedRasterIsRefused) {
  DemFile file = planet_file();
  std::swap(file.rows, file.columns);
  std::swap(file.row_name, file.column_name);
  std::swap(file.row_units, file.column_units);
  EXPECT_THAT(complaint(file), HasSubstr("in this order"));
}

TEST(Dem, LatitudesBeyondThePolesAreRefused) {
  DemFile file = planet_file();
  file.rows = steps(-120.0, 15.0, 17);
  EXPECT_THAT(complaint(file), HasSubstr("beyond the poles"));
}

TEST(Dem, TruncatedFilesAreRefusedWhateverTheirFormat) {
  const TemporaryFolder folder;
  for (const int format : {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4}) {
    for (const bool time : {false, true}) {
      DemFile file = planet_file();
      file.format = format;
      file.time = time;
      file.write(folder / "whole.nc");
      const std::string whole = test::text_of(folder / "whole.nc");
      for (const std::size_t cut : {4, 300, 1000}) {
        SCOPED_TRACE(std::to_string(format) + " cut by " + std::to_string(cut));
        std::ofstream(folder / "cut.nc", std::ios::binary) << whole.substr(0, whole.size() - cut);
        EXPECT_THROW(read_dem((folder / "cut.nc").string(), Planet{}), InputError);
      }
      EXPECT_NO_THROW(read_dem((folder / "whole.nc").string(), Planet{}));
    }
  }
}

TEST(Dem, AbsentFileIsAnIoError) {
  EXPECT_THROW(read_dem("/nowhere/relief.nc", Planet{}), IoError);
}

TEST(Dem, ResamplesToItsOwnGridWithoutChange) {
  const Dem relief = read(planet_file());
  EXPECT_EQ(resample(relief, relief.grid), relief.elevation_m);
}

TEST(Dem, TargetBeyondTheReliefIsRefused) {
  DemFile file;
  file.rows = steps(40.25, 0.5, 20);
  file.columns = steps(-4.75, 0.5, 30);
  const Dem relief = read(file);
  EXPECT_THROW(resample(relief, Grid::window(10, 10, {39.0, 45.0, 0.0, 5.0})), InputError);
  EXPECT_NO_THROW(resample(relief, Grid::window(10, 10, {41.0, 45.0, 0.0, 5.0})));
  EXPECT_THROW(resample(relief, Grid::plane(10, 10, 100.0, 100.0)), InputError);
}

}  // namespace
}  // namespace geo::io
