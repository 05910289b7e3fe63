#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/netcdf/netcdf_file.hpp"

namespace geo::io {

enum class AxisKind { latitude, longitude, y, x };

/// A horizontal axis of a file: centres at even steps, ascending, in degrees or m.
struct DemAxis {
  std::string name;
  AxisKind kind;
  double first = 0.0;
  double step = 0.0;
  int size = 0;
  bool reversed = false;  ///< the file runs the other way

  [[nodiscard]] double last() const { return first + (size - 1) * step; }
  [[nodiscard]] double low() const { return first - 0.5 * step; }
  [[nodiscard]] double high() const { return last() + 0.5 * step; }
  /// Coordinate of an index of the file.
  [[nodiscard]] double at(int index) const {
    return first + (reversed ? size - 1 - index : index) * step;
  }
};

/// What a dimension's coordinate variable says it is; nothing where it is no horizontal axis.
std::optional<AxisKind> kind_of_axis(const nc::File& file, int dimension);

/// Reads a horizontal axis. Throws InputError (without path) where steps are uneven.
DemAxis read_axis(const nc::File& file, int dimension);

}  // namespace geo::io
