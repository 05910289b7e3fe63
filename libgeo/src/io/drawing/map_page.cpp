#include "map_page.hpp"

#include <fmt/format.h>
#include <proj.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geo/core/error.hpp"
#include "map_canvas.hpp"

namespace geo::io {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kEdgeStepDeg = 0.5;
constexpr double kTiny = 1e-9;

// How far an azimuthal map reaches from its centre.
constexpr double kHemisphereDeg = 90.0, kPolarCapDeg = 45.0, kMercatorDeg = 80.0;

double shape_of(const Grid& grid) {
  if (!grid.is_latitude_longitude()) {
    return grid.ny() * grid.spacing_north_m(0) / (grid.nx() * grid.spacing_east_m(0));
  }
  const Window& window = grid.window();
  const double degrees =
      (window.north_deg - window.south_deg) / (window.east_deg - window.west_deg);
  if (grid.topology() == Topology::sphere) return degrees;
  const double middle = 0.5 * (window.south_deg + window.north_deg) * kRadians;
  return degrees / std::max(std::cos(middle), 0.05);
}

double angle_between_deg(double east_deg, double latitude_deg, double centre_latitude_deg) {
  const double a = latitude_deg * kRadians, b = centre_latitude_deg * kRadians;
  const double half_east = std::sin(0.5 * east_deg * kRadians);
  const double half_north = std::sin(0.5 * (a - b));
  const double h = half_north * half_north + std::cos(a) * std::cos(b) * half_east * half_east;
  return 2.0 * std::asin(std::sqrt(std::clamp(h, 0.0, 1.0))) / kRadians;
}

}  // namespace

struct MapPage::Projector::Engine {
  explicit Engine(const std::string& definition) : context(proj_context_create()) {
    proj_log_level(context, PJ_LOG_NONE);
    projection = proj_create(context, definition.c_str());
    if (projection == nullptr) throw Bug("PROJ refuses " + definition);
  }
  ~Engine() {
    proj_destroy(projection);
    proj_context_destroy(context);
  }
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  PJ_CONTEXT* context;
  PJ* projection = nullptr;
};

MapPage::Projector::~Projector() = default;
MapPage::Projector::Projector(Projector&&) noexcept = default;

MapPage::Projector::Projector(const MapPage& page) : page_(&page) {
  if (!page.is_aligned()) {
    engine_ = std::make_unique<Engine>(page.definition_);
  } else if (!page.grid().is_latitude_longitude() && page.grid().centre()) {
    plane_ = std::make_unique<EqualAreaProjection>(*page.grid().centre(), page.grid().figure());
  }
}

std::optional<PagePoint> MapPage::Projector::forward(double east_deg, double latitude_deg) const {
  if (page_->is_azimuthal() &&
      angle_between_deg(east_deg, latitude_deg, page_->centre_.latitude_deg) >
          page_->reach_deg_ + kTiny) {
    return {};
  }
  const PJ_COORD to = proj_trans(engine_->projection, PJ_FWD,
                                 proj_coord(east_deg * kRadians, latitude_deg * kRadians, 0, 0));
  if (!std::isfinite(to.xy.x) || !std::isfinite(to.xy.y)) return {};
  return PagePoint{(to.xy.x - page_->left_) * page_->px_per_unit_,
                   (page_->top_ - to.xy.y) * page_->px_per_unit_};
}

std::optional<PagePoint> MapPage::Projector::point_east_of_centre(double east_deg,
                                                                  double latitude_deg) const {
  if (!page_->holds(east_deg, latitude_deg)) return {};
  if (!page_->is_aligned()) return forward(east_deg, latitude_deg);
  const Window& region = page_->region_;
  const MapLayout& layout = page_->layout_;
  return PagePoint{
      (east_deg - region.west_deg) / (region.east_deg - region.west_deg) * layout.map_width,
      (region.north_deg - latitude_deg) / (region.north_deg - region.south_deg) *
          layout.map_height};
}

std::optional<PagePoint> MapPage::Projector::point_of(Centre place) const {
  const Grid& grid = page_->grid();
  if (plane_) {
    const auto [x_m, y_m] = plane_->project(place);
    if (!std::isfinite(x_m)) return {};
    return PagePoint{(x_m / (grid.nx() * grid.spacing_east_m(0)) + 0.5) * page_->layout_.map_width,
                     (0.5 - y_m / (grid.ny() * grid.step_north_m())) * page_->layout_.map_height};
  }
  if (page_->form_ == Form::plane) return {};
  return point_east_of_centre(
      std::remainder(place.longitude_deg - page_->centre_.longitude_deg, 360.0),
      place.latitude_deg);
}

std::optional<Centre> MapPage::Projector::place_of(PagePoint point) const {
  const double x = point.x / page_->px_per_unit_ + page_->left_;
  const double y = page_->top_ - point.y / page_->px_per_unit_;
  const PJ_COORD to = proj_trans(engine_->projection, PJ_INV, proj_coord(x, y, 0, 0));
  const double east = to.lp.lam / kRadians, latitude = to.lp.phi / kRadians;
  if (!std::isfinite(east) || !std::isfinite(latitude)) return {};
  if (std::abs(latitude) > 90.0 + kTiny || std::abs(east) > 180.0 + kTiny) return {};
  if (!page_->holds(east, latitude)) return {};
  // Beyond the edge an inverse may find some other place's longitude.
  const auto back = forward(east, latitude);
  if (!back || std::hypot(back->x - point.x, back->y - point.y) > 0.25) return {};
  return Centre{latitude, page_->centre_.longitude_deg + east};
}

PageLines MapPage::Projector::line_through(const std::vector<Centre>& places) const {
  PageLines lines;
  bool pen_down = false;
  double east_before = 0.0;
  for (const Centre& place : places) {
    const double east = std::remainder(place.longitude_deg - page_->centre_.longitude_deg, 360.0);
    const auto point = point_of(place);
    const bool cut = !page_->is_azimuthal() && std::abs(east - east_before) > 180.0;
    if (point && (!pen_down || cut)) lines.emplace_back();
    if (point) lines.back().push_back(*point);
    pen_down = point.has_value();
    east_before = east;
  }
  return lines;
}

bool MapPage::is_polar() const { return is_azimuthal() && std::abs(centre_.latitude_deg) > 89.9; }

bool MapPage::holds(double east_deg, double latitude_deg) const {
  if (latitude_deg < region_.south_deg - kTiny || latitude_deg > region_.north_deg + kTiny) {
    return false;
  }
  if (!is_azimuthal()) {
    return east_deg >= region_.west_deg - kTiny && east_deg <= region_.east_deg + kTiny;
  }
  const double middle = 0.5 * (region_.west_deg + region_.east_deg);
  return std::abs(std::remainder(east_deg - middle, 360.0)) <=
         0.5 * (region_.east_deg - region_.west_deg) + kTiny;
}

MapPage::MapPage(const Grid& grid, const MapView& view) : grid_(&grid) {
  if (view.width_px < 300 || view.width_px > 20000) {
    throw ConfigurationError(
        fmt::format("map width {} px: must be between 300 and 20000", view.width_px));
  }
  if (!view.is_default() && !grid.is_latitude_longitude()) {
    find_projection(view.projection);
    throw ConfigurationError(
        "a grid that does not follow latitude and longitude is drawn as it lies, whole: without "
        "projection, centre and box");
  }
  if (grid.is_latitude_longitude()) {
    form_ = Form::cylindrical;
    region_ = grid.window();
  }
  if (view.is_default()) {
    set_layout(view.width_px, shape_of(grid));
    return;
  }
  const MapProjection& projection = find_projection(view.projection);
  const std::string_view name = projection.name;
  if (name == "orthographic" || name == "stereographic" || name == "equal-area" ||
      name.starts_with("polar")) {
    form_ = Form::azimuthal;
  } else if (name != "equirectangular" && name != "mercator") {
    form_ = Form::pseudocylindrical;
  }
  if (is_azimuthal()) reach_deg_ = name.starts_with("polar") ? kPolarCapDeg : kHemisphereDeg;
  set_region(view);
  definition_ = fmt::format("{} +R=1 +over", projection.definition);
  if (is_azimuthal()) definition_ += fmt::format(" +lat_0={}", centre_.latitude_deg);
  const bool whole = region_.east_deg - region_.west_deg > 360.0 - 1e-6;
  if (name == "equirectangular" && !whole) {
    definition_ += fmt::format(
        " +lat_ts={}", std::clamp(0.5 * (region_.south_deg + region_.north_deg), -87.0, 87.0));
  }
  trace_edge();
  double west = std::numeric_limits<double>::infinity(), north = west;
  double east = -west, south = -west;
  for (const auto& line : edge_) {
    for (const PagePoint& point : line) {
      west = std::min(west, point.x);
      east = std::max(east, point.x);
      north = std::min(north, point.y);
      south = std::max(south, point.y);
    }
  }
  if (!(east > west && south > north)) {
    throw ConfigurationError(
        fmt::format("map projection {}: shows nothing of what was asked for", name));
  }
  set_layout(view.width_px, (south - north) / (east - west));
  left_ = west;
  top_ = -north;
  px_per_unit_ = layout_.map_width / (east - west);
  trace_edge();
}

void MapPage::set_region(const MapView& view) {
  if (view.box) crop(*view.box);
  if (view.projection == "mercator") {
    region_.south_deg = std::max(region_.south_deg, -kMercatorDeg);
    region_.north_deg = std::min(region_.north_deg, kMercatorDeg);
    if (region_.south_deg >= region_.north_deg) {
      throw ConfigurationError("map projection mercator: shows latitudes within 80° alone");
    }
  }
  const bool whole = grid_->topology() == Topology::sphere && !view.box;
  set_centre(view, whole);
  if (whole) {
    region_.west_deg = -180.0;
    region_.east_deg = 180.0;
  } else {
    turn_to_centre();
  }
}

void MapPage::crop(const Window& box) {
  region_.south_deg = std::max(region_.south_deg, box.south_deg);
  region_.north_deg = std::min(region_.north_deg, box.north_deg);
  if (grid_->topology() == Topology::sphere) {
    region_.west_deg = box.west_deg;
    region_.east_deg = box.east_deg;
  } else {
    // The same longitudes as the grid counts them.
    const double turn = 360.0 * std::round((0.5 * (region_.west_deg + region_.east_deg) -
                                            0.5 * (box.west_deg + box.east_deg)) /
                                           360.0);
    region_.west_deg = std::max(region_.west_deg, box.west_deg + turn);
    region_.east_deg = std::min(region_.east_deg, box.east_deg + turn);
  }
  if (!(region_.west_deg < region_.east_deg && region_.south_deg < region_.north_deg)) {
    throw ConfigurationError("the box of the map lies beyond what the grid covers");
  }
}

void MapPage::set_centre(const MapView& view, bool whole) {
  centre_ = view.centre.value_or(whole ? Centre{}
                                       : Centre{0.5 * (region_.south_deg + region_.north_deg),
                                                0.5 * (region_.west_deg + region_.east_deg)});
  if (view.projection.starts_with("polar")) {
    centre_ = {view.projection == "polar-north" ? 90.0 : -90.0,
               view.centre ? view.centre->longitude_deg : 0.0};
    if (view.box) reach_deg_ = 120.0;
  }
  if (is_azimuthal()) return;
  if (view.centre && view.centre->latitude_deg != 0.0) {
    throw ConfigurationError(fmt::format(
        "map projection {}: its middle lies on the equator: the latitude of the centre must be 0",
        view.projection));
  }
  centre_.latitude_deg = 0.0;
}

/// Longitudes are counted from the centre.
void MapPage::turn_to_centre() {
  const double width = region_.east_deg - region_.west_deg;
  const double middle =
      std::remainder(0.5 * (region_.west_deg + region_.east_deg) - centre_.longitude_deg, 360.0);
  region_.west_deg = middle - 0.5 * width;
  region_.east_deg = middle + 0.5 * width;
  if (!is_azimuthal() && (region_.west_deg < -180.0 - kTiny || region_.east_deg > 180.0 + kTiny)) {
    throw ConfigurationError(
        "the edge of the map, opposite of its centre, would cut the box: give another centre");
  }
}

void MapPage::trace_edge() {
  edge_.clear();
  const Projector projector(*this);
  const auto& [south, north, west, east] = region_;
  const bool round = east - west > 360.0 - 1e-6;
  bool pen_down = false;
  const auto go = [&](std::optional<PagePoint> point) {
    if (point && !pen_down) edge_.emplace_back();
    if (point) edge_.back().push_back(*point);
    pen_down = point.has_value();
  };
  const auto along = [](double from, double to, const auto& visit) {
    const int steps = std::max(8, static_cast<int>(std::ceil(std::abs(to - from) / kEdgeStepDeg)));
    for (int i = 0; i <= steps; ++i) visit(i == steps ? to : from + (to - from) * i / steps);
  };
  const auto parallel = [&](double latitude, double from, double to) {
    along(from, to, [&](double lon) { go(projector.point_east_of_centre(lon, latitude)); });
  };
  const auto meridian = [&](double longitude, double from, double to) {
    along(from, to, [&](double lat) { go(projector.point_east_of_centre(longitude, lat)); });
  };
  if (!is_azimuthal() || !round) {
    parallel(south, west, east);
    meridian(east, south, north);
    parallel(north, east, west);
    meridian(west, north, south);
  } else {
    if (south > -90.0) parallel(south, west, east);
    pen_down = false;
    if (north < 90.0) parallel(north, west, east);
  }
  if (!is_azimuthal()) return;
  // The limb, as far as it lies in the region.
  pen_down = false;
  const double sine = std::sin(centre_.latitude_deg * kRadians);
  const double cosine = std::cos(centre_.latitude_deg * kRadians);
  const double reach = (reach_deg_ - 1e-7) * kRadians;
  along(0.0, 360.0, [&](double bearing_deg) {
    const double bearing = bearing_deg * kRadians;
    const double latitude = std::asin(std::clamp(
        sine * std::cos(reach) + cosine * std::sin(reach) * std::cos(bearing), -1.0, 1.0));
    const double longitude = is_polar() ? bearing
                                        : std::atan2(std::sin(bearing) * std::sin(reach) * cosine,
                                                     std::cos(reach) - sine * std::sin(latitude));
    go(projector.point_east_of_centre(longitude / kRadians, latitude / kRadians));
  });
}

void MapPage::set_layout(int width_px, double height_over_width) {
  MapLayout& layout = layout_;
  layout.map_width = height_over_width > 1.0
                         ? static_cast<int>(std::lround(width_px / height_over_width))
                         : width_px;
  layout.map_width = std::max(layout.map_width, 100);
  layout.map_height =
      std::max(static_cast<int>(std::lround(layout.map_width * height_over_width)), 100);
  const double unit = map_unit(layout.map_width);
  const auto scaled = [&](double pixels) { return static_cast<int>(std::lround(pixels * unit)); };
  layout.map_left = scaled(84);
  layout.map_top = scaled(84);
  // Round polar maps longitudes stand on both sides.
  layout.width_px = layout.map_left + layout.map_width + scaled(is_polar() ? 84 : 50);
  layout.height_px = layout.map_top + layout.map_height + scaled(126);
}

}  // namespace geo::io
