#include "cli/relief_file.hpp"

#include <netcdf.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace geo {
namespace {

void good(int status) {
  if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
}

/// Two continents with mountains in a deep ocean, and smaller forms.
double elevation_m(double latitude_deg, double longitude_deg) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double y = latitude_deg * kRadians, x = longitude_deg * kRadians;
  const double land = std::cos(y) * (std::cos(x) + 0.6 * std::cos(2.0 * x + 1.0)) +
                      0.4 * std::sin(2.0 * y + 0.3) * std::sin(3.0 * x);
  const double hills =
      std::sin(7.0 * x + 2.0 * std::sin(4.0 * y)) * std::cos(9.0 * y) * std::cos(y);
  return 2600.0 * (land - 0.35) + 500.0 * hills;
}

}  // namespace

void ReliefFile::write(const std::filesystem::path& path) const {
  int id = 0, z = 0;
  std::array<int, 2> dimensions{}, axes{};
  good(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &id));
  good(nc_def_dim(id, "lat", ny, &dimensions[0]));
  good(nc_def_dim(id, "lon", nx, &dimensions[1]));
  good(nc_def_var(id, "lat", NC_DOUBLE, 1, &dimensions[0], &axes[0]));
  good(nc_def_var(id, "lon", NC_DOUBLE, 1, &dimensions[1], &axes[1]));
  good(nc_put_att_text(id, axes[0], "units", 13, "degrees_north"));
  good(nc_put_att_text(id, axes[1], "units", 12, "degrees_east"));
  good(nc_def_var(id, variable.c_str(), NC_DOUBLE, one_dimensional ? 1 : 2, dimensions.data(), &z));
  good(nc_put_att_text(id, z, "units", units.size(), units.data()));
  good(nc_put_att_double(id, z, "_FillValue", NC_DOUBLE, 1, &fill));
  good(nc_enddef(id));
  std::vector<double> rows, columns, values;
  for (int j = 0; j < ny; ++j) rows.push_back(-90.0 + (j + 0.5) * (90.0 + north_deg) / ny);
  for (int i = 0; i < nx; ++i) columns.push_back(-180.0 + (i + 0.5) * 360.0 / nx);
  for (const double row : rows) {
    for (const double column : columns) {
      values.push_back(height_m ? height_m(row, column) : elevation_m(row, column));
    }
  }
  if (hole) values[static_cast<std::size_t>(ny / 2) * nx + 5] = *hole;
  rows[ny / 2] += latitude_kink_deg;
  good(nc_put_var_double(id, axes[0], rows.data()));
  good(nc_put_var_double(id, axes[1], columns.data()));
  good(nc_put_var_double(id, z, values.data()));
  good(nc_close(id));
}

}  // namespace geo
