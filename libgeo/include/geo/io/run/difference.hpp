#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geo/io/netcdf/stage_file.hpp"

namespace geo::io {

/// How far real numbers may be apart and still count as the same. Whole numbers must be equal.
struct Tolerance {
  double absolute = 0.0;  ///< in the field's unit
  double relative = 0.0;  ///< of the larger of both
};

/// How a field of one file is to that of another.
struct FieldDifference {
  std::string name, units;
  /// "only in the first", "other cells": why there is nothing to compare. Else empty.
  std::string fault;
  double cells = 0.0;
  double different = 0.0;  ///< cells beyond the tolerance, and those that one file alone has
  double largest = 0.0;    ///< of the absolute differences; infinite where one is missing
  double mean = 0.0;       ///< of the absolute differences of cells that both have
  Index cell = kNoCell;    ///< where the largest is
  double first = 0.0, second = 0.0;  ///< what stands there
  std::optional<Centre> place;

  [[nodiscard]] bool is_same() const { return fault.empty() && different == 0.0; }
};

/// Compares two stage files field by field, in the order of the vocabulary: those of the first,
/// then what the second alone has. Missing equals missing. Fields on unlike grids have a fault.
std::vector<FieldDifference> differences(const Snapshot& first, const Snapshot& second,
                                         const Tolerance& tolerance);

}  // namespace geo::io
