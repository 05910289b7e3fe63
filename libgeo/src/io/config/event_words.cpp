#include "event_words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

namespace geo::io {
namespace {

/// All that the stages of a run tell of each event, by its number.
std::map<int, EventRecord> gathered(const Manifest& manifest) {
  std::map<int, EventRecord> events;
  for (const StageRecord& stage : manifest.stages) {
    for (const EventRecord& record : stage.events) {
      const auto [entry, is_new] = events.try_emplace(record.number, record);
      if (is_new) continue;
      auto& known = entry->second;
      known.figures.insert(known.figures.end(), record.figures.begin(), record.figures.end());
      if (known.path.empty()) known.path = record.path;
    }
  }
  return events;
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double get(const EventRecord& event, std::string_view name) {
  return figure_of(event, name, kUnknown);
}
bool has(const EventRecord& event, std::string_view name) { return !std::isnan(get(event, name)); }

std::string degrees(double value, char positive, char negative) {
  return fmt::format("{:.4g}° {}", std::abs(value), value < 0.0 ? negative : positive);
}

std::string when(const EventRecord& event) {
  const double age_yr = figure_of(event, "age_yr", 0.0);
  if (age_yr <= 0.0) return {};
  return age_yr < 1e5 ? fmt::format(", {:.4g} years ago", age_yr)
                      : fmt::format(", {:.4g} million years ago", 1e-6 * age_yr);
}

std::string words_of(const EventRecord& event) {
  const std::string name = event.name.empty() ? "" : " " + event.name;
  if (event.kind == Rift::kKind) {
    return fmt::format(
        "Rift{}{}: {:.0f} km long and {:.4g} km wide, floor {:.0f} m down, "
        "shoulders {:.0f} m up.",
        name, when(event), get(event, "length_km"), get(event, "width_km"), get(event, "depth_m"),
        get(event, "shoulder_m"));
  }
  if (event.kind == OceanShift::kKind) {
    const double rise_m = get(event, "rise_m");
    return fmt::format("Shift of the ocean{}: the sea {} by {:.4g} m, its water by {:.4g} km³.",
                       name, rise_m < 0.0 ? "falls" : "rises", std::abs(rise_m),
                       std::abs(get(event, "water_km3")));
  }
  if (has(event, "time_myr")) {
    const char* what =
        event.kind == PlateMotion::kKind          ? "A plate takes a new course"
        : event.kind == "continental-collision"   ? "Continents collide"
        : event.kind == "subduction-initiation"   ? "Subduction begins at an old margin"
        : event.kind == "back-arc-opening"        ? "A back-arc basin opens"
        : event.kind == "continental-indentation" ? "A block breaks off an indented continent"
        : event.kind == "ridge-jump"              ? "A ridge jumps to a plume"
        : event.kind == CrustChange::kKind        ? "Crust changes its type"
        : event.kind == PlumeChange::kKind        ? "A plume begins or ends"
                                                  : "A plate breaks";
    return fmt::format("{}{} after {:.4g} million years, at {} {}.", what, name,
                       get(event, "time_myr"), degrees(get(event, "latitude_deg"), 'N', 'S'),
                       degrees(get(event, "longitude_deg"), 'E', 'W'));
  }
  std::string words = fmt::format("Impact{}", name);
  if (has(event, "latitude_deg")) {
    words += fmt::format(" at {} {}", degrees(get(event, "latitude_deg"), 'N', 'S'),
                         degrees(get(event, "longitude_deg"), 'E', 'W'));
  }
  words += when(event);
  if (has(event, "crater_diameter_km")) {
    words +=
        fmt::format(": {:.3g} J, a crater {:.3g} km wide and {:.0f} m deep", get(event, "energy_j"),
                    get(event, "crater_diameter_km"), get(event, "crater_depth_m"));
  }
  if (get(event, "cooling_k") >= 0.005) {
    words += fmt::format("; dust cools the planet by {:.2f} K and takes ", get(event, "cooling_k"));
    words +=
        has(event, "rain_lost_mm_yr")
            ? fmt::format("{:.3g} mm of rain a year from its land", get(event, "rain_lost_mm_yr"))
            : fmt::format("{:.1f} % of its rain", 100.0 * (1.0 - get(event, "rain_left")));
  }
  return words + ".";
}

}  // namespace

std::vector<std::string> event_lines(const Manifest& manifest) {
  std::vector<std::string> lines;
  for (const auto& [number, event] : gathered(manifest)) lines.push_back(words_of(event));
  return lines;
}

std::vector<EventMark> event_marks(const Manifest& manifest) {
  std::vector<EventMark> marks;
  for (const auto& [number, event] : gathered(manifest)) {
    if (!event.path.empty()) {
      marks.push_back({.path = event.path, .name = event.name});
    } else if (has(event, "crater_diameter_km")) {
      marks.push_back({.place = {get(event, "latitude_deg"), get(event, "longitude_deg")},
                       .radius_km = 0.5 * get(event, "crater_diameter_km"),
                       .name = event.name});
    }
  }
  return marks;
}

}  // namespace geo::io
