#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/event.hpp"
#include "geo/core/parameter.hpp"
#include "geo/io/drawing/map_view.hpp"

namespace geo::io {

/// Columns and rows of a grid.
struct GridSize {
  int nx, ny;
};

/// What a run needs besides the planet and the stages: sections [run], [dem], [fields] and
/// [output], and the tables [[event]].
struct RunSettings {
  std::int64_t seed = 1;
  std::string grid = "auto";
  std::string topology = "sphere";
  std::string turn;  ///< "LAT,LON,ANGLE"
  std::string from;
  std::string to;

  std::string dem_file;
  std::string dem_variable;
  std::string dem_range;   ///< "MIN,MAX" of an image
  std::string dem_window;  ///< "W,S,E,N" of an image
  std::string dem_sea_level = "datum";
  std::string erodibility;  ///< FILE[:VARIABLE]
  std::string uplift_rate;  ///< FILE[:VARIABLE]
  std::string hypsography = "earth";
  std::string hypsography_ocean = "planet";
  std::string ranking;             ///< FILE[:VARIABLE]
  std::string plates;              ///< "earth" or a file
  std::string plate_rotations;     ///< motions of plates that are given by number
  double rotations_from_ma = 0.0;  ///< where these are finite ones; 0: as late as they allow
  std::string initial_elevation;   ///< FILE[:VARIABLE]
  std::string initial_age;         ///< FILE[:VARIABLE]
  std::string start_frame;
  std::string exemplars;  ///< folder

  bool vtk = true;
  bool globe = false;
  double globe_exaggeration = 15.0;
  bool maps = true;
  std::int64_t map_width_px = 1800;
  std::string map_projection = "equirectangular";
  std::string map_center;  ///< "LAT,LON"; empty: 0,0
  std::int64_t compression = 1;
  std::int64_t vtk_compression = 0;
  bool monthly = false;

  std::vector<Event> events;

  [[nodiscard]] std::vector<Parameter> parameters();
  /// How maps show the planet. Throws ConfigurationError where projection and centre do not go
  /// together.
  [[nodiscard]] MapView map_view() const;
  [[nodiscard]] bool grid_is_automatic() const { return grid == "auto"; }
};

/// Reads "WIDTHxHEIGHT". ConfigurationError when it is not.
GridSize parse_grid_size(const std::string& text);
/// Splits `FILE[:VARIABLE]`; a file whose own name has a colon is taken whole when it exists.
std::pair<std::filesystem::path, std::string> split_dem(const std::string& file_and_variable);

}  // namespace geo::io
