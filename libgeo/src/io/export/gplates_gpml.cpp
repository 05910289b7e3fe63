#include <fmt/format.h>

#include <pugixml.hpp>

#include "geo/core/place.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/digest.hpp"
#include "gplates_features.hpp"

namespace geo::io {
namespace {

constexpr const char* kFlatTime = "http://gplates.org/TRS/flat";

pugi::xml_node add(pugi::xml_node parent, const char* tag, const std::string& text = "") {
  pugi::xml_node node = parent.append_child(tag);
  if (!text.empty()) node.text().set(text.c_str());
  return node;
}

/// A value that does not change while the feature is there.
pugi::xml_node add_constant(pugi::xml_node parent, const char* tag, const char* type,
                            const std::string& text = "") {
  pugi::xml_node constant = add(add(parent, tag), "gpml:ConstantValue");
  const pugi::xml_node value = add(constant, "gpml:value", text);
  add(constant, "gml:description");
  add(constant, "gpml:valueType", type);
  return value;
}

void add_time(pugi::xml_node period, const char* end, double time_ma) {
  pugi::xml_node position =
      add(add(add(period, end), "gml:TimeInstant"), "gml:timePosition", fmt::to_string(time_ma));
  position.append_attribute("gml:frame") = kFlatTime;
}

/// Latitudes and longitudes in turn.
void add_positions(pugi::xml_node parent, const std::vector<Vector3>& line) {
  std::string text;
  for (const Vector3& at : line) {
    const Centre place = place_of(at);
    fmt::format_to(std::back_inserter(text), "{}{:.9f} {:.9f}", text.empty() ? "" : " ",
                   place.latitude_deg, place.longitude_deg);
  }
  add(parent, "gml:posList", text).append_attribute("gml:dimension") = "2";
}

void add_polygon(pugi::xml_node feature, const char* property, const GplatesPolygon& polygon) {
  const pugi::xml_node value = add(add_constant(feature, property, "gml:Polygon"), "gml:Polygon");
  add_positions(add(add(value, "gml:exterior"), "gml:LinearRing"), polygon.outside);
  for (const auto& hole : polygon.holes) {
    add_positions(add(add(value, "gml:interior"), "gml:LinearRing"), hole);
  }
}

void add_line(pugi::xml_node feature, const char* property, const std::vector<Vector3>& line) {
  pugi::xml_node curve =
      add(add_constant(feature, property, "gml:OrientableCurve"), "gml:OrientableCurve");
  curve.append_attribute("gml:orientation") = "+";
  add_positions(add(add(curve, "gml:baseCurve"), "gml:LineString"), line);
}

/// Names of features are found again from what they are, so that a run gives the same file twice.
std::string identity(std::string_view kind, std::size_t number, const GplatesFeature& feature) {
  const std::string digest = digest_of(fmt::format(
      "{} {} {} {} {}", kind, number, feature.type->name, feature.plate, feature.from_ma));
  return fmt::format("GPlates-{}-{}-{}-{}-{}", digest.substr(0, 8), digest.substr(8, 4),
                     digest.substr(12, 4), digest.substr(16, 4), digest.substr(20, 12));
}

void add_feature(pugi::xml_node collection, std::size_t number, const GplatesFeature& feature) {
  const std::string tag = "gpml:" + std::string(feature.type->name);
  const std::string property = "gpml:" + std::string(feature.type->geometry);
  pugi::xml_node node = add(add(collection, "gml:featureMember"), tag.c_str());
  add(node, "gpml:identity", identity("feature", number, feature));
  add(node, "gpml:revision", identity("revision", number, feature));
  add(node, "gml:name", feature.name);
  const pugi::xml_node period = add(add(node, "gml:validTime"), "gml:TimePeriod");
  add_time(period, "gml:begin", feature.from_ma);
  add_time(period, "gml:end", feature.to_ma);
  add_constant(node, "gpml:reconstructionPlateId", "gpml:plateId", fmt::to_string(feature.plate));
  if (feature.conjugate >= 0) {
    add(node, "gpml:conjugatePlateId", fmt::to_string(feature.conjugate));
  }
  if (!feature.polarity.empty()) {
    add_constant(node, "gpml:subductionPolarity", "gpml:SubductionPolarityEnumeration",
                 std::string(feature.polarity));
  }
  for (const auto& polygon : feature.polygons) add_polygon(node, property.c_str(), polygon);
  for (const auto& line : feature.lines) add_line(node, property.c_str(), line);
}

}  // namespace

void write_gpml(const std::filesystem::path& path, const GplatesFeatures& features) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node collection = add(document, "gpml:FeatureCollection");
  collection.append_attribute("xmlns:gpml") = "http://www.gplates.org/gplates";
  collection.append_attribute("xmlns:gml") = "http://www.opengis.net/gml";
  collection.append_attribute("xmlns:xsi") = "http://www.w3.org/XMLSchema-instance";
  collection.append_attribute("gpml:version") = "1.6.0339";
  collection.append_attribute("xsi:schemaLocation") =
      "http://www.gplates.org/gplates ../xsd/gpml.xsd "
      "http://www.opengis.net/gml ../../../gml/current/base";
  for (std::size_t k = 0; k < features.size(); ++k) add_feature(collection, k, features[k]);
  AtomicFile file(path);
  if (!document.save_file(file.temporary().c_str(), " ", pugi::format_indent,
                          pugi::encoding_utf8)) {
    file.fail("cannot be written");
  }
  file.commit();
}

}  // namespace geo::io
