#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geo::io {

/// Formats that other programs take a planet or an island in.
enum class ExportFormat { png16, r16, geotiff, zarr, healpix, glb, gplates };
/// One by its name; ConfigurationError that lists them.
ExportFormat parse_export_format(const std::string& name);
/// Their names, in the order above.
std::vector<std::string_view> export_format_names();
/// Names of 8-bit layers that may go beside a height map.
std::vector<std::string_view> export_mask_names();

/// What is exported, and how.
struct ExportRequest {
  std::string place;  ///< folder of a run, or one of its stage files
  std::string stage;  ///< of a run: "hydrology", "island-2"; empty: the last that wrote the field
  /// Empty: the elevation; with Zarr and HEALPix all fields of the stage.
  std::string field;
  ExportFormat format = ExportFormat::png16;
  /// Empty: named after the field, in the present folder.
  std::filesystem::path output;

  // Height maps.
  int tile_samples = 0;  ///< samples along a tile's edge, which neighbours share; 0: whole
  bool cube = false;     ///< six faces of a cube round the planet, with shared edges
  std::vector<std::string> masks;  ///< 8-bit layers of the same samples
  /// Values of sample 0 and 65535; empty: the least and the greatest there are.
  std::optional<std::pair<double, double>> range;

  int nside = 0;               ///< of HEALPix; 0: as near to the cells as a power of two comes
  double exaggeration = 15.0;  ///< of heights on a globe of glb; islands stand true to scale
};

/// Writes a field of a planet or an island, or the plates of a run, for other programs and returns
/// the paths of the files, each whole or not there:
///
/// - png16, r16: 16-bit samples, rows from the north, PNG or bare little-endian numbers. A JSON
///   beside them, of the same name, says range, offset and scale (value = offset + scale * sample),
///   size, tiles or faces, coordinate system, and what the masks mean. A whole image has a sample
///   for each cell. Tiles and faces have samples on their edges, the same ones to the bit as their
///   neighbours, read between cells by bicubic convolution (CatmullRom) within the field's range.
/// - geotiff: cloud-optimised: tiles of 512, overviews, directories before data; the field's own
///   type, coordinate system of planet or island, nodata, unit, colours of categories.
/// - zarr: a store of Zarr 2 with everything that the NetCDF file of the stage says.
/// - healpix: NetCDF, or Zarr where the output is called *.zarr; conservative means, of categories
///   that of the largest area.
/// - glb: glTF 2.0, a mesh of the surface with the field's map as texture. Axes as glTF has them: y
///   to the north pole, z to longitude 0; islands lie in x (east) and z (south).
/// - gplates: of the folder of a run, not of a field: a folder with the finite rotations of its
///   plates through time (rotations.rot) and, each as GeoJSON and as GPML, plates, boundaries,
///   coastlines, continents and isochrons of each of its frames. Numbers of plates are those of the
///   run plus 1000. Times are Ma before the end of the run; places, where the crust of the plate is
///   then, so that GPlates reconstructs them to where they were. Latitudes count as those of a
///   sphere.
///
/// Throws ConfigurationError for what does not go together, InputError, IoError.
std::vector<std::filesystem::path> export_field(const ExportRequest& request);

}  // namespace geo::io
