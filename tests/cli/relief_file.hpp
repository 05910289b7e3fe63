#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace geo {

/// A small relief file of a made-up planet, sound unless told otherwise.
struct ReliefFile {
  int nx = 72, ny = 36;
  std::string variable = "z", units = "m";
  std::optional<double> hole = {};  ///< stands in one cell
  double fill = -32768.0;           ///< the file's _FillValue
  double north_deg = 90.0;          ///< where its rows end
  double latitude_kink_deg = 0.0;   ///< added to one latitude
  bool one_dimensional = false;     ///< the variable has no columns
  /// Instead of continents in an ocean, if given: from latitude and longitude, degrees.
  std::function<double(double latitude_deg, double longitude_deg)> height_m = {};

  void write(const std::filesystem::path& path) const;
};

}  // namespace geo
