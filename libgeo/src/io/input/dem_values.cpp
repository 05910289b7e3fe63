#include "dem_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geo/core/error.hpp"
#include "io/netcdf/units.hpp"

namespace geo::io {
namespace {

/// How stored numbers become values, and which of them stand for nothing.
struct Packing {
  double scale = 1.0;
  double offset = 0.0;
  std::vector<double> missing;
  double valid_min = -std::numeric_limits<double>::infinity();
  double valid_max = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_missing(double stored) const {
    if (!(stored >= valid_min && stored <= valid_max) || !std::isfinite(stored)) return true;
    return std::find(missing.begin(), missing.end(), stored) != missing.end();
  }
};

/// What netCDF puts where nothing was ever written.
std::optional<double> default_fill(nc_type type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_FLOAT:
      return NC_FILL_FLOAT;
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return {};
  }
}

double factor_to(const std::string& target, const nc::File& file, int variable) {
  if (target.empty()) return 1.0;
  const auto units = file.text(variable, "units");
  if (!units || units->empty()) return 1.0;  // GDAL and GMT often write none
  const auto factor = conversion_factor(*units, target);
  if (!factor) {
    throw InputError(fmt::format("variable {}: units are \"{}\", must be {}",
                                 file.variable_name(variable), *units,
                                 target == "m" ? "a length such as m" : "such as " + target));
  }
  return *factor;
}

Packing read_packing(const nc::File& file, int variable, const std::string& units) {
  Packing packing;
  const auto first = [&](const char* name, double otherwise) {
    const auto values = file.numbers(variable, name);
    return values.empty() ? otherwise : values[0];
  };
  packing.scale = first("scale_factor", 1.0);
  packing.offset = first("add_offset", 0.0);
  packing.missing = file.numbers(variable, "missing_value");
  const auto fill = file.numbers(variable, "_FillValue");
  packing.missing.insert(packing.missing.end(), fill.begin(), fill.end());
  if (fill.empty()) {
    if (const auto value = default_fill(file.variable_type(variable))) {
      packing.missing.push_back(*value);
    }
  }
  packing.valid_min = first("valid_min", packing.valid_min);
  packing.valid_max = first("valid_max", packing.valid_max);
  const auto range = file.numbers(variable, "valid_range");
  if (range.size() == 2) {
    packing.valid_min = range[0];
    packing.valid_max = range[1];
  }
  const double factor = factor_to(units, file, variable);
  packing.scale *= factor;
  packing.offset *= factor;
  return packing;
}

/// Missing cells so far.
struct Missing {
  long count = 0;
  int row = 0, column = 0;
};

[[noreturn]] void refuse(const std::string& name, const Missing& gaps, const DemAxis& rows,
                         const DemAxis& columns) {
  const bool degrees = rows.kind == AxisKind::latitude;
  throw InputError(fmt::format(
      "variable {}: {} cell(s) are missing or NaN, the first at row {}, column {} ({} {:.6g}, {} "
      "{:.6g}); fill the gaps first, for instance with gdal_fillnodata.py or cdo setmisstonn",
      name, gaps.count, gaps.row, gaps.column, degrees ? "latitude" : "y", rows.at(gaps.row),
      degrees ? "longitude" : "x", columns.at(gaps.column)));
}

}  // namespace

std::vector<float> read_values(const nc::File& file, int variable, const DemAxis& rows,
                               const DemAxis& columns, const std::string& units, Gaps allowed) {
  const std::string name = file.variable_name(variable);
  const Packing packing = read_packing(file, variable, units);
  const auto dimensions = file.dimensions_of(variable).size();
  std::vector<std::size_t> start(dimensions, 0), count(dimensions, 1);
  const std::size_t nx = columns.size, ny = rows.size;
  file.check_size(variable);
  std::vector<float> values(nx * ny);

  // Blocks as tall as common chunks, so that each chunk is unpacked once.
  constexpr std::size_t kBlockRows = 512;
  std::vector<double> block(std::min(kBlockRows, ny) * nx);
  count.back() = nx;
  Missing gaps;
  for (std::size_t from = 0; from < ny; from += kBlockRows) {
    start[dimensions - 2] = from;
    count[dimensions - 2] = std::min(kBlockRows, ny - from);
    const int status =
        nc_get_vara_double(file.id(), variable, start.data(), count.data(), block.data());
    if (status != NC_NOERR) {
      throw InputError(
          fmt::format("variable {}: truncated or damaged ({})", name, nc_strerror(status)));
    }
    for (std::size_t k = 0; k < count[dimensions - 2] * nx; ++k) {
      const double value = block[k] * packing.scale + packing.offset;
      // What no float can hold is no value either.
      const bool missing =
          packing.is_missing(block[k]) || !(std::abs(value) <= std::numeric_limits<float>::max());
      if (missing) {
        if (gaps.count++ == 0) {
          gaps.row = static_cast<int>(from + k / nx);
          gaps.column = static_cast<int>(k % nx);
        }
      }
      values[from * nx + k] =
          missing ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
    }
  }
  if (gaps.count > 0 && allowed == Gaps::refused) refuse(name, gaps, rows, columns);
  return values;
}

}  // namespace geo::io
