#include "surface_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/landscape/impact_crater.hpp"
#include "geo/kernels/landscape/rift_valley.hpp"
#include "geo/kernels/landscape/sea_level.hpp"
#include "geo/kernels/noise/noise.hpp"

namespace geo {
namespace {

constexpr double kCubicKilometre_m3 = 1e9;
constexpr double kRadians = std::numbers::pi / 180.0;

/// Calls `visit(place, weight)` for points spread evenly over the area of a cell, as many to a side
/// that they lie `finest_m` apart; weights add up to 1.
template <class Visit>
void over_cell(const Grid& grid, int i, int j, double finest_m, Visit&& visit) {
  constexpr int kMostToASide = 64;
  const double east_m = grid.spacing_east_m(j), north_m = grid.area_m2(j) / east_m;
  const int side = std::clamp(static_cast<int>(std::ceil(std::max(east_m, north_m) / finest_m)), 1,
                              kMostToASide);
  const Vector3 centre = grid.to_axis(grid.unit_vector(i, j));
  if (side == 1) return visit(centre, 1.0);
  const double weight = 1.0 / (side * side);
  if (grid.is_latitude_longitude()) {
    const Window& window = grid.window();
    const double height_deg = (window.north_deg - window.south_deg) / grid.ny();
    const double width_deg = (window.east_deg - window.west_deg) / grid.nx();
    const double south = std::sin((window.south_deg + j * height_deg) * kRadians);
    const double north = std::sin((window.south_deg + (j + 1) * height_deg) * kRadians);
    for (int b = 0; b < side; ++b) {
      const double sine = south + (b + 0.5) / side * (north - south);
      const double cosine = std::sqrt(1.0 - sine * sine);
      for (int a = 0; a < side; ++a) {
        const double longitude = (window.west_deg + (i + (a + 0.5) / side) * width_deg) * kRadians;
        visit(Vector3{cosine * std::cos(longitude), cosine * std::sin(longitude), sine}, weight);
      }
    }
    return;
  }
  const Vector3 east = normalised(cross({0.0, 0.0, 1.0}, centre)), north = cross(centre, east);
  const double radius_m = grid.figure().radius_m;
  for (int a = 0; a < side; ++a) {
    for (int b = 0; b < side; ++b) {
      const double x = ((a + 0.5) / side - 0.5) * east_m / radius_m;
      const double y = ((b + 0.5) / side - 0.5) * north_m / radius_m;
      visit(normalised(add(add(centre, east, x), north, y)), weight);
    }
  }
}

double longest_side_m(const Grid& grid, int j) {
  return std::max(grid.spacing_east_m(j), grid.area_m2(j) / grid.spacing_east_m(j));
}

double water_m3(const Grid& grid, std::span<const float> elevation_m) {
  double sum = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double depth = 0.0;
    for (const float z : elevation_m.subspan(grid.cell(0, j), grid.nx())) {
      depth += std::max(0.0, -static_cast<double>(z));
    }
    sum += depth * grid.area_m2(j);
  }
  return sum;
}

double age_of(const Event& event) {
  if (const auto* impact = std::get_if<Impact>(&event.what)) return impact->age_yr;
  if (const auto* rift = std::get_if<Rift>(&event.what)) return rift->age_yr;
  return 0.0;
}

/// How a rift strays from the line and the even trough that it is given as: faults overlap along
/// it, so that it bends and its floor rises to sills between basins.
class RiftCourse {
 public:
  RiftCourse(std::uint64_t seed, const Rift& rift, double planet_m)
      : bends_{Noise(seed, "event.rift.x"), Noise(seed, "event.rift.y"),
               Noise(seed, "event.rift.z")},
        sills_(seed, "event.rift.sills"),
        width_(1e3 * rift.width_km / planet_m),
        roughness_(rift.roughness) {}

  /// Where a place lies beside the line as it was given.
  [[nodiscard]] Vector3 straightened(const Vector3& place) const {
    constexpr int kOctaves = 5;
    Vector3 bend{};
    for (int axis = 0; axis < 3; ++axis) {
      const double stray = bends_[axis].fbm(place, 1.0 / (kWavelength * width_), kOctaves, 0.6);
      bend[axis] = std::clamp(kBend * stray, -kMost, kMost) * roughness_ * width_;
    }
    return normalised(add(place, bend));
  }
  /// The farthest that a place is moved, radians.
  [[nodiscard]] double farthest() const { return std::sqrt(3.0) * kMost * roughness_ * width_; }
  /// Factor of floor and shoulders.
  [[nodiscard]] double strength(const Vector3& at) const {
    return std::max(0.0, 1.0 + kSills * roughness_ * sills_.fbm(at, 1.0 / (2.0 * width_), 3));
  }

 private:
  static constexpr double kWavelength = 6.0;          // of the bends, in widths
  static constexpr double kBend = 10.0, kMost = 6.0;  // of the width, at full roughness
  static constexpr double kSills = 6.0;
  std::array<Noise, 3> bends_;
  Noise sills_;
  double width_, roughness_;
};

}  // namespace

std::int64_t SurfaceEvents::step_of(double age_yr) const {
  const double back = std::round(age_yr / time_step_yr_);
  return back >= static_cast<double>(steps_) ? 0 : steps_ - static_cast<std::int64_t>(back);
}

bool SurfaceEvents::strike(std::int64_t step, std::span<float> elevation_m) {
  bool any = false;
  for (std::size_t i = 0; i < context_.events.size(); ++i) {
    const Event& event = context_.events[i];
    if (event.is_of_plates() || step_of(age_of(event)) != step) continue;
    const std::string label = fmt::format("event {} ({}{}{})", i + 1, event.kind(),
                                          event.name.empty() ? "" : ", ", event.name);
    const double before_yr = static_cast<double>(steps_) * time_step_yr_;
    if (steps_ > 0 && age_of(event) > before_yr + 0.5 * time_step_yr_) {
      context_.warnings.push_back(
          fmt::format("{}: its age of {:g} yr is before the {:g} yr of erosion, it comes at their "
                      "beginning",
                      label, age_of(event), before_yr));
    }
    EventRecord record{
        .number = static_cast<int>(i) + 1, .kind = std::string(event.kind()), .name = event.name};
    std::visit(
        [&]<class What>(const What& what) {
          if constexpr (!kIsOfPlates<What>) apply(what, label, record, elevation_m);
        },
        event.what);
    context_.event_records.push_back(std::move(record));
    any = true;
  }
  return any;
}

/// Mean height of the cells whose centres lie within a circle, or of the one that its centre lies
/// in.
double SurfaceEvents::mean_within_m(std::span<const float> elevation_m, const Centre& centre,
                                    double radius_m) const {
  const Vector3 middle = unit_vector_of(centre);
  const double planet_m = grid_.figure().radius_m;
  double sum = 0.0, area = 0.0, nearest = 4.0;
  float at_nearest = 0.0F;
  for (int j = 0; j < grid_.ny(); ++j) {
    for (int i = 0; i < grid_.nx(); ++i) {
      const double angle = angle_between(grid_.to_axis(grid_.unit_vector(i, j)), middle);
      const float height = elevation_m[grid_.cell(i, j)];
      if (angle < nearest) nearest = angle, at_nearest = height;
      if (angle * planet_m > radius_m) continue;
      sum += height * grid_.area_m2(j), area += grid_.area_m2(j);
    }
  }
  return area > 0.0 ? sum / area : at_nearest;
}

void SurfaceEvents::apply(const Impact& impact, const std::string& label, EventRecord& record,
                          std::span<float> elevation_m) {
  constexpr double kThinnest_m = 1e-3;  // of the ejecta that are still laid down
  const Centre place{impact.latitude_deg, impact.longitude_deg};
  ImpactScene scene{.diameter_m = 1e3 * impact.diameter_km,
                    .density_kg_m3 = impact.density_kg_m3,
                    .velocity_m_s = 1e3 * impact.velocity_km_s,
                    .angle_deg = impact.angle_deg,
                    .ground_density_kg_m3 = impact.ground_density_kg_m3,
                    .gravity_m_s2 = context_.planet.gravity_m_s2};
  const double ground_m = mean_within_m(elevation_m, place, 0.5 * crater_of(scene).diameter_m);
  scene.water_depth_m = std::max(0.0, -ground_m);
  const Crater crater = crater_of(scene);
  const double radius_m = 0.5 * crater.diameter_m, planet_m = grid_.figure().radius_m;
  const double reach_m = radius_m * std::cbrt(std::max(1.0, crater.rim_m / kThinnest_m));
  const Vector3 middle = unit_vector_of(place);
#pragma omp parallel for schedule(dynamic, 8)
  for (int j = 0; j < grid_.ny(); ++j) {
    const double cell_m = longest_side_m(grid_, j);
    for (int i = 0; i < grid_.nx(); ++i) {
      const double from_middle_m =
          planet_m * angle_between(grid_.to_axis(grid_.unit_vector(i, j)), middle);
      if (from_middle_m > reach_m + cell_m) continue;
      const bool near = from_middle_m < 1.5 * radius_m + cell_m;
      double change = 0.0, erased = 0.0;
      over_cell(grid_, i, j, near ? 0.1 * radius_m : cell_m, [&](const Vector3& at, double weight) {
        const double distance_m = planet_m * angle_between(at, middle);
        change += weight * crater_profile_m(crater, distance_m);
        erased += weight * crater_erasure(crater, distance_m);
      });
      float& height = elevation_m[grid_.cell(i, j)];
      height = static_cast<float>((1.0 - erased) * height + erased * ground_m + change);
    }
  }
  const double cell_m = std::sqrt(grid_.area_m2(grid_.ny() / 2));
  if (crater.diameter_m < cell_m) {
    context_.warnings.push_back(
        fmt::format("{}: its crater of {:.3g} km is smaller than a cell of {:.3g} km and shows as "
                    "the cell's mean alone",
                    label, 1e-3 * crater.diameter_m, 1e-3 * cell_m));
  }
  record.figures = {{"latitude_deg", impact.latitude_deg},
                    {"longitude_deg", impact.longitude_deg},
                    {"age_yr", impact.age_yr},
                    {"impactor_diameter_km", impact.diameter_km},
                    {"energy_j", crater.energy_j},
                    {"water_depth_m", scene.water_depth_m},
                    {"crater_diameter_km", 1e-3 * crater.diameter_m},
                    {"crater_depth_m", crater.depth_m},
                    {"rim_m", crater.rim_m},
                    {"central_uplift_m", crater.uplift_m}};
}

void SurfaceEvents::apply(const Rift& rift, const std::string& /*label*/, EventRecord& record,
                          std::span<float> elevation_m) {
  const RiftSection section{.half_width_m = 500.0 * rift.width_km,
                            .depth_m = rift.depth_m,
                            .shoulder_m = rift.shoulder_m,
                            .flexure_m = 1e3 * rift.shoulder_km};
  std::vector<Vector3> places;
  for (const Centre& place : rift.path) places.push_back(unit_vector_of(place));
  const GreatCirclePath line(std::move(places));
  const double planet_m = grid_.figure().radius_m;
  constexpr double kFadesAfter = 6.0;  // flexural parameters from the crest
  const RiftCourse course(context_.seed, rift, planet_m);
  const double section_reach = (section.half_width_m + kFadesAfter * section.flexure_m) / planet_m;
  const double reach = section_reach + course.farthest();
  const double fade = std::min(3.0 * section.half_width_m / planet_m, line.length() / 3.0);

  const auto change_at = [&](const Vector3& place) {
    const Vector3 at = course.straightened(place);
    const auto nearest = line.nearest(at, section_reach);
    if (nearest.distance > section_reach) return 0.0;
    const double ends =
        std::clamp(std::min(nearest.along, line.length() - nearest.along) / fade, 0.0, 1.0);
    const double strength = ends * ends * (3.0 - 2.0 * ends) * course.strength(at);
    return strength * rift_profile_m(section, nearest.distance * planet_m);
  };
#pragma omp parallel for schedule(dynamic, 8)
  for (int j = 0; j < grid_.ny(); ++j) {
    const double cell_m = longest_side_m(grid_, j);
    for (int i = 0; i < grid_.nx(); ++i) {
      const auto nearest =
          line.nearest(grid_.to_axis(grid_.unit_vector(i, j)), reach + cell_m / planet_m);
      if (nearest.distance > reach + cell_m / planet_m) continue;
      double change = 0.0;
      over_cell(grid_, i, j, 0.2 * section.half_width_m,
                [&](const Vector3& at, double weight) { change += weight * change_at(at); });
      elevation_m[grid_.cell(i, j)] += static_cast<float>(change);
    }
  }
  record.figures = {{"age_yr", rift.age_yr},
                    {"length_km", 1e-3 * planet_m * line.length()},
                    {"width_km", rift.width_km},
                    {"depth_m", rift.depth_m},
                    {"shoulder_m", rift.shoulder_m}};
  record.path = rift.path;
}

void SurfaceEvents::apply(const OceanShift& shift, const std::string& label, EventRecord& record,
                          std::span<float> elevation_m) {
  const double before_m3 = water_m3(grid_, elevation_m);
  double rise_m = shift.rise_m;
  if (shift.water_km3 != 0.0) {
    const double after_m3 = before_m3 + kCubicKilometre_m3 * shift.water_km3;
    if (!(after_m3 > 0.0)) {
      throw ConfigurationError(
          fmt::format("{}: water_km3 = {:g} takes more than the {:g} km3 that the sea holds", label,
                      shift.water_km3, before_m3 / kCubicKilometre_m3));
    }
    rise_m = sea_level_for_volume(grid_, elevation_m, after_m3);
  }
  for (float& height : elevation_m) height -= static_cast<float>(rise_m);
  const double added_m3 = water_m3(grid_, elevation_m) - before_m3;
  record.figures = {{"rise_m", rise_m}, {"water_km3", added_m3 / kCubicKilometre_m3}};
}

}  // namespace geo
