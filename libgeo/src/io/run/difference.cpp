#include "geo/io/run/difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace geo::io {
namespace {

const Values* values_of(const Snapshot& snapshot, const FieldSpec& spec) {
  for (const auto& [held, values] : snapshot.fields) {
    if (held == &spec) return values.get();
  }
  return nullptr;
}

bool same_grid(const Grid& a, const Grid& b) {
  if (a.topology() != b.topology() || a.nx() != b.nx() || a.ny() != b.ny() ||
      a.is_latitude_longitude() != b.is_latitude_longitude()) {
    return false;
  }
  const auto areas_a = a.row_areas_m2(), areas_b = b.row_areas_m2();
  if (!std::equal(areas_a.begin(), areas_a.end(), areas_b.begin())) return false;
  if (!a.is_geographic() || !b.is_geographic()) return a.is_geographic() == b.is_geographic();
  const Centre one = a.position(0, 0), other = b.position(0, 0);
  return one.latitude_deg == other.latitude_deg && one.longitude_deg == other.longitude_deg;
}

template <class T>
void compare(const std::vector<T>& first, const std::vector<T>& second, double missing,
             const Tolerance& tolerance, FieldDifference& result) {
  constexpr bool kReal = std::is_floating_point_v<T>;
  const auto is_missing = [&](T value) {
    return kReal ? std::isnan(static_cast<double>(value)) : static_cast<double>(value) == missing;
  };
  double sum = 0.0, both = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto a = static_cast<double>(first[i]), b = static_cast<double>(second[i]);
    const bool none_a = is_missing(first[i]), none_b = is_missing(second[i]);
    if (none_a && none_b) continue;
    const double apart = none_a != none_b ? std::numeric_limits<double>::infinity()
                         : a == b         ? 0.0
                                          : std::abs(a - b);
    const double allowed = kReal ? std::max(tolerance.absolute,
                                            tolerance.relative * std::max(std::abs(a), std::abs(b)))
                                 : 0.0;
    if (apart > allowed) result.different += 1.0;
    if (std::isfinite(apart)) {
      sum += apart;
      both += 1.0;
    }
    if (apart > result.largest) {
      result.largest = apart;
      result.cell = static_cast<Index>(i);
      result.first = none_a ? std::numeric_limits<double>::quiet_NaN() : a;
      result.second = none_b ? std::numeric_limits<double>::quiet_NaN() : b;
    }
  }
  result.cells = static_cast<double>(first.size());
  result.mean = both > 0.0 ? sum / both : 0.0;
}

}  // namespace

std::vector<FieldDifference> differences(const Snapshot& first, const Snapshot& second,
                                         const Tolerance& tolerance) {
  const bool same_cells = same_grid(*first.grid, *second.grid);
  std::vector<FieldDifference> results;
  for (const auto& [spec, values] : first.fields) {
    FieldDifference result;
    result.name = spec->name;
    result.units = spec->units;
    const Values* const other = values_of(second, *spec);
    if (other == nullptr) {
      result.fault = "only in the first";
    } else if (!same_cells) {
      result.fault = "other cells";
    } else {
      std::visit(
          [&, missing = spec->missing]<class T>(const std::vector<T>& array) {
            compare(array, std::get<std::vector<T>>(*other), missing, tolerance, result);
          },
          *values);
      const Grid& grid = *first.grid;
      if (result.cell != kNoCell && grid.is_geographic()) {
        result.place = grid.position(grid.column(result.cell), grid.row(result.cell));
      }
    }
    results.push_back(result);
  }
  for (const auto& [spec, values] : second.fields) {
    if (values_of(first, *spec) != nullptr) continue;
    FieldDifference result;
    result.name = spec->name;
    result.units = spec->units;
    result.fault = "only in the second";
    results.push_back(result);
  }
  return results;
}

}  // namespace geo::io
