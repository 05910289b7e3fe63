#include "globe_overlays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "globe_layers.hpp"
#include "io/maps/map_plates.hpp"
#include "io/maps/map_rivers.hpp"

namespace geo::io {
namespace {

double rounded(double value) { return std::round(value * 100.0) / 100.0; }

/// Longitude and latitude of a point of an equirectangular map.
std::array<double, 2> place_of(const MapFrame& frame, double x, double y) {
  return {rounded(x * 360.0 / frame.width() - 180.0), rounded(90.0 - y * 180.0 / frame.height())};
}

}  // namespace

ordered_json rivers_of(const State& state, const MapFrame& frame) {
  if (!has_rivers(state)) return nullptr;
  const RiverNetwork rivers = trace_rivers(frame, state);
  auto lines = ordered_json::array();
  for (const auto& river : rivers.lines) {
    auto line = ordered_json::array();
    for (const RiverPoint& point : river) {
      const auto [longitude, latitude] = place_of(frame, point.x, point.y);
      line.push_back({longitude, latitude, rounded(river_width_px(rivers, point.flow))});
    }
    if (line.size() > 1) lines.push_back(std::move(line));
  }
  return lines;
}

ordered_json winds_of(const State& state) {
  if (!state.has(field::wind_east) || !state.has(field::wind_north)) return nullptr;
  const Grid& grid = state.grid();
  const auto east = state.read(field::wind_east), north = state.read(field::wind_north);
  constexpr int kRows = 30;
  auto arrows = ordered_json::array();
  for (int k = 0; k < kRows; ++k) {
    const int row = (2 * k + 1) * grid.ny() / (2 * kRows);
    const double latitude = grid.latitude_deg(row);
    const int count =
        std::max(4, static_cast<int>(2.0 * kRows * std::cos(latitude * M_PI / 180.0)));
    for (int n = 0; n < count; ++n) {
      const int column = (2 * n + 1) * grid.nx() / (2 * count);
      const Index cell = grid.cell(column, row);
      arrows.push_back({rounded(grid.longitude_deg(column)), rounded(latitude), rounded(east[cell]),
                        rounded(north[cell])});
    }
  }
  return arrows;
}

ordered_json boundaries_of(const State& state, const MapFrame& frame) {
  if (!state.has(field::plate_id) || !state.has(field::boundary_type)) return nullptr;
  const ColourMap colours("boundary_type");
  auto lines = ordered_json::object();
  for (const BoundaryLine& boundary : boundary_lines(frame, state)) {
    for (const auto& piece : boundary.pieces) {
      auto line = ordered_json::array();
      for (std::size_t k = piece.begin; k <= piece.end; ++k) {
        line.push_back(place_of(frame, boundary.points[k].x, boundary.points[k].y));
      }
      lines[hex(colours.category(piece.type)->colour)].push_back(std::move(line));
    }
  }
  return lines;
}

double centre_of(const State& state) {
  const Grid& grid = state.grid();
  const auto elevation = state.read(field::elevation);
  double east = 0.0, north = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      if (elevation[grid.cell(i, j)] < 0.0F) continue;
      const double longitude = grid.longitude_deg(i) * M_PI / 180.0;
      east += grid.area_m2(j) * std::sin(longitude);
      north += grid.area_m2(j) * std::cos(longitude);
    }
  }
  return rounded(std::atan2(east, north) * 180.0 / M_PI);
}

}  // namespace geo::io
