#include "dem_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "geo/core/error.hpp"
#include "io/netcdf/units.hpp"

namespace geo::io {
namespace {

std::string lower(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(letter));
  return text;
}

std::string lower_attribute(const nc::File& file, int variable, const char* name) {
  return lower(file.text(variable, name).value_or(""));
}

std::optional<int> coordinate_variable(const nc::File& file, int dimension) {
  const auto variable = file.find_variable(file.dimension_name(dimension));
  if (!variable || file.dimensions_of(*variable) != std::vector{dimension}) return {};
  const nc_type type = file.variable_type(*variable);
  if (type == NC_CHAR || type >= NC_STRING) return {};
  return variable;
}

std::optional<AxisKind> kind_in_degrees(const std::string& standard_name, const std::string& name,
                                        const std::string& units) {
  // Rotated poles have degrees too, of another sphere.
  if (standard_name.starts_with("grid_") || name == "rlat" || name == "rlon") return {};
  if (units == "degrees_north" || units == "degree_north" || units == "degrees_n" ||
      units == "degree_n" || units == "degreesn" || units == "degreen") {
    return AxisKind::latitude;
  }
  if (units == "degrees_east" || units == "degree_east" || units == "degrees_e" ||
      units == "degree_e" || units == "degreese" || units == "degreee") {
    return AxisKind::longitude;
  }
  if (standard_name == "latitude" || name.starts_with("lat")) return AxisKind::latitude;
  if (standard_name == "longitude" || name.starts_with("lon")) return AxisKind::longitude;
  if (units.starts_with("degree") && name == "y") return AxisKind::latitude;
  if (units.starts_with("degree") && name == "x") return AxisKind::longitude;
  return {};
}

std::optional<AxisKind> kind_in_metres(const std::string& standard_name, const std::string& name,
                                       const std::string& axis) {
  if (standard_name == "projection_y_coordinate" || axis == "y") return AxisKind::y;
  if (standard_name == "projection_x_coordinate" || axis == "x") return AxisKind::x;
  if (name.starts_with("y") || name.starts_with("north")) return AxisKind::y;
  if (name.starts_with("x") || name.starts_with("east")) return AxisKind::x;
  return {};
}

std::vector<double> axis_values(const nc::File& file, int variable, const std::string& name) {
  file.check_size(variable);
  // A grid has 2^29 cells at most, and three along its shorter side.
  constexpr std::size_t kMost = (std::size_t{1} << 29) / 3;
  const std::size_t size = file.length_of(file.dimensions_of(variable)[0]);
  if (size > kMost) {
    throw InputError(fmt::format("axis {}: {} values, must have {} at most", name, size, kMost));
  }
  std::vector<double> values(size);
  try {
    nc::check(nc_get_var_double(file.id(), variable, values.data()));
  } catch (const nc::Failure& failure) {
    throw InputError(fmt::format("axis {}: truncated or damaged ({})", name, failure.what()));
  }
  const auto scale = file.numbers(variable, "scale_factor");
  const auto offset = file.numbers(variable, "add_offset");
  for (double& value : values) {
    if (!scale.empty()) value *= scale[0];
    if (!offset.empty()) value += offset[0];
  }
  return values;
}

void check_even(const DemAxis& axis, const std::vector<double>& values) {
  double greatest = 0.0;
  for (const double value : values) greatest = std::max(greatest, std::abs(value));
  // Half a hundredth of a cell, and the rounding of coordinates kept in single precision.
  const double tolerance = 0.005 * axis.step + 2e-7 * greatest;
  for (int i = 0; i < axis.size; ++i) {
    if (!(std::abs(values[i] - axis.at(i)) <= tolerance)) {
      throw InputError(
          fmt::format("axis {}: steps are uneven at index {} (value {}, even steps "
                      "would have {}); interpolate to a regular grid first",
                      axis.name, i, values[i], axis.at(i)));
    }
  }
}

}  // namespace

std::optional<AxisKind> kind_of_axis(const nc::File& file, int dimension) {
  const auto variable = coordinate_variable(file, dimension);
  if (!variable) return {};
  const std::string name = lower(file.dimension_name(dimension));
  const std::string standard_name = lower_attribute(file, *variable, "standard_name");
  const std::string units = lower_attribute(file, *variable, "units");
  if (const auto kind = kind_in_degrees(standard_name, name, units)) return kind;
  if (units.empty() || !conversion_factor(units, "m")) return {};
  return kind_in_metres(standard_name, name, lower_attribute(file, *variable, "axis"));
}

DemAxis read_axis(const nc::File& file, int dimension) {
  DemAxis axis;
  axis.name = file.dimension_name(dimension);
  axis.kind = kind_of_axis(file, dimension).value();
  const int variable = coordinate_variable(file, dimension).value();
  auto values = axis_values(file, variable, axis.name);
  axis.size = static_cast<int>(values.size());
  if (axis.size < 3) {
    throw InputError(
        fmt::format("axis {}: {} value(s), at least 3 are needed", axis.name, axis.size));
  }
  if (axis.kind == AxisKind::x || axis.kind == AxisKind::y) {
    const double metres = conversion_factor(file.text(variable, "units").value_or(""), "m").value();
    for (double& value : values) value *= metres;
  }
  axis.reversed = values.front() > values.back();
  axis.first = std::min(values.front(), values.back());
  axis.step = std::abs(values.back() - values.front()) / (axis.size - 1);
  if (!(axis.step > 0.0) || !std::isfinite(axis.step)) {
    throw InputError(fmt::format("axis {}: values must rise or fall steadily", axis.name));
  }
  check_even(axis, values);
  return axis;
}

}  // namespace geo::io
