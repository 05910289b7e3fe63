#include "geo/io/config/run_settings.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "geo/core/error.hpp"
#include "geo/io/maps/maps.hpp"

namespace geo::io {
namespace {

std::vector<std::string_view> names_of_projections() {
  std::vector<std::string_view> names;
  for (const MapProjection& each : map_projections()) names.push_back(each.name);
  return names;
}

std::vector<Parameter> run_rows(RunSettings& s) {
  return {
      integer("run.seed", s.seed, "1", 0, std::numeric_limits<std::int64_t>::max(),
              "seed of every random number", "design"),
      text("run.grid", s.grid,
           "cells as WIDTHxHEIGHT; auto takes the size of dem.file, without one 4096x2048, of a "
           "torus "
           "1024x1024",
           "design"),
      choice("run.topology", s.topology, {"sphere", "torus"},
             "a whole planet, or a tile as wide as the planet's circumference whose opposite sides "
             "meet, for plates.model = raster",
             "design"),
      text("run.turn", s.turn,
           "LAT,LON,ANGLE, degrees: turns the planet, and the files given for it, so that LAT,LON "
           "becomes the north pole and the prime meridian lies ANGLE further east; empty: not "
           "turned",
           "design"),
      text("run.from", s.from, "first stage to run; empty is the first there is", "design"),
      text("run.to", s.to, "last stage to run; empty is the last there is", "design"),
  };
}

std::vector<Parameter> dem_rows(RunSettings& s) {
  return {
      text("dem.file", s.dem_file,
           "file of a digital elevation model (NetCDF, GeoTIFF, grey PNG, ESRI ASCII), which takes "
           "the place of plates and isostasy",
           "design"),
      text("dem.variable", s.dem_variable,
           "variable of that file; empty is the one that looks like an elevation", "design"),
      text(
          "dem.range", s.dem_range,
          "MIN,MAX, values of black and white in an image (of elevations, in m); empty takes those "
          "of the JSON beside it; without dem.file they hold for images in fields.* without a JSON",
          "design"),
      text("dem.window", s.dem_window,
           "W,S,E,N, where the edges of images lie, degrees; empty is the whole planet, or what "
           "the JSON beside them says",
           "design"),
      choice("dem.sea_level", s.dem_sea_level, {"datum", "fraction"},
             "where the sea stands: at the DEM's own datum, or where planet.ocean_fraction of "
             "the area lies below it",
             "design"),
  };
}

std::vector<Parameter> fields_rows(RunSettings& s) {
  return {
      text("fields.erodibility", s.erodibility,
           "FILE[:VARIABLE] with the erodibility of each place, yr-1; empty is "
           "erosion.erodibility_yr everywhere",
           "design"),
      text("fields.uplift_rate", s.uplift_rate,
           "FILE[:VARIABLE] with the rock uplift of each place, as a velocity", "design"),
      text("fields.hypsography", s.hypsography,
           "target of plates.model = hypsography and erosion.hypsometry = rank: earth, "
           "earth-statistical, or a CSV file with columns quantile,elevation_m",
           "design"),
      choice("fields.hypsography_ocean", s.hypsography_ocean, {"planet", "curve"},
             "its parts below and above 0 are weighted so that planet.ocean_fraction lies below "
             "(where planet.sea_level is fraction), or it is used unchanged and its 0 is the sea "
             "level of all stages",
             "davidson2013"),
      text("fields.ranking", s.ranking,
           "FILE[:VARIABLE] of any unit, a mask or a DEM, that orders places by height where "
           "plates follow a hypsography",
           "davidson2013"),
      text("fields.plates", s.plates,
           "plates from which drift begins: earth, a GeoJSON file of polygons with their Euler "
           "poles, or, with fields.plate_rotations, static polygons of GPlates as GeoJSON or "
           "FILE[:VARIABLE] with the number of the plate at each place; empty draws plates.count "
           "of them",
           "bird2003"),
      text("fields.plate_rotations", s.plate_rotations,
           "CSV file with the motions of plates that fields.plates gives by number: plate_id, "
           "pole_latitude_deg, pole_longitude_deg, rate_deg_myr; the last row of a plate counts. "
           "Or a file of GPlates that ends in .rot, whose finite rotations drive the static "
           "polygons of fields.plates through time",
           "design"),
      real("fields.rotations_age_myr", s.rotations_from_ma, "Myr", 0.0, 1e5,
           "age in such a file at which the drift begins; 0: plates.sphere.time_myr before its "
           "youngest rotation",
           "design"),
      renamed(text("fields.initial_elevation", s.initial_elevation,
                   "FILE[:VARIABLE] of a planet's elevation from which drift begins where "
                   "plates.sphere.initial_elevation is given",
                   "cortial2019"),
              "fields.first_relief"),
      renamed(text("fields.initial_age", s.initial_age,
                   "FILE[:VARIABLE] of the age of its sea floor, Myr, missing on land; empty "
                   "derives it from depth",
                   "muller2008"),
              "fields.first_age"),
      text("fields.start_frame", s.start_frame,
           "frame of an earlier run from which the drift continues, bit for bit", "design"),
      text("fields.exemplars", s.exemplars,
           "folder of NetCDF or GeoTIFF files with elevations in m, the exemplars of terrain where "
           "island.detail or isostasy.detail is exemplars; empty uses those that terrane grows",
           "cortial2019"),
  };
}

std::vector<Parameter> output_rows(RunSettings& s) {
  return {
      flag("output.vtk", s.vtk, "write a VTK file beside each NetCDF file", "design"),
      flag("output.globe", s.globe,
           "write each stage of the planet also as a closed surface that ParaView shows as a globe",
           "design"),
      real("output.globe_exaggeration", s.globe_exaggeration, "1", 0.0, 1000.0,
           "factor of heights on those surfaces; 0 is a smooth globe", "design"),
      flag("output.maps", s.maps, "draw the maps and the report", "design"),
      integer("output.map_width_px", s.map_width_px, "1", 300, 20000, "width of the maps in pixels",
              "design"),
      choice("output.map_projection", s.map_projection, names_of_projections(),
             "projection of the maps of a planet; islands keep their own", "snyder1987"),
      text("output.map_center", s.map_center,
           "LAT,LON of the middle of the maps; empty is 0,0; only azimuthal projections take a "
           "latitude",
           "design"),
      flag("output.monthly", s.monthly,
           "also write temperature, precipitation and winds of the twelve months", "design"),
      integer("output.compression", s.compression, "1", 0, 9,
              "compression level of NetCDF files; 0 stores them uncompressed", "design"),
      integer("output.vtk_compression", s.vtk_compression, "1", 0, 9,
              "compression level of VTK files; 0 stores them uncompressed", "design"),
  };
}

}  // namespace

std::vector<Parameter> RunSettings::parameters() {
  return joined(*this, {run_rows, dem_rows, fields_rows, output_rows});
}

MapView RunSettings::map_view() const {
  MapView view(static_cast<int>(map_width_px));
  view.projection = map_projection;
  if (!map_center.empty()) view.centre = parse_centre("output.map_center", map_center);
  static_cast<void>(map_layout(Grid::sphere(8, 4), view));
  return view;
}

GridSize parse_grid_size(const std::string& text) {
  GridSize size{};
  const char* const end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.nx);
  if (width_error == std::errc() && after_width != end && *after_width == 'x') {
    const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.ny);
    if (height_error == std::errc() && after_height == end) return size;
  }
  throw ConfigurationError(
      fmt::format("run.grid = \"{}\": must be WIDTHxHEIGHT, such as 4096x2048, or auto", text));
}

std::pair<std::filesystem::path, std::string> split_dem(const std::string& file_and_variable) {
  const auto colon = file_and_variable.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(file_and_variable)) {
    return {file_and_variable, ""};
  }
  return {file_and_variable.substr(0, colon), file_and_variable.substr(colon + 1)};
}

}  // namespace geo::io
