#include "climate_frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Latitude of each row's centre; `fallback_deg` for grids that do not know theirs.
std::vector<double> row_latitudes(const Grid& grid, double fallback_deg, double radius_m) {
  std::vector<double> latitude(grid.ny(), fallback_deg);
  for (int j = 0; j < grid.ny(); ++j) {
    if (grid.is_geographic()) {
      latitude[j] = grid.latitude_deg(j);
    } else if (grid.topology() == Topology::plane) {
      latitude[j] = std::clamp(fallback_deg + grid.y_m(j) / radius_m / kRadians, -90.0, 90.0);
    }
  }
  return latitude;
}

std::vector<double> edges_between(std::span<const double> centres) {
  const double half = 0.5 * (centres[1] - centres[0]);
  std::vector<double> edges{centres[0] - half};
  for (std::size_t k = 0; k < centres.size(); ++k) edges.push_back(centres[k] + half);
  return edges;
}

std::vector<double> column_longitudes(const Grid& grid, double latitude_deg, double radius_m) {
  std::vector<double> longitude(grid.nx());
  const double parallel_m = radius_m * kRadians * std::max(0.01, std::cos(latitude_deg * kRadians));
  for (int i = 0; i < grid.nx(); ++i) {
    longitude[i] = grid.is_geographic() ? grid.longitude_deg(i) : grid.x_m(i) / parallel_m;
  }
  return longitude;
}

}  // namespace

ClimateFrame::ClimateFrame(const Grid& grid, const ClimateParameters& parameters,
                           const Planet& planet)
    : edge_continues_(parameters.surroundings == "edge") {
  const double radius_m = grid.figure().radius_m;
  const double topography_m = 1000.0 * parameters.topography_resolution_km;
  latitude_deg_ = row_latitudes(grid, parameters.latitude_deg, radius_m);
  const int rows = std::max(12, static_cast<int>(std::lround(180.0 / parameters.resolution_deg)));
  switch (grid.topology()) {
    case Topology::sphere:
    case Topology::plane:
      planet_ =
          std::make_shared<const Grid>(Grid::sphere(2 * rows, rows, planet.figure(), grid.turn()));
      break;
    case Topology::torus:
      planet_ = std::make_shared<const Grid>(
          coarser_grid(grid, parameters.resolution_deg * kRadians * radius_m));
      break;
  }
  // Small planes keep enough cells to show their own ranges.
  const double extent_m = grid.face_east_m(0) * grid.ny();
  topography_ = std::make_unique<Grid>(coarser_grid(
      grid, grid.topology() == Topology::sphere ? topography_m
                                                : std::min(topography_m, extent_m / 64.0)));
  planet_latitude_deg_ = row_latitudes(*planet_, parameters.latitude_deg, radius_m);
  on_topography_ = std::make_unique<ConservativeRemapping>(grid, *topography_);
  if (grid.topology() == Topology::plane) {
    // The topography grid spans the same rows: its latitudes lie evenly between theirs.
    const auto edges = edges_between(latitude_deg_);
    const double step = (edges.back() - edges.front()) / topography_->ny();
    for (int j = 0; j < topography_->ny(); ++j) {
      topography_latitude_deg_.push_back(edges.front() + (j + 0.5) * step);
    }
    const auto longitudes =
        edges_between(column_longitudes(grid, parameters.latitude_deg, radius_m));
    std::vector<double> topography_rows{edges.front()}, topography_columns{longitudes.front()};
    const double step_east = (longitudes.back() - longitudes.front()) / topography_->nx();
    for (int j = 1; j <= topography_->ny(); ++j)
      topography_rows.push_back(edges.front() + j * step);
    for (int i = 1; i <= topography_->nx(); ++i) {
      topography_columns.push_back(longitudes.front() + i * step_east);
    }
    on_planet_ = std::make_unique<ConservativeRemapping>(grid, *planet_, edges, longitudes);
    topography_on_planet_ = std::make_unique<ConservativeRemapping>(
        *topography_, *planet_, topography_rows, topography_columns);
  } else {
    topography_latitude_deg_ = row_latitudes(*topography_, parameters.latitude_deg, radius_m);
    on_planet_ = std::make_unique<ConservativeRemapping>(grid, *planet_);
    topography_on_planet_ = std::make_unique<ConservativeRemapping>(*topography_, *planet_);
  }
}

void ClimateFrame::planet_topography(std::span<const float> elevation,
                                     std::span<float> land_fraction,
                                     std::span<float> height_m) const {
  std::vector<float> coverage(land_fraction.size());
  on_planet_->average_elevation(elevation, land_fraction, height_m, coverage);
  if (on_planet_->fine().topology() == Topology::plane && edge_continues_) {
    continue_edge(coverage, land_fraction, height_m);
  }
}

std::vector<float> ClimateFrame::planet_glaciers(std::span<const float> ice_thickness_m,
                                                 std::span<const float> land_fraction) const {
  constexpr float kWhole_m = 100.0F;  // glaciers that cover a part of a cell are about so thick
  std::vector<float> covered(ice_thickness_m.size()), glaciers(land_fraction.size());
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < covered.size(); ++cell) {
    covered[cell] = std::min(1.0F, ice_thickness_m[cell] / kWhole_m);
  }
  on_planet_->average(covered, glaciers);
  for (std::size_t cell = 0; cell < glaciers.size(); ++cell) {
    if (glaciers[cell] > 0.0F) {
      glaciers[cell] = std::min(1.0F, glaciers[cell] / std::max(1e-6F, land_fraction[cell]));
    }
  }
  return glaciers;
}

void ClimateFrame::continue_edge(std::span<float> coverage, std::span<float> land_fraction,
                                 std::span<float> height_m) const {
  constexpr double kReach_m = 1.0e6;
  constexpr float kKnown = 1.0e-6F;
  const Grid& grid = *planet_;
  const int passes = std::max(1, static_cast<int>(std::lround(kReach_m / grid.face_east_m(0))));
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<Index> reached;
    std::vector<float> land, height;
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (coverage[cell] > kKnown) continue;
      float known = 0.0F, land_sum = 0.0F, height_sum = 0.0F;
      for (int k = 0; k < kDirections; ++k) {
        const Index from = grid.neighbour(cell, k);
        if (coverage[from] <= kKnown) continue;
        known += 1.0F;
        land_sum += land_fraction[from];
        height_sum += height_m[from];
      }
      if (known == 0.0F) continue;
      reached.push_back(cell);
      land.push_back(land_sum / known);
      height.push_back(height_sum / known);
    }
    if (reached.empty()) return;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      coverage[reached[k]] = 1.0F;
      land_fraction[reached[k]] = land[k];
      height_m[reached[k]] = height[k];
    }
  }
}

}  // namespace geo
