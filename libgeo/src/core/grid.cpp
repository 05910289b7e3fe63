#include "geo/core/grid.hpp"

#include <GeographicLib/Ellipsoid.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/projection.hpp"
#include "geo/core/vector3.hpp"

namespace geo {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

void check_size(int nx, int ny) {
  // One row or column has no neighbours to speak of; 29 bits leave room for a direction in 32.
  constexpr std::int64_t kMostCells = std::int64_t{1} << 29;
  if (nx < 4 || ny < 3) {
    throw ConfigurationError("grid of " + std::to_string(nx) + " x " + std::to_string(ny) +
                             " cells is too small: at least 4 x 3");
  }
  if (std::int64_t{nx} * ny > kMostCells) {
    throw ConfigurationError("grid of " + std::to_string(nx) + " x " + std::to_string(ny) +
                             " cells is too large: at most 536870912 cells");
  }
  // A row has its own geometry, which then takes more memory than fields do.
  constexpr int kMostRows = 1 << 24;
  if (ny > kMostRows) {
    throw ConfigurationError("grid of " + std::to_string(nx) + " x " + std::to_string(ny) +
                             " cells has too many rows: at most 16777216");
  }
}

void check_figure(const Ellipsoid& figure) {
  if (!(figure.radius_m > 0.0) || !(figure.flattening > -0.5 && figure.flattening < 0.5)) {
    throw ConfigurationError("planet figure: radius must be positive and flattening within ±0.5");
  }
}

/// Beyond these areas, distances and what is counted by them leave the numbers' range or precision.
bool is_cell_side(double side_m) { return side_m >= 1e-3 && side_m <= 1e9; }

}  // namespace

Grid::Grid(Topology topology, Edges edges, int nx, int ny, Ellipsoid figure)
    : topology_(topology), edges_(edges), nx_(nx), ny_(ny), figure_(figure) {
  check_size(nx, ny);
  check_figure(figure);
  area_m2_.resize(ny);
  spacing_east_m_.resize(ny);
  face_east_m_.resize(ny);
  face_north_m_.resize(ny + 1);
  distance_m_.resize(ny);
}

Grid Grid::sphere(int nx, int ny, Ellipsoid figure, std::array<double, 3> turn) {
  if (nx % 2 != 0) {
    throw ConfigurationError("grid width " + std::to_string(nx) +
                             " must be even on a sphere: a pole crossing lands half-way round");
  }
  Grid grid(Topology::sphere, Edges::closed, nx, ny, figure);
  grid.set_latitude_longitude({-90.0, 90.0, -180.0, 180.0});
  grid.turn_ = turn;
  grid.is_turned_ = length(turn) > 0.0;
  for (int k = 0; k < 3; ++k) {
    Vector3 axis{};
    axis[k] = 1.0;
    grid.turned_axes_[k] = rotated(axis, turn);
  }
  return grid;
}

Grid Grid::window(int nx, int ny, Window window, Ellipsoid figure, Edges edges) {
  const bool sound = window.south_deg >= -90.0 && window.north_deg <= 90.0 &&
                     window.south_deg < window.north_deg && window.west_deg < window.east_deg &&
                     window.east_deg - window.west_deg <= 360.0 + 1e-9;
  if (!sound) throw ConfigurationError("latitude-longitude window is empty or beyond the planet");
  const double degree_m = figure.radius_m * kRadiansPerDegree;
  if (!is_cell_side(degree_m * (window.north_deg - window.south_deg) / ny) ||
      !is_cell_side(degree_m * (window.east_deg - window.west_deg) / nx)) {
    throw ConfigurationError(
        "cells of a latitude-longitude window must measure between 1 mm and 1e6 km");
  }
  Grid grid(Topology::plane, edges, nx, ny, figure);
  grid.set_latitude_longitude(window);
  return grid;
}

Grid Grid::plane(int nx, int ny, double dx_m, double dy_m, Edges edges,
                 std::optional<Centre> centre, Ellipsoid figure) {
  Grid grid(Topology::plane, edges, nx, ny, figure);
  grid.set_plane_metric(dx_m, dy_m);
  grid.centre_ = centre;
  if (centre) {
    const double degree_m = figure.radius_m * kRadiansPerDegree;
    const double parallel_m =
        degree_m * std::max(0.01, std::cos(centre->latitude_deg * kRadiansPerDegree));
    for (int j = 0; j < ny; ++j) {
      grid.latitude_deg_.push_back(
          std::clamp(centre->latitude_deg + grid.y_m(j) / degree_m, -90.0, 90.0));
    }
    for (int i = 0; i < nx; ++i) {
      grid.longitude_deg_.push_back(centre->longitude_deg + grid.x_m(i) / parallel_m);
    }
  }
  grid.finish();
  return grid;
}

void Grid::check_equal_area(int nx, int ny, double cell_m, Centre centre, Ellipsoid figure) {
  check_size(nx, ny);
  check_figure(figure);
  if (!(std::abs(centre.latitude_deg) <= 90.0 && std::abs(centre.longitude_deg) <= 360.0)) {
    throw ConfigurationError("centre of an equal-area grid: latitude must be within 90 degrees");
  }
  // The rim of the hemisphere lies at sqrt(2) authalic radii.
  const double radius_m = EqualAreaProjection(centre, figure).authalic_radius_m();
  if (std::hypot(0.5 * nx * cell_m, 0.5 * ny * cell_m) > std::numbers::sqrt2 * radius_m) {
    throw ConfigurationError("equal-area grid of " + std::to_string(nx) + " x " +
                             std::to_string(ny) + " cells reaches beyond half of the planet");
  }
}

Grid Grid::equal_area(int nx, int ny, double cell_m, Centre centre, Ellipsoid figure, Edges edges) {
  check_equal_area(nx, ny, cell_m, centre, figure);
  Grid grid(Topology::plane, edges, nx, ny, figure);
  grid.set_plane_metric(cell_m, cell_m);
  grid.centre_ = centre;
  const EqualAreaProjection projection(centre, figure);
  grid.cell_latitude_deg_.resize(grid.size());
  grid.cell_longitude_deg_.resize(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Centre here = projection.unproject(grid.x_m(i), grid.y_m(j));
      grid.cell_latitude_deg_[grid.cell(i, j)] = here.latitude_deg;
      grid.cell_longitude_deg_[grid.cell(i, j)] = here.longitude_deg;
    }
  }
  for (int j = 0; j < ny; ++j) {
    grid.latitude_deg_.push_back(projection.unproject(0.0, grid.y_m(j)).latitude_deg);
  }
  for (int i = 0; i < nx; ++i) {
    grid.longitude_deg_.push_back(projection.unproject(grid.x_m(i), 0.0).longitude_deg);
  }
  grid.finish();
  return grid;
}

Grid Grid::torus(int nx, int ny, double dx_m, double dy_m) {
  Grid grid(Topology::torus, Edges::closed, nx, ny, {});
  grid.set_plane_metric(dx_m, dy_m);
  grid.finish();
  return grid;
}

void Grid::set_plane_metric(double dx_m, double dy_m) {
  if (!is_cell_side(dx_m) || !is_cell_side(dy_m)) {
    throw ConfigurationError("cells of a plane must measure between 1 mm and 1e6 km");
  }
  step_north_m_ = dy_m;
  const double diagonal_m = std::hypot(dx_m, dy_m);
  for (int j = 0; j < ny_; ++j) {
    area_m2_[j] = dx_m * dy_m;
    spacing_east_m_[j] = dx_m;
    face_east_m_[j] = dy_m;
    distance_m_[j] = {dy_m, diagonal_m, dx_m, diagonal_m, dy_m, diagonal_m, dx_m, diagonal_m};
  }
  std::fill(face_north_m_.begin(), face_north_m_.end(), dx_m);
}

void Grid::set_latitude_longitude(Window window) {
  latitude_longitude_ = true;
  window_ = window;
  const double dlat = (window.north_deg - window.south_deg) / ny_;
  const double dlon = (window.east_deg - window.west_deg) / nx_;
  latitude_deg_.resize(ny_);
  longitude_deg_.resize(nx_);
  // Measured from the middle, so that north mirrors south to the last bit.
  const double middle_lat = 0.5 * (window.north_deg + window.south_deg);
  const double middle_lon = 0.5 * (window.east_deg + window.west_deg);
  for (int j = 0; j < ny_; ++j) latitude_deg_[j] = middle_lat + (j + 0.5 - 0.5 * ny_) * dlat;
  for (int i = 0; i < nx_; ++i) longitude_deg_[i] = middle_lon + (i + 0.5 - 0.5 * nx_) * dlon;

  const GeographicLib::Ellipsoid ellipsoid(figure_.radius_m, figure_.flattening);
  const GeographicLib::Geodesic geodesic(figure_.radius_m, figure_.flattening);
  const auto edge_deg = [&](int j) {
    return std::clamp(middle_lat + (j - 0.5 * ny_) * dlat, -90.0, 90.0);
  };
  const auto authalic_sine = [&](double latitude) {
    return std::sin(ellipsoid.AuthalicLatitude(latitude) * kRadiansPerDegree);
  };
  const double dlon_rad = dlon * kRadiansPerDegree;
  const double half_planet_m2 = 0.5 * ellipsoid.Area();
  const auto geodesic_m = [&](double lat1, double lat2, double lon2) {
    double distance = 0.0;
    geodesic.Inverse(lat1, 0.0, lat2, lon2, distance);
    return distance;
  };
  for (int j = 0; j < ny_; ++j) {
    const double south = edge_deg(j), north = edge_deg(j + 1), here = latitude_deg_[j];
    area_m2_[j] = half_planet_m2 * (authalic_sine(north) - authalic_sine(south)) * dlon / 360.0;
    spacing_east_m_[j] = ellipsoid.CircleRadius(here) * dlon_rad;
    face_east_m_[j] = ellipsoid.MeridianDistance(north) - ellipsoid.MeridianDistance(south);
    face_north_m_[j] = ellipsoid.CircleRadius(south) * dlon_rad;
    face_north_m_[j + 1] = ellipsoid.CircleRadius(north) * dlon_rad;

    const bool sphere = topology_ == Topology::sphere;
    const auto step = [&](int rows, double dlon_deg) {
      const int to = j + rows;
      if (to >= 0 && to < ny_) return geodesic_m(here, latitude_deg_[to], dlon_deg);
      if (sphere) return geodesic_m(here, here, 180.0 - dlon_deg);
      return geodesic_m(here, std::clamp(here + rows * dlat, -90.0, 90.0), dlon_deg);
    };
    const double east = step(0, dlon), north_m = step(1, 0.0), south_m = step(-1, 0.0);
    const double north_diagonal = step(1, dlon), south_diagonal = step(-1, dlon);
    distance_m_[j] = {north_m, north_diagonal, east, south_diagonal,
                      south_m, south_diagonal, east, north_diagonal};
  }
  if (window.south_deg <= -90.0) face_north_m_.front() = 0.0;
  if (window.north_deg >= 90.0) face_north_m_.back() = 0.0;
  step_north_m_ = face_east_m_[ny_ / 2];
  finish();
}

void Grid::finish() {
  total_area_m2_ = 0.0;
  for (const double area : area_m2_) total_area_m2_ += area * nx_;
  for (const double latitude : latitude_deg_) {
    sin_lat_.push_back(std::sin(latitude * kRadiansPerDegree));
    cos_lat_.push_back(std::cos(latitude * kRadiansPerDegree));
  }
  for (const double longitude : longitude_deg_) {
    sin_lon_.push_back(std::sin(longitude * kRadiansPerDegree));
    cos_lon_.push_back(std::cos(longitude * kRadiansPerDegree));
  }
}

Index Grid::neighbour(int column, int row, int k) const noexcept {
  int i = column + kColumnStep[k];
  int j = row + kRowStep[k];
  if (topology_ == Topology::plane) {
    return i < 0 || i >= nx_ || j < 0 || j >= ny_ ? kNoCell : j * nx_ + i;
  }
  if (j < 0 || j >= ny_) {
    if (topology_ == Topology::torus) {
      j = j < 0 ? ny_ - 1 : 0;
    } else {
      j = row;
      i += nx_ / 2;
    }
  }
  if (i < 0) i += nx_;
  if (i >= nx_) i -= nx_;
  return j * nx_ + i;
}

int Grid::back_direction(int row, int k) const noexcept {
  const int to = row + kRowStep[k];
  if (topology_ == Topology::sphere && (to < 0 || to >= ny_)) {
    // Over the pole: north stays north, the column step turns round.
    constexpr std::array<int, kDirections> kMirrored{kNorth, kNorthWest, kWest, kSouthWest,
                                                     kSouth, kSouthEast, kEast, kNorthEast};
    return kMirrored[k];
  }
  return (k + 4) % kDirections;
}

std::array<Index, kDirections> Grid::offsets() const noexcept {
  std::array<Index, kDirections> offset{};
  for (int k = 0; k < kDirections; ++k) offset[k] = kRowStep[k] * nx_ + kColumnStep[k];
  return offset;
}

std::array<double, 3> Grid::unit_vector(int column, int row) const noexcept {
  if (is_projected()) {
    const double latitude = cell_latitude_deg_[cell(column, row)] * kRadiansPerDegree;
    const double longitude = cell_longitude_deg_[cell(column, row)] * kRadiansPerDegree;
    const double ring = std::cos(latitude);
    return {ring * std::cos(longitude), ring * std::sin(longitude), std::sin(latitude)};
  }
  if (is_geographic()) {
    const Vector3 r{cos_lat_[row] * cos_lon_[column], cos_lat_[row] * sin_lon_[column],
                    sin_lat_[row]};
    if (!is_turned_) return r;
    return add(add(scaled(turned_axes_[0], r[0]), turned_axes_[1], r[1]), turned_axes_[2], r[2]);
  }
  if (topology_ == Topology::torus) {
    // A ring torus: seamless, with the larger circle along the rows.
    const double u = 2.0 * std::numbers::pi * (column + 0.5) / nx_;
    const double v = 2.0 * std::numbers::pi * (row + 0.5) / ny_;
    const double major = nx_ * spacing_east_m_[0] / (2.0 * std::numbers::pi);
    const double minor = std::min(ny_ * step_north_m_ / (2.0 * std::numbers::pi), 0.5 * major);
    const double ring = major + minor * std::cos(v);
    return {ring * std::cos(u) / figure_.radius_m, ring * std::sin(u) / figure_.radius_m,
            minor * std::sin(v) / figure_.radius_m};
  }
  return {x_m(column) / figure_.radius_m, y_m(row) / figure_.radius_m, 0.0};
}

std::array<double, 3> Grid::to_axis(const std::array<double, 3>& vector) const noexcept {
  if (!is_turned_) return vector;
  return {dot(turned_axes_[0], vector), dot(turned_axes_[1], vector), dot(turned_axes_[2], vector)};
}

}  // namespace geo
