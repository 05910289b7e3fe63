#include "config_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "config_nodes.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/kernels/plates/region_outline.hpp"

namespace geo::io {
namespace {

constexpr std::array<std::string_view, 7> kKinds{
    Impact::kKind,    Rift::kKind,        OceanShift::kKind, PlateMotion::kKind,
    PlateRift::kKind, CrustChange::kKind, PlumeChange::kKind};
constexpr std::string_view kPathKey = "path_deg";

Event event_of_kind(std::string_view kind) {
  Event event;
  if (kind == Rift::kKind) event.what = Rift{};
  if (kind == OceanShift::kKind) event.what = OceanShift{};
  if (kind == PlateMotion::kKind) event.what = PlateMotion{};
  if (kind == PlateRift::kKind) event.what = PlateRift{};
  if (kind == CrustChange::kKind) event.what = CrustChange{};
  if (kind == PlumeChange::kKind) event.what = PlumeChange{};
  return event;
}

std::string place_in(const std::string& source_name, const toml::node& node) {
  return fmt::format("{}:{}: ", source_name, node.source().begin.line);
}

Event begin_event(const toml::table& table, const std::string& where) {
  const auto* kind = table["kind"].as_string();
  if (kind == nullptr) {
    throw ConfigurationError(
        fmt::format("{}event needs a kind: one of {}", where, fmt::join(kKinds, ", ")));
  }
  if (std::find(kKinds.begin(), kKinds.end(), kind->get()) == kKinds.end()) {
    throw ConfigurationError(fmt::format("{}event.kind = \"{}\": must be one of {}{}", where,
                                         kind->get(), fmt::join(kKinds, ", "),
                                         suggestion(kind->get(), kKinds)));
  }
  return event_of_kind(kind->get());
}

Centre place_of(const toml::node& node, const std::string& where) {
  const auto* pair = node.as_array();
  std::array<double, 2> degrees{};
  const bool two = pair != nullptr && pair->size() == 2;
  for (std::size_t i = 0; two && i < 2; ++i) {
    const auto number = pair->get(i)->value<double>();
    if (!number) break;
    degrees[i] = *number;
    if (i == 1) {
      const auto [latitude, longitude] = degrees;
      if (std::abs(latitude) <= 90.0 && longitude >= -180.0 && longitude <= 360.0) {
        return {latitude, longitude};
      }
      throw ConfigurationError(fmt::format(
          "{}event.path_deg: {:g}, {:g} is no latitude in [-90, 90] and longitude in [-180, 360]",
          where, latitude, longitude));
    }
  }
  throw ConfigurationError(
      where + "event.path_deg: must be places [latitude, longitude], such as [[10, 35], [-5, 30]]");
}

std::vector<Centre> path_of(const toml::node& node, const std::string& where) {
  const auto* places = node.as_array();
  std::vector<Centre> path;
  if (places != nullptr) {
    for (const toml::node& place : *places) path.push_back(place_of(place, where));
  }
  if (path.size() < 2) {
    throw ConfigurationError(where +
                             "event.path_deg: must be at least two places [latitude, "
                             "longitude], such as [[10, 35], [-5, 30]]");
  }
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double apart_deg =
        std::remainder(path[i].longitude_deg - path[i - 1].longitude_deg, 360.0);
    const double north_deg = path[i].latitude_deg - path[i - 1].latitude_deg;
    const bool polar = std::abs(path[i].latitude_deg) == 90.0;
    const bool same = north_deg == 0.0 && (apart_deg == 0.0 || polar);
    const bool opposite = path[i].latitude_deg == -path[i - 1].latitude_deg &&
                          (std::abs(apart_deg) == 180.0 || polar);
    if (same || opposite) {
      throw ConfigurationError(
          fmt::format("{}event.path_deg: places {} and {} are {}: no great circle joins them",
                      where, i, i + 1, same ? "the same" : "antipodes"));
    }
  }
  return path;
}

void check_region(const std::vector<Centre>& path, const std::string& where) {
  if (path.size() < 3) {
    throw ConfigurationError(
        fmt::format("{}event.path_deg: the outline of a region needs three places or more", where));
  }
  if (const auto crossing = first_crossing(path)) {
    throw ConfigurationError(
        fmt::format("{}event.path_deg: the outline crosses itself behind its places {} and {}",
                    where, crossing->first + 1, crossing->second + 1));
  }
}

/// What a kind cannot do without.
void check_whole(const Event& event, const toml::table& table, const std::string& where) {
  const auto needs = [&](std::string_view key) {
    if (table.contains(key)) return;
    throw ConfigurationError(fmt::format("{}event of kind {} needs {}", where, event.kind(), key));
  };
  if (std::holds_alternative<Impact>(event.what)) {
    for (const auto* key : {"latitude_deg", "longitude_deg", "diameter_km"}) needs(key);
  } else if (std::holds_alternative<Rift>(event.what)) {
    needs(kPathKey);
  } else if (event.is_of_plates()) {
    needs("time_myr");
    if (!table.contains(kPathKey)) {
      for (const auto* key : {"latitude_deg", "longitude_deg"}) needs(key);
    }
    const auto* region = std::get_if<CrustChange>(&event.what);
    if (region != nullptr && !region->path.empty()) check_region(region->path, where);
  } else {
    const auto& shift = std::get<OceanShift>(event.what);
    if ((shift.rise_m != 0.0) == (shift.water_km3 != 0.0)) {
      throw ConfigurationError(fmt::format(
          "{}event of kind {} needs either rise_m or water_km3, not 0", where, event.kind()));
    }
  }
}

Event event_of(const toml::table& table, const std::string& source_name) {
  const std::string where = place_in(source_name, table);
  Event event = begin_event(table, where);
  const auto declarations = event.declarations();
  visit_in_text_order(table, [&](const toml::key& key, const toml::node& node) {
    const std::string here = fmt::format("{}:{}: ", source_name, key.source().begin.line);
    if (key.str() == "kind") return;
    if (key.str() == "name") {
      const auto* name = node.as_string();
      if (name == nullptr) throw ConfigurationError(here + "event.name: must be a string");
      event.name = name->get();
    } else if (auto* path = event.path(); path != nullptr && key.str() == kPathKey) {
      *path = path_of(node, here);
    } else {
      apply_node(node, fmt::format("{}.{}", kEventKey, key.str()), here, declarations);
    }
  });
  check_whole(event, table, where);
  return event;
}

}  // namespace

std::vector<Event> events_from_toml(const toml::node& node, const std::string& source_name) {
  const auto* tables = node.as_array();
  if (tables == nullptr || !tables->is_homogeneous<toml::table>()) {
    throw ConfigurationError(place_in(source_name, node) +
                             "events are tables [[event]], in two pairs of brackets");
  }
  std::vector<Event> events;
  for (const toml::node& table : *tables) {
    events.push_back(event_of(*table.as_table(), source_name));
  }
  return events;
}

std::string write_events(std::span<const Event> events) {
  std::string text;
  for (Event event : events) {
    text += fmt::format("\n[[{}]]\nkind = \"{}\"\nname = {}\n", kEventKey, event.kind(),
                        to_toml(ParameterValue(event.name)));
    if (const auto* path = event.path(); path != nullptr && !path->empty()) {
      text += fmt::format("# the line, [latitude, longitude] in degrees\n{} = [", kPathKey);
      for (const Centre& place : *path) {
        text += fmt::format("{}[{}, {}]", &place == path->data() ? "" : ", ",
                            to_toml(ParameterValue(place.latitude_deg)),
                            to_toml(ParameterValue(place.longitude_deg)));
      }
      text += "]\n";
    }
    for (const Parameter& parameter : event.declarations()) text += commented_line(parameter);
  }
  return text;
}

}  // namespace geo::io
