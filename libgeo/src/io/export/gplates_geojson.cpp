#include <cmath>
#include <nlohmann/json.hpp>

#include "geo/core/place.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "gplates_features.hpp"

namespace geo::io {
namespace {

using Json = nlohmann::json;

/// Nine decimals of a degree are a tenth of a millimetre.
double rounded(double degrees) { return std::round(1e9 * degrees) / 1e9; }

Json positions(const std::vector<Vector3>& line) {
  Json all = Json::array();
  for (const Vector3& at : line) {
    const Centre place = place_of(at);
    all.push_back({rounded(place.longitude_deg), rounded(place.latitude_deg)});
  }
  return all;
}

Json rings(const GplatesPolygon& polygon) {
  Json all = Json::array({positions(polygon.outside)});
  for (const auto& hole : polygon.holes) all.push_back(positions(hole));
  return all;
}

Json geometry_of(const GplatesFeature& feature) {
  Json parts = Json::array();
  for (const GplatesPolygon& polygon : feature.polygons) parts.push_back(rings(polygon));
  for (const auto& line : feature.lines) parts.push_back(positions(line));
  const std::string kind = feature.polygons.empty() ? "LineString" : "Polygon";
  if (parts.size() == 1) return {{"type", kind}, {"coordinates", parts[0]}};
  return {{"type", "Multi" + kind}, {"coordinates", parts}};
}

Json properties_of(const GplatesFeature& feature) {
  Json properties{
      {"PLATEID1", feature.plate},  {"FROMAGE", feature.from_ma},
      {"TOAGE", feature.to_ma},     {"NAME", feature.name},
      {"TYPE", feature.type->code}, {"GPGIM_TYPE", "gpml:" + std::string(feature.type->name)}};
  if (feature.conjugate >= 0) properties["PLATEID2"] = feature.conjugate;
  if (!feature.polarity.empty()) properties["POLARITY"] = feature.polarity;
  return properties;
}

}  // namespace

void write_gplates_geojson(const std::filesystem::path& path, const GplatesFeatures& features) {
  // A line for each feature: the files are large, and compare well so.
  std::string text = "{\"type\":\"FeatureCollection\",\"features\":[\n";
  for (std::size_t k = 0; k < features.size(); ++k) {
    const Json feature{{"type", "Feature"},
                       {"properties", properties_of(features[k])},
                       {"geometry", geometry_of(features[k])}};
    text += feature.dump() + (k + 1 < features.size() ? ",\n" : "\n");
  }
  write_text_file(path, text + "]}\n");
}

}  // namespace geo::io
