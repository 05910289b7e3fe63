#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/parameter.hpp"

namespace geo {

// Discrete events on a planet, besides the slow work of its stages: tables [[event]] of a
// configuration, each with its `kind`. Members are keys of the table; their declarations carry unit
// and range.

/// A meteorite or comet strikes: crater and ejecta, and dust that dims the sun.
struct Impact {
  static constexpr std::string_view kKind = "impact";
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double diameter_km = 1.0;
  double velocity_km_s = 17.0;
  double angle_deg = 45.0;
  double density_kg_m3 = 3000.0;
  double ground_density_kg_m3 = 2700.0;
  double aerosol_share = 0.1;
  double aerosol_lifetime_yr = 2.0;
  double age_yr = 0.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// The crust rifts along a line: a rift valley between uplifted shoulders.
struct Rift {
  static constexpr std::string_view kKind = "rift";
  std::vector<Centre> path;  ///< at least two places, joined by arcs of great circles
  double width_km = 60.0;
  double depth_m = 1000.0;
  double shoulder_m = 600.0;
  double shoulder_km = 50.0;
  double roughness = 0.2;
  double age_yr = 0.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// The sea rises or falls, by height or by what is added to its water. One of the two is not 0.
struct OceanShift {
  static constexpr std::string_view kKind = "ocean-shift";
  double rise_m = 0.0;
  double water_km3 = 0.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// A plate that drifts is given a new motion (plates.model = sphere).
struct PlateMotion {
  static constexpr std::string_view kKind = "plate-motion";
  double time_myr = 0.0;      ///< since the drift began
  double latitude_deg = 0.0;  ///< a place on the plate at that time
  double longitude_deg = 0.0;
  double pole_latitude_deg = 90.0;
  double pole_longitude_deg = 0.0;
  double speed_mm_yr = 50.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// A plate that drifts breaks about a place, or along a line.
struct PlateRift {
  static constexpr std::string_view kKind = "plate-rift";
  double time_myr = 0.0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double bearing_deg = 0.0;
  std::vector<Centre> path{};  ///< where not empty: the line, in place of place and bearing
  std::int64_t fragments = 2;
  double speed_mm_yr = 30.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// The crust within a circle or a region becomes continental or oceanic while plates drift.
struct CrustChange {
  static constexpr std::string_view kKind = "crust-change";
  double time_myr = 0.0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double radius_km = 500.0;
  std::vector<Centre> path{};  ///< where not empty: the region's outline, in place of the circle
  bool continental = true;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// A plume of the mantle begins below a place, or the one nearest to it ends, while plates drift.
struct PlumeChange {
  static constexpr std::string_view kKind = "plume";
  double time_myr = 0.0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  bool active = true;
  double growth_mm_yr = 1.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// Whether an event happens to drifting plates, not to elevation.
template <class What>
inline constexpr bool kIsOfPlates =
    std::is_same_v<What, PlateMotion> || std::is_same_v<What, PlateRift> ||
    std::is_same_v<What, CrustChange> || std::is_same_v<What, PlumeChange>;

struct Event {
  std::string name;  ///< for maps and reports; may be empty
  std::variant<Impact, Rift, OceanShift, PlateMotion, PlateRift, CrustChange, PlumeChange> what;

  [[nodiscard]] bool is_of_plates() const {
    return std::visit([]<class What>(const What&) { return kIsOfPlates<What>; }, what);
  }

  [[nodiscard]] std::string_view kind() const;
  /// The line that it follows or surrounds, of kinds that have one; else null.
  [[nodiscard]] std::vector<Centre>* path();
  /// Declarations of the keys of its kind, bound to this event.
  [[nodiscard]] std::vector<Parameter> declarations();
};

/// What an event did, as a stage tells it: "crater_diameter_km" and the like.
struct EventRecord {
  int number = 0;  ///< place in the configuration, from 1
  std::string kind, name;
  std::vector<std::pair<std::string, double>> figures{};
  std::vector<Centre> path{};  ///< of a rift
};

/// The figure of that name, or `otherwise`.
[[nodiscard]] double figure_of(const EventRecord& record, std::string_view name, double otherwise);

}  // namespace geo
