#include "geo/io/input/dem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "dem_axis.hpp"
#include "dem_values.hpp"
#include "dem_variable.hpp"
#include "geo/core/error.hpp"
#include "geo/io/drawing/map_view.hpp"
#include "geo/kernels/remapping/turned_planet.hpp"
#include "geotiff.hpp"
#include "io/drawing/map_projection.hpp"
#include "io/files/open_input.hpp"
#include "io/netcdf/classic_size.hpp"
#include "io/netcdf/netcdf_file.hpp"
#include "plain_raster.hpp"
#include "questions.hpp"

namespace geo::io {
namespace {

/// Values with rows from the south and columns from the west, starting at column `start`; only
/// `columns.size` of the `width` columns of the file are kept.
std::vector<float> in_order(const std::vector<float>& file_values, const DemAxis& rows,
                            const DemAxis& columns, int width, int start) {
  const int nx = columns.size, ny = rows.size;
  std::vector<float> ordered(static_cast<std::size_t>(nx) * ny);
  for (int j = 0; j < ny; ++j) {
    const float* const from =
        file_values.data() + static_cast<std::size_t>(rows.reversed ? ny - 1 - j : j) * width;
    float* const to = ordered.data() + static_cast<std::size_t>(j) * nx;
    for (int i = 0; i < nx; ++i) {
      const int column = (start + i) % nx;
      to[i] = from[columns.reversed ? width - 1 - column : column];
    }
  }
  return ordered;
}

Axis even_axis(double first, double step, int size) {
  Axis axis;
  for (int i = 0; i < size; ++i) axis.centres.push_back(first + i * step);
  for (int i = 0; i <= size; ++i) axis.edges.push_back(first + (i - 0.5) * step);
  return axis;
}

/// Rows between the poles of a planet: latitudes that end at a pole are half cells.
Axis latitude_axis(const DemAxis& rows) {
  Axis axis = even_axis(rows.first, rows.step, rows.size);
  for (double& edge : axis.edges) edge = std::clamp(edge, -90.0, 90.0);
  for (double& centre : axis.centres) centre = std::clamp(centre, -90.0, 90.0);
  return axis;
}

/// How far apart two positions may be and still count as the same, in cells. ETOPO's own axes are
/// off by a few hundredths.
constexpr double kSlack = 0.05;

/// Turns of longitudes, and whether columns go all round.
struct Longitudes {
  DemAxis axis;
  bool round = false;
  int start = 0;         ///< column of the file that comes first
  bool aligned = false;  ///< edges coincide with those of a planet's grid
};

Longitudes arrange_longitudes(DemAxis columns) {
  Longitudes result;
  constexpr double kFarthest_deg = 1080.0;  // some count on past a turn
  if (!(std::abs(columns.first) <= kFarthest_deg)) {
    throw InputError(fmt::format("axis {}: begins at longitude {:g}: must be within {:g}",
                                 columns.name, columns.first, kFarthest_deg));
  }
  const double circle_in_steps = 360.0 / columns.step;
  if (columns.size - 1 > circle_in_steps + 0.5) {
    throw InputError(fmt::format("axis {}: covers more than 360 degrees", columns.name));
  }
  // A last column that repeats the first closes the circle.
  if (std::abs(columns.size - 1 - circle_in_steps) < 0.5) --columns.size;
  result.round = std::abs(columns.size - circle_in_steps) < 0.5;
  if (!result.round) {
    const double turns = std::floor((columns.low() + 180.0) / 360.0 + 1e-9);
    columns.first -= 360.0 * turns;
    result.axis = std::move(columns);
    return result;
  }
  columns.step = 360.0 / columns.size;
  const double steps = (-180.0 - columns.low()) / columns.step;
  const double whole = std::round(steps);
  columns.first += whole * columns.step;
  result.aligned = std::abs(steps - whole) < kSlack && columns.size % 2 == 0;
  const int n = columns.size;
  result.start = ((static_cast<int>(whole) % n) + n) % n;
  result.axis = std::move(columns);
  return result;
}

/// Rows from pole to pole, with nodes or cells at the ends; else regional.
enum class Rows { cells, nodes, regional };

Rows registration(const DemAxis& rows) {
  const double slack = kSlack * rows.step;
  if (rows.first < -90.0 - slack || rows.last() > 90.0 + slack) {
    throw InputError(fmt::format("axis {}: latitudes {:.6g} to {:.6g} lie beyond the poles",
                                 rows.name, rows.first, rows.last()));
  }
  if (std::abs(rows.low() + 90.0) < slack && std::abs(rows.high() - 90.0) < slack) {
    return Rows::cells;
  }
  if (std::abs(rows.first + 90.0) < slack && std::abs(rows.last() - 90.0) < slack) {
    return Rows::nodes;
  }
  return Rows::regional;
}

Dem global_dem(DemAxis rows, const Longitudes& longitudes, Rows registered,
               std::vector<float> values, const Planet& planet) {
  const DemAxis& columns = longitudes.axis;
  const bool cells = registered == Rows::cells;
  const int ny = cells ? rows.size : rows.size - 1;
  const int nx = columns.size + columns.size % 2;
  rows.step = 180.0 / ny;
  rows.first = cells ? -90.0 + 0.5 * rows.step : -90.0;
  Dem dem{{}, Grid::sphere(nx, ny, planet.figure()), {}, {}, {}, {}};
  if (cells && longitudes.aligned) {
    dem.elevation_m = std::move(values);
    return dem;
  }
  dem.raster = {latitude_axis(rows), even_axis(columns.first, columns.step, columns.size), true};
  dem.raster.columns.period = 360.0;
  dem.raster_m = std::move(values);
  dem.elevation_m = resample(dem, dem.grid);
  return dem;
}

Dem window_dem(const DemAxis& rows, const DemAxis& columns, std::vector<float> values,
               const Planet& planet) {
  const double south = std::max(rows.low(), -90.0), north = std::min(rows.high(), 90.0);
  const double slack = kSlack * rows.step;
  const bool beyond_poles = rows.low() < -90.0 - slack || rows.high() > 90.0 + slack;
  const int ny = beyond_poles
                     ? std::max(3, static_cast<int>(std::lround((north - south) / rows.step)))
                     : rows.size;
  // A full circle may exceed itself by rounding.
  const double east = std::min(columns.high(), columns.low() + 360.0);
  Dem dem{{}, Grid::window(columns.size, ny, {south, north, columns.low(), east}, planet.figure()),
          {}, {},
          {}, {}};
  if (!beyond_poles) {
    dem.elevation_m = std::move(values);
    return dem;
  }
  // A row of nodes at the pole is half as tall as the others.
  dem.raster = {latitude_axis(rows), even_axis(columns.first, columns.step, columns.size), true};
  dem.raster_m = std::move(values);
  dem.elevation_m = resample(dem, dem.grid);
  return dem;
}

/// The CRS that a file names for a variable: CF, GDAL and a few old habits.
std::optional<std::string> find_crs(const nc::File& file, int variable) {
  if (const auto mapping = file.text(variable, "grid_mapping")) {
    if (const auto crs = file.find_variable(*mapping)) {
      for (const char* name : {"crs_wkt", "spatial_ref", "proj4", "proj4_string"}) {
        if (auto text = file.text(*crs, name)) return text;
      }
    }
  }
  for (const char* name : {"crs_wkt", "spatial_ref", "crs", "proj4", "proj4_string"}) {
    if (auto text = file.text(NC_GLOBAL, name)) return text;
  }
  return {};
}

/// Latitude or longitude in the middle of a plane, from a variable over the plane's dimensions.
std::optional<double> middle_of(const nc::File& file, const std::vector<int>& plane,
                                const char* standard_name) {
  for (int variable = 0; variable < file.variables(); ++variable) {
    if (file.text(variable, "standard_name").value_or("") != standard_name ||
        file.dimensions_of(variable) != plane) {
      continue;
    }
    // The mean of the four cells about the middle; the middle cell twice where the count is odd.
    double sum = 0.0;
    for (const int corner : {0, 1, 2, 3}) {
      const std::size_t ny = file.dimension_size(plane[0]), nx = file.dimension_size(plane[1]);
      const std::size_t at[2] = {(ny - (corner < 2 ? 1 : 0)) / 2, (nx - corner % 2) / 2};
      double value = 0.0;
      nc::check(nc_get_var1_double(file.id(), variable, at, &value));
      sum += value;
    }
    return 0.25 * sum;
  }
  return {};
}

std::optional<Centre> find_centre(const nc::File& file, int variable, const DemAxis& rows,
                                  const DemAxis& columns) {
  auto dimensions = file.dimensions_of(variable);
  dimensions.erase(dimensions.begin(), dimensions.end() - 2);
  const auto latitude = middle_of(file, dimensions, "latitude");
  const auto longitude = middle_of(file, dimensions, "longitude");
  if (latitude && longitude) {
    if (std::abs(*latitude) <= 90.0 && std::abs(*longitude) <= 360.0) {
      return Centre{*latitude, *longitude};
    }
    throw InputError(fmt::format("latitude {:g} and longitude {:g} of its middle are no place",
                                 *latitude, *longitude));
  }
  const auto crs = find_crs(file, variable);
  if (!crs) return {};
  return unproject(*crs, 0.5 * (columns.low() + columns.high()), 0.5 * (rows.low() + rows.high()));
}

Dem geographic_dem(const std::vector<float>& values, const DemAxis& rows, const DemAxis& columns,
                   const Planet& planet) {
  const Longitudes longitudes = arrange_longitudes(columns);
  const Rows registered = registration(rows);
  auto ordered = in_order(values, rows, longitudes.axis, columns.size, longitudes.start);
  if (longitudes.round && registered != Rows::regional) {
    return global_dem(rows, longitudes, registered, std::move(ordered), planet);
  }
  return window_dem(rows, longitudes.axis, std::move(ordered), planet);
}

Dem read_from(const nc::File& file, const std::string& wanted, const std::string& units, Gaps gaps,
              const Planet& planet) {
  const int variable = choose_variable(file, wanted);
  const auto dimensions = file.dimensions_of(variable);
  const DemAxis rows = read_axis(file, dimensions[dimensions.size() - 2]);
  const DemAxis columns = read_axis(file, dimensions.back());
  const auto values = read_values(file, variable, rows, columns, units, gaps);
  const auto finish = [&](Dem dem) {
    dem.variable = file.variable_name(variable);
    return dem;
  };
  if (rows.kind == AxisKind::y) {
    return finish({in_order(values, rows, columns, columns.size, 0),
                   Grid::plane(columns.size, rows.size, columns.step, rows.step, Edges::open,
                               find_centre(file, variable, rows, columns), planet.figure()),
                   {},
                   {},
                   {},
                   {}});
  }
  return finish(geographic_dem(values, rows, columns, planet));
}

/// The first cell without a value, counted as the files count rows, from the top.
/// Gaps where none may be, and everywhere what single precision cannot hold.
void check_values(const PlainRaster& raster, Gaps gaps) {
  const bool may_lack = gaps != Gaps::refused;
  const auto wrong = std::find_if(raster.values.begin(), raster.values.end(), [&](float value) {
    return !std::isfinite(value) && !(may_lack && std::isnan(value));
  });
  if (wrong == raster.values.end()) return;
  const auto cell = static_cast<int>(wrong - raster.values.begin());
  throw InputError(fmt::format("has {} in row {} from the top, column {}: every cell must have one",
                               std::isnan(*wrong) ? "no value" : "no finite value",
                               raster.ny - cell / raster.nx, cell % raster.nx + 1));
}

Dem dem_of(const PlainRaster& raster, Gaps gaps, const Planet& planet) {
  check_values(raster, gaps);
  if (!raster.geographic) {
    return {raster.values,
            Grid::plane(raster.nx, raster.ny, raster.step_x, raster.step_y, Edges::open, {},
                        planet.figure()),
            {},
            {},
            {},
            {}};
  }
  const auto axis = [](const char* name, AxisKind kind, double edge, double step, int size) {
    return DemAxis{name, kind, edge + 0.5 * step, step, size};
  };
  return geographic_dem(
      raster.values, axis("rows", AxisKind::latitude, raster.south, raster.step_y, raster.ny),
      axis("columns", AxisKind::longitude, raster.west, raster.step_x, raster.nx), planet);
}

Dem read_raster(const std::string& file_and_variable, const std::string& otherwise,
                const std::string& units, Gaps gaps, const Planet& planet,
                const ImageWords& image = {},
                std::pair<double, double> bounds = {-INFINITY, INFINITY}) {
  if (!image.range.empty()) static_cast<void>(parse_range("--dem-range", image.range));
  if (!image.window.empty()) static_cast<void>(parse_box("--dem-window", image.window));
  return answer_to(RasterQuestion{file_and_variable, otherwise, units, gaps, planet.radius_km,
                                  planet.flattening, image.range, image.window, bounds.first,
                                  bounds.second});
}

/// What an image that says nothing of its range spans; an order without a unit any.
std::pair<double, double> bounds_of(const FieldSpec& spec) {
  if (spec.units.empty() && std::isinf(spec.least) && std::isinf(spec.most)) return {0.0, 1.0};
  return {spec.least, spec.most};
}

/// The same values, none of which may be what the quantity cannot be.
Dem within_bounds(Dem given, const FieldSpec& spec) {
  for (const float value : given.elevation_m) {
    if (!(value < spec.least) && !(value > spec.most)) continue;
    const bool low = value < spec.least;
    throw InputError(fmt::format("{}: {} is {:.6g} {} somewhere; must be at {} {:g}", given.source,
                                 spec.name, value, spec.units, low ? "least" : "most",
                                 low ? spec.least : spec.most));
  }
  return given;
}

/// A file that is no NetCDF.
Dem read_plain(const RasterQuestion& question, const std::filesystem::path& path,
               RasterFormat format) {
  const std::string shown = path.string();
  try {
    ImageMeaning meaning{.range = {}, .window = {}, .least = question.least, .most = question.most};
    if (!question.range.empty()) meaning.range = parse_range("--dem-range", question.range);
    if (!question.window.empty()) meaning.window = parse_box("--dem-window", question.window);
    const PlainRaster raster = format == RasterFormat::png       ? read_png_raster(path, meaning)
                               : format == RasterFormat::geotiff ? read_geotiff_raster(path)
                                                                 : read_ascii_raster(path);
    Dem dem = dem_of(raster, question.gaps,
                     {.radius_km = question.radius_km, .flattening = question.flattening});
    dem.source = shown;
    return dem;
  } catch (const ConfigurationError& error) {
    throw InputError(fmt::format("{}: {}", shown, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", shown, error.what()));
  }
}

}  // namespace

Dem RasterQuestion::here() const {
  const auto [file_name, variable] = split_dem(file_and_variable);
  const std::string shown = file_name.string();
  const RasterFormat format = format_of(file_name);
  if (format != RasterFormat::netcdf) {
    if (!variable.empty()) {
      throw InputError(
          fmt::format("{}: has no variables: give the file without :{}", shown, variable));
    }
    return read_plain(*this, file_name, format);
  }
  const nc::File file = open_input(file_name);
  check_classic_size(file_name);
  try {
    const bool named = !variable.empty() || !file.find_variable(otherwise);
    Dem dem = read_from(file, named ? variable : otherwise, units, gaps,
                        {.radius_km = radius_km, .flattening = flattening});
    dem.source = shown + ":" + dem.variable;
    return dem;
  } catch (const nc::Failure& failure) {
    throw InputError(fmt::format("{}: truncated or damaged ({})", shown, failure.what()));
  } catch (const ConfigurationError& error) {
    throw InputError(fmt::format("{}: {}", shown, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", shown, error.what()));
  }
}

Dem read_dem(const std::string& file_and_variable, const Planet& planet, const ImageWords& image) {
  return read_raster(file_and_variable, "", "m", Gaps::refused, planet, image);
}

Dem read_dem_with_gaps(const std::string& file_and_variable, const Planet& planet) {
  return read_raster(file_and_variable, "", "m", Gaps::nan, planet);
}

Dem read_field(const std::string& file_and_variable, const FieldSpec& spec, const Planet& planet,
               const ImageWords& image) {
  return within_bounds(
      read_raster(file_and_variable, std::string(spec.name), std::string(spec.units), Gaps::refused,
                  planet, image, bounds_of(spec)),
      spec);
}

Dem read_field_with_gaps(const std::string& file_and_variable, const FieldSpec& spec,
                         const Planet& planet, const ImageWords& image) {
  return within_bounds(
      read_raster(file_and_variable, std::string(spec.name), std::string(spec.units), Gaps::nan,
                  planet, image, bounds_of(spec)),
      spec);
}

std::vector<float> resample(const Dem& dem, const Grid& target) {
  if (target.turn() != std::array<double, 3>{}) {
    const Grid finer = Grid::sphere(2 * target.nx(), 2 * target.ny(), target.figure());
    return laid_out_turned(finer, resample(dem, finer), target);
  }
  const bool own_raster = !dem.raster_m.empty();
  const bool metric =
      !dem.grid.is_latitude_longitude() && !target.is_latitude_longitude() && !own_raster;
  const auto raster = [&](const Grid& grid) {
    return metric ? metric_raster_of(grid) : raster_of(grid);
  };
  const Raster from = own_raster ? dem.raster : raster(dem.grid);
  const Raster to = raster(target);
  const std::vector<float>& values = own_raster ? dem.raster_m : dem.elevation_m;
  if (from == to) return values;
  std::vector<float> elevation_m(target.size());
  resample_raster(from, values, to, elevation_m, target.figure());
  return elevation_m;
}

}  // namespace geo::io
