#include "sphere_timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/kernels/plates/great_circle_line.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "geo/kernels/plates/region_outline.hpp"
#include "sphere_initial_conditions.hpp"

namespace geo {
namespace {

std::vector<Vector3> places_on(const Grid& grid, const std::vector<Centre>& path) {
  std::vector<Vector3> places;
  places.reserve(path.size());
  for (const Centre& place : path) places.push_back(place_on(grid, place));
  return places;
}

using Figures = std::vector<std::pair<std::string, double>>;

/// One event that is due.
class Stroke {
 public:
  Stroke(const Grid& grid, SphereTectonics& plates, SphereTectonics& crust)
      : grid_(grid), model_(plates), crust_(crust) {}

  /// False when no plate is at the place.
  bool operator()(const PlateMotion& motion, Figures& figures) const {
    const int plate = plate_at(model_, place_of(motion.latitude_deg, motion.longitude_deg));
    if (plate < 0) return false;
    set_motion(model_, plate, place_of(motion.pole_latitude_deg, motion.pole_longitude_deg),
               motion.speed_mm_yr / model_.settings.radius_km);
    figures.emplace_back("plate", id_of(plate));
    return true;
  }
  bool operator()(const PlateRift& rift, Figures& figures) const {
    if (!rift.path.empty()) return rift_along(rift, figures);
    const Vector3 at = place_of(rift.latitude_deg, rift.longitude_deg);
    const int plate = plate_at(model_, at);
    if (plate < 0) return false;
    // Fragments lie round the place, the first one to the right of the fracture.
    constexpr double kAway = 0.15;  // radians
    const auto [east, north] = axes_at(at);
    std::vector<Vector3> places;
    for (std::int64_t k = 0; k < rift.fragments; ++k) {
      const double turn =
          2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(rift.fragments);
      const double azimuth =
          rift.bearing_deg * std::numbers::pi / 180.0 + 0.5 * std::numbers::pi + turn;
      const Vector3 away = add(scaled(north, std::cos(azimuth)), east, std::sin(azimuth));
      places.push_back(normalised(add(scaled(at, std::cos(kAway)), away, std::sin(kAway))));
    }
    figures.emplace_back("plate", id_of(plate));
    rift_plate(model_, plate, places, rift.speed_mm_yr);
    return true;
  }
  bool operator()(const CrustChange& change, Figures& figures) const {
    if (&model_ != &crust_) change_crust_of(model_, change);
    figures.emplace_back("area_km2", change_crust_of(crust_, change));
    return true;
  }
  /// False when there is no plume to end.
  bool operator()(const PlumeChange& change, Figures& figures) const {
    if (&model_ != &crust_) change_plumes(model_.state.plumes, change);
    if (!change_plumes(crust_.state.plumes, change)) return false;
    figures.emplace_back("plumes", static_cast<double>(crust_.state.plumes.size()));
    return true;
  }
  bool operator()(const auto&, Figures&) const { return false; }

 private:
  /// The plate below the middle of the line breaks.
  [[nodiscard]] bool rift_along(const PlateRift& rift, Figures& figures) const {
    const GreatCircleLine line(places_on(grid_, rift.path));
    const int plate = plate_at(model_, line.middle());
    if (plate < 0) return false;
    figures.emplace_back("plate", id_of(plate));
    rift_plate_along(model_, plate, line, static_cast<int>(rift.fragments), rift.speed_mm_yr);
    return true;
  }
  /// False when there is none to end.
  bool change_plumes(std::vector<SpherePlume>& plumes, const PlumeChange& change) const {
    const Vector3 at = place_of(change.latitude_deg, change.longitude_deg);
    if (change.active) {
      std::int64_t number = 0;
      for (const SpherePlume& plume : plumes) number = std::max(number, plume.number + 1);
      plumes.push_back({.place = at, .growth_mm_yr = change.growth_mm_yr, .number = number});
      return true;
    }
    const auto nearest = std::max_element(plumes.begin(), plumes.end(),
                                          [&](const SpherePlume& a, const SpherePlume& b) {
                                            return dot(a.place, at) < dot(b.place, at);
                                          });
    if (nearest == plumes.end()) return false;
    plumes.erase(nearest);
    return true;
  }
  /// The area that has changed, km2.
  double change_crust_of(SphereTectonics& model, const CrustChange& change) const {
    const double warp_km = model.settings.coast_warp_km;
    if (change.path.empty()) {
      // A small circle keeps its shape and its area as well as a large one.
      constexpr double kMost = 0.2;
      const Vector3 middle = place_of(change.latitude_deg, change.longitude_deg);
      const double lowest =
          std::cos(std::min(change.radius_km / model.settings.radius_km, std::numbers::pi));
      return change_crust(
          model, [&](const Vector3& place) { return dot(place, middle) >= lowest; },
          change.continental, std::min(warp_km, kMost * change.radius_km));
    }
    const RegionOutline region(std::span(&change.path, 1));
    return change_crust(
        model, [&](const Vector3& place) { return region.holds(position_of(grid_, place)); },
        change.continental, warp_km);
  }
  /// The number by which files know a plate.
  [[nodiscard]] double id_of(int plate) const { return model_.state.plates[plate].id; }
  [[nodiscard]] Vector3 place_of(double latitude_deg, double longitude_deg) const {
    return place_on(grid_, {latitude_deg, longitude_deg});
  }
  /// East and north at a place, in the frame of plates.
  [[nodiscard]] std::pair<Vector3, Vector3> axes_at(const Vector3& at) const {
    const Vector3 pole = place_of(90.0, 0.0);
    Vector3 east = cross(pole, at);
    if (length(east) < 1e-12) east = place_of(0.0, 90.0);
    east = normalised(east);
    return {east, cross(at, east)};
  }

  const Grid& grid_;
  SphereTectonics& model_;  // whose plates are asked and moved
  SphereTectonics& crust_;
};

/// Where a line or a region is told to be: the middle of the line, the mean of the outline.
Centre middle_of(const Grid& grid, const PlateRift& rift) {
  return position_of(grid, GreatCircleLine(places_on(grid, rift.path)).middle());
}
Centre middle_of(const Grid& grid, const CrustChange& change) {
  Vector3 sum{};
  for (const Vector3& place : places_on(grid, change.path)) sum = add(sum, place);
  return position_of(grid, normalised(sum));
}

Centre place_of(const Grid& grid, const Event& event) {
  return std::visit(
      [&]<class What>(const What& what) -> Centre {
        if constexpr (kIsOfPlates<What>) {
          if constexpr (requires { what.path; }) {
            if (!what.path.empty()) return middle_of(grid, what);
          }
          return {what.latitude_deg, what.longitude_deg};
        } else {
          return {};
        }
      },
      event.what);
}

double time_of(const Event& event) {
  return std::visit(
      []<class What>(const What& what) {
        if constexpr (kIsOfPlates<What>) return what.time_myr;
        return -1.0;
      },
      event.what);
}

}  // namespace

void strike_plates(const Grid& grid, double from_myr, double to_myr, SphereTectonics& plates,
                   SphereTectonics& crust, Context& context) {
  const Stroke stroke(grid, plates, crust);
  for (std::size_t i = 0; i < context.events.size(); ++i) {
    const Event& event = context.events[i];
    const double time_myr = time_of(event);
    if (time_myr < from_myr || time_myr >= to_myr) continue;
    const Centre place = place_of(grid, event);
    EventRecord record{.number = static_cast<int>(i) + 1,
                       .kind = std::string(event.kind()),
                       .name = event.name,
                       .figures = {{"time_myr", time_myr},
                                   {"latitude_deg", place.latitude_deg},
                                   {"longitude_deg", place.longitude_deg}}};
    const bool struck =
        std::visit([&](const auto& what) { return stroke(what, record.figures); }, event.what);
    if (!struck) {
      const bool is_plume = std::holds_alternative<PlumeChange>(event.what);
      context.warnings.push_back(
          fmt::format("event {} ({}): no {} is at {:g}, {:g} after {:g} Myr{}", i + 1, event.kind(),
                      is_plume ? "plume" : "plate", place.latitude_deg, place.longitude_deg,
                      time_myr, is_plume ? "" : ", only a gap that opens"));
      continue;
    }
    context.event_records.push_back(std::move(record));
  }
}

void warn_of_later_events(double end_myr, Context& context) {
  for (std::size_t i = 0; i < context.events.size(); ++i) {
    const Event& event = context.events[i];
    if (!event.is_of_plates() || time_of(event) < end_myr) continue;
    context.warnings.push_back(
        fmt::format("event {} ({}): its time is {:g} Myr, the drift ends after {:g} Myr", i + 1,
                    event.kind(), time_of(event), end_myr));
  }
}

}  // namespace geo
