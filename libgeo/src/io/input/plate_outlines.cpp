#include "geo/io/input/plate_outlines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/embedded_data.hpp"
#include "geo/kernels/plates/region_outline.hpp"

namespace geo::io {
namespace {

using Json = nlohmann::json;

/// A ring whose edges are arcs of great circles, as one of short edges: longitudes go on from that
/// of the place before.
std::vector<Centre> along_great_circles(const std::vector<Centre>& ring) {
  constexpr double kLongest = std::numbers::pi / 180.0;
  std::vector<Centre> line;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    line.push_back(ring[k]);
    if (k + 1 == ring.size()) break;
    const Vector3 from = unit_vector_of(ring[k]), to = unit_vector_of(ring[k + 1]);
    const double angle = angle_between(from, to);
    const auto parts = static_cast<int>(std::ceil(angle / kLongest));
    for (int part = 1; part < parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      Centre at = place_of(normalised(
          add(scaled(from, std::sin((1.0 - share) * angle)), to, std::sin(share * angle))));
      const double before_deg = line.back().longitude_deg;
      at.longitude_deg = before_deg + std::remainder(at.longitude_deg - before_deg, 360.0);
      line.push_back(at);
    }
  }
  return line;
}

/// One feature while it is read; errors say where.
class Feature {
 public:
  Feature(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json_.is_object()) refuse("must be a Feature");
    if (const auto found = json_.find("properties"); found != json_.end() && found->is_object()) {
      properties_ = &*found;
    }
    take_name(text("name", "Name", "PlateName", "Code"));
  }

  [[nodiscard]] PlateOutline outline() const {
    PlateOutline plate{.name = name_, .rings = rings(), .pole = {}, .rate_deg_myr = 0.0};
    set_motion(plate);
    return plate;
  }
  /// The same as GPlates writes it.
  [[nodiscard]] DatedOutline dated() {
    if (name_ == where_) take_name(text("NAME"));
    const auto plate = number("PLATEID1", "PLATEID1");
    if (!plate) refuse("needs the property PLATEID1, the number of its plate in the rotations");
    constexpr double kMost = 999999999.0;
    if (*plate != std::round(*plate) || *plate < 0.0 || *plate > kMost) {
      refuse(fmt::format("PLATEID1 = {:g}: must be a whole number, 0 or more", *plate));
    }
    checks_crossings_ = false;
    DatedOutline out{.plate = static_cast<int>(*plate),
                     .where = where_,
                     .outline = {.name = name_, .rings = {}, .pole = {}, .rate_deg_myr = 0.0}};
    for (const auto& ring : rings()) out.outline.rings.push_back(along_great_circles(ring));
    if (const auto from = number("FROMAGE", "FROMAGE"); from && *from < kAlways_ma) {
      out.from_ma = *from;
    }
    if (const auto to = number("TOAGE", "TOAGE"); to && *to > -kAlways_ma) out.to_ma = *to;
    if (out.from_ma < out.to_ma) {
      refuse(fmt::format("FROMAGE = {:g} is younger than TOAGE = {:g}", out.from_ma, out.to_ma));
    }
    return out;
  }

 private:
  static constexpr double kAlways_ma = 999.0;  // GPlates' word for the distant past and future

  void take_name(const std::optional<std::string>& given) {
    if (given) {
      name_ = *given;
      where_ += fmt::format(" ({})", name_);
    } else {
      name_ = where_;
    }
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", where_, what));
  }
  template <class... Names>
  [[nodiscard]] std::optional<std::string> text(Names... names) const {
    for (const char* name : {names...}) {
      if (properties_ == nullptr) break;
      const auto found = properties_->find(name);
      if (found != properties_->end() && found->is_string()) return found->get<std::string>();
    }
    return {};
  }
  [[nodiscard]] std::optional<double> number(const char* name, const char* otherwise) const {
    for (const char* key : {name, otherwise}) {
      if (properties_ == nullptr) break;
      const auto found = properties_->find(key);
      if (found == properties_->end() || found->is_null()) continue;
      if (!found->is_number()) refuse(fmt::format("property {} must be a number", key));
      return found->get<double>();
    }
    return {};
  }

  void set_motion(PlateOutline& plate) const {
    const auto latitude = number("pole_latitude_deg", "pole_lat");
    const auto longitude = number("pole_longitude_deg", "pole_lon");
    const auto rate = number("rate_deg_myr", "rate");
    if (latitude && longitude && rate) {
      plate.pole = {*latitude, *longitude};
      plate.rate_deg_myr = *rate;
    } else if (const bool is_partial = latitude || longitude || rate;
               is_partial || !take_known_motion(plate)) {
      const auto code = text("Code");
      refuse(fmt::format(
          "{}needs the properties pole_latitude_deg, pole_longitude_deg and rate_deg_myr, or the "
          "Code of a plate of PB2002",
          code && !is_partial ? fmt::format("{} is no Code of PB2002: ", *code) : ""));
    }
    check(plate.pole);
    if (!(std::abs(plate.rate_deg_myr) <= kFastestPlate_deg_myr)) {
      refuse(fmt::format("rate_deg_myr = {:g}: must be in [-100, 100]", plate.rate_deg_myr));
    }
  }
  [[nodiscard]] bool take_known_motion(PlateOutline& plate) const {
    const auto code = text("Code");
    if (!code) return false;
    static const Table poles = embedded_table("plates/pb2002_poles.csv");
    for (std::size_t row = 0; row < poles.rows(); ++row) {
      if (poles.text(row, 0) != *code) continue;
      plate.pole = {poles.number(row, 1), poles.number(row, 2)};
      plate.rate_deg_myr = poles.number(row, 3);
      return true;
    }
    return false;
  }

  void check(const Centre& place) const {
    if (std::abs(place.latitude_deg) <= 90.0 && std::abs(place.longitude_deg) <= 360.0) return;
    refuse(fmt::format("{:g}, {:g} is no longitude in [-360, 360] and latitude in [-90, 90]",
                       place.longitude_deg, place.latitude_deg));
  }
  [[nodiscard]] std::vector<std::vector<Centre>> rings() const {
    const auto found = json_.find("geometry");
    if (found == json_.end() || !found->is_object()) refuse("has no geometry");
    const auto kind = found->find("type");
    const std::string type =
        kind != found->end() && kind->is_string() ? kind->get<std::string>() : "";
    const auto coordinates = found->find("coordinates");
    if (coordinates == found->end() || (type != "Polygon" && type != "MultiPolygon")) {
      refuse(fmt::format("geometry is {}, must be a Polygon or a MultiPolygon",
                         type.empty() ? "of no type" : "a " + type));
    }
    std::vector<std::vector<Centre>> all;
    const auto add_polygon = [&](const Json& polygon) {
      if (!polygon.is_array() || polygon.empty()) refuse("a polygon must be an array of rings");
      for (const Json& ring : polygon) all.push_back(ring_of(ring));
    };
    if (type == "Polygon") {
      add_polygon(*coordinates);
    } else {
      if (!coordinates->is_array()) refuse("a MultiPolygon must be an array of polygons");
      for (const Json& polygon : *coordinates) add_polygon(polygon);
    }
    return all;
  }
  [[nodiscard]] std::vector<Centre> ring_of(const Json& json) const {
    std::vector<Centre> ring;
    if (!json.is_array()) refuse("a ring must be an array of positions [longitude, latitude]");
    for (const Json& at : json) {
      if (!at.is_array() || at.size() < 2 || !at[0].is_number() || !at[1].is_number()) {
        refuse(fmt::format("position {} of a ring must be [longitude, latitude]", ring.size() + 1));
      }
      ring.push_back({at[1].get<double>(), at[0].get<double>()});
      check(ring.back());
    }
    const bool closed =
        !ring.empty() && ring.front().latitude_deg == ring.back().latitude_deg &&
        std::remainder(ring.front().longitude_deg - ring.back().longitude_deg, 360.0) == 0.0;
    if (ring.size() < 4 || !closed) {
      refuse("a ring must be four positions or more, the last one as the first");
    }
    if (!checks_crossings_) return ring;
    if (const auto crossing = first_crossing(ring)) {
      refuse(fmt::format("a ring crosses itself: its edges behind positions {} and {} do",
                         crossing->first + 1, crossing->second + 1));
    }
    return ring;
  }

  const Json& json_;
  std::string where_, name_;
  bool checks_crossings_ = true;
  const Json* properties_ = nullptr;
};

Json parse(const std::string& text, const std::string& source) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}: is no JSON: broken at byte {}", source, error.byte));
  } catch (const Json::out_of_range&) {
    throw InputError(fmt::format("{}: holds a number that is too large", source));
  }
}

/// Older files of GeoJSON may say in which system their positions are.
void check_reference_system(const Json& json, const std::string& source) {
  const auto given = json.find("crs");
  if (given == json.end() || given->is_null()) return;
  const Json::json_pointer where("/properties/name");
  const auto name = given->contains(where) && given->at(where).is_string()
                        ? given->at(where).get<std::string>()
                        : std::string();
  for (const char* known : {"CRS84", "EPSG::4326", "EPSG:4326"}) {
    if (name.ends_with(known)) return;
  }
  throw InputError(
      fmt::format("{}: crs is {}: positions must be longitude and latitude in degrees (CRS84)",
                  source, name.empty() ? "unknown" : name));
}

/// The features of a collection, each handed over with where it is: f(feature, where).
template <class F>
void for_each_feature(const std::string& text, const std::string& source, F f) {
  const Json json = parse(text, source);
  const auto features = json.is_object() ? json.find("features") : json.end();
  if (features == json.end() || !features->is_array()) {
    throw InputError(fmt::format("{}: must be a GeoJSON FeatureCollection", source));
  }
  check_reference_system(json, source);
  for (std::size_t k = 0; k < features->size(); ++k) {
    f(Feature((*features)[k], fmt::format("{}: feature {}", source, k + 1)));
  }
}

std::vector<PlateOutline> plates_of(const std::string& text, const std::string& source) {
  std::vector<PlateOutline> plates;
  for_each_feature(text, source, [&](const Feature& feature) {
    PlateOutline plate = feature.outline();
    const auto known = std::find_if(plates.begin(), plates.end(), [&](const PlateOutline& other) {
      return other.name == plate.name;
    });
    if (known == plates.end()) {
      plates.push_back(std::move(plate));
    } else {
      known->rings.insert(known->rings.end(), plate.rings.begin(), plate.rings.end());
    }
  });
  if (plates.size() < 2 || plates.size() > kMostPlates) {
    throw InputError(fmt::format("{}: has {} plate{}: must have 2 to {}", source, plates.size(),
                                 plates.size() == 1 ? "" : "s", kMostPlates));
  }
  return plates;
}

std::string text_of(const std::string& file, std::string_view what) {
  if (std::filesystem::exists(file)) return read_text(file);
  throw InputError(fmt::format("fields.plates: {}: no such file; must be {}", file, what));
}

}  // namespace

bool DatedOutline::is_valid_at(double time_ma) const {
  constexpr double kSameTime_myr = 1e-6;
  return from_ma >= time_ma - kSameTime_myr && to_ma <= time_ma + kSameTime_myr;
}

std::vector<DatedOutline> read_dated_outlines(const std::string& file) {
  std::vector<DatedOutline> outlines;
  for_each_feature(text_of(file, "a GeoJSON file of polygons"), file,
                   [&](Feature feature) { outlines.push_back(feature.dated()); });
  return outlines;
}

std::vector<PlateOutline> read_plate_outlines(const std::string& name_or_file) {
  if (name_or_file == "earth") {
    return plates_of(std::string(embedded_file("plates/earth.geojson")), "earth");
  }
  return plates_of(text_of(name_or_file, "earth or a GeoJSON file of plates"), name_or_file);
}

}  // namespace geo::io
