#include "dem_variable.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "dem_axis.hpp"
#include "geo/core/error.hpp"

namespace geo::io {
namespace {

constexpr std::array kStandardNames{"surface_altitude",
                                    "height_above_reference_ellipsoid",
                                    "height_above_mean_sea_level",
                                    "height_above_geopotential_datum",
                                    "bedrock_altitude",
                                    "altitude",
                                    "height"};
constexpr std::array kNames{"elevation", "topography", "topo",    "z",   "rose",
                            "altitude",  "height",     "band1",   "dem", "orog",
                            "hgt",       "relief",     "bedrock", "bed"};

std::string lower(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(letter));
  return text;
}

/// Rasters that describe the grid rather than the ground.
bool is_auxiliary(const nc::File& file, int variable) {
  const std::string standard_name = file.text(variable, "standard_name").value_or("");
  return standard_name == "latitude" || standard_name == "longitude" ||
         standard_name == "cell_area" || standard_name == "land_binary_mask";
}

std::vector<std::string> names_of(const nc::File& file, const std::vector<int>& variables) {
  std::vector<std::string> names;
  for (const int variable : variables) names.push_back(file.variable_name(variable));
  return names;
}

int find_named(const nc::File& file, const std::string& name, const std::vector<int>& rasters) {
  const auto variable = file.find_variable(name);
  if (!variable) {
    throw InputError(fmt::format("variable {} is missing; the file holds {}", name,
                                 fmt::join(names_of(file, rasters), ", ")));
  }
  std::string why;
  if (!is_raster(file, *variable, &why)) {
    throw InputError(fmt::format("variable {}: {}", name, why));
  }
  return *variable;
}

}  // namespace

bool is_raster(const nc::File& file, int variable, std::string* why) {
  const auto say = [&](std::string text) {
    if (why != nullptr) *why = std::move(text);
    return false;
  };
  const nc_type type = file.variable_type(variable);
  if (type == NC_CHAR || type >= NC_STRING) return say("is no number");
  const auto dimensions = file.dimensions_of(variable);
  if (dimensions.size() < 2) return say("must have two dimensions, latitude and longitude");
  for (std::size_t k = 0; k + 2 < dimensions.size(); ++k) {
    if (file.dimension_size(dimensions[k]) != 1) {
      return say(fmt::format("dimension {} has {} entries; pick one first",
                             file.dimension_name(dimensions[k]),
                             file.dimension_size(dimensions[k])));
    }
  }
  const int row = dimensions[dimensions.size() - 2], column = dimensions.back();
  for (const int dimension : {row, column}) {
    if (!kind_of_axis(file, dimension)) {
      return say(
          fmt::format("dimension {} has no coordinates in degrees_north, degrees_east or a "
                      "length",
                      file.dimension_name(dimension)));
    }
  }
  const auto kinds = std::pair(*kind_of_axis(file, row), *kind_of_axis(file, column));
  if (kinds != std::pair(AxisKind::latitude, AxisKind::longitude) &&
      kinds != std::pair(AxisKind::y, AxisKind::x)) {
    return say(
        fmt::format("dimensions {}, {} must be latitude, longitude (or y, x) in this order; "
                    "ncpdq -a {},{} turns them",
                    file.dimension_name(row), file.dimension_name(column),
                    file.dimension_name(column), file.dimension_name(row)));
  }
  return true;
}

int choose_variable(const nc::File& file, const std::string& name) {
  std::vector<int> rasters;
  std::string first_complaint;
  for (int variable = 0; variable < file.variables(); ++variable) {
    std::string why;
    if (is_raster(file, variable, &why)) {
      if (!is_auxiliary(file, variable)) rasters.push_back(variable);
    } else if (file.dimensions_of(variable).size() >= 2 && first_complaint.empty()) {
      first_complaint = fmt::format("variable {}: {}", file.variable_name(variable), why);
    }
  }
  if (!name.empty()) return find_named(file, name, rasters);
  for (const char* standard_name : kStandardNames) {
    for (const int variable : rasters) {
      if (file.text(variable, "standard_name").value_or("") == standard_name) return variable;
    }
  }
  for (const char* known : kNames) {
    for (const int variable : rasters) {
      if (lower(file.variable_name(variable)) == known) return variable;
    }
  }
  if (rasters.size() == 1) return rasters[0];
  if (rasters.empty()) {
    throw InputError(first_complaint.empty() ? "holds no raster over latitude and longitude"
                                             : first_complaint);
  }
  throw InputError(fmt::format("several variables may be the elevation: {}; say FILE:VARIABLE",
                               fmt::join(names_of(file, rasters), ", ")));
}

}  // namespace geo::io
