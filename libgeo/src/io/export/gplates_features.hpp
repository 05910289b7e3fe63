#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/vector3.hpp"
#include "geo/kernels/plates/rotation_model.hpp"

namespace geo::io {

/// A kind of feature as GPlates knows it.
struct GplatesType {
  std::string_view name;      ///< of the GPlates Geological Information Model, without "gpml:"
  std::string_view code;      ///< two letters of the PLATES line format; empty where it has none
  std::string_view geometry;  ///< name of the property that holds its geometry
};

namespace gplates {
inline constexpr GplatesType kPlate{"ClosedPlateBoundary", "", "boundary"};
inline constexpr GplatesType kRidge{"MidOceanRidge", "RI", "centerLineOf"};
inline constexpr GplatesType kRift{"ContinentalRift", "", "centerLineOf"};
inline constexpr GplatesType kTransform{"Transform", "TF", "centerLineOf"};
inline constexpr GplatesType kTrench{"SubductionZone", "TR", "centerLineOf"};
inline constexpr GplatesType kCollision{"OrogenicBelt", "OB", "unclassifiedGeometry"};
inline constexpr GplatesType kUnknown{"UnclassifiedFeature", "UN", "unclassifiedGeometry"};
inline constexpr GplatesType kCoast{"Coastline", "CS", "unclassifiedGeometry"};
inline constexpr GplatesType kContinent{"ContinentalCrust", "", "outlineOf"};
inline constexpr GplatesType kIsochron{"Isochron", "IC", "centerLineOf"};
}  // namespace gplates

/// A closed line with others within it, each with its first place repeated; anticlockwise outside.
struct GplatesPolygon {
  std::vector<Vector3> outside;
  std::vector<std::vector<Vector3>> holes;
};

/// Something on one plate for some time. Places are those of today: unit vectors, z to the north
/// pole, x to longitude 0. It has either polygons or lines.
struct GplatesFeature {
  const GplatesType* type = nullptr;
  std::string name = {};
  int plate = 0;                      ///< PLATEID1
  int conjugate = -1;                 ///< PLATEID2: the plate on the other side; -1: none
  double from_ma = 0.0, to_ma = 0.0;  ///< FROMAGE, TOAGE
  std::string_view polarity = {};  ///< of a trench: the side of the overriding plate, Left or Right
  std::vector<GplatesPolygon> polygons = {};
  std::vector<std::vector<Vector3>> lines = {};
};

/// Which of a planet's features a file holds.
using GplatesFeatures = std::vector<GplatesFeature>;

/// GeoJSON with the attributes that GPlates maps to its own: PLATEID1, PLATEID2, FROMAGE, TOAGE,
/// NAME, TYPE, GPGIM_TYPE; POLARITY besides. Lines cross the date line without being cut. Throws
/// IoError.
void write_gplates_geojson(const std::filesystem::path& path, const GplatesFeatures& features);
/// GPML 1.6, GPlates' own XML. Throws IoError.
void write_gpml(const std::filesystem::path& path, const GplatesFeatures& features);
/// A rotation file: moving plate, time (Ma), latitude, longitude, angle (degrees), fixed plate,
/// !comment. `comment_of` a sequence is written behind its lines. Throws IoError.
void write_rotations(const std::filesystem::path& path, const RotationModel& model,
                     const std::vector<std::string>& comment_of);

}  // namespace geo::io
