#include "geo/kernels/figures/plate_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr int kColumns = 720;
constexpr int kReach = 4;  // cells across the neighbourhood of a corner
/// Plates slide past each other where their relative motion is within 25 degrees of the boundary:
/// Bird (2003) takes 20 degrees on steps of 45 km, of which a neighbourhood averages several.
constexpr double kSlide = 0.4663;

void check_shape(const Grid& grid, std::size_t size, const char* what) {
  if (size != static_cast<std::size_t>(grid.size())) {
    throw InputError(std::string("plate boundaries: ") + what + " has " + std::to_string(size) +
                     " values, the grid " + std::to_string(grid.size()) + " cells");
  }
}

/// What a cell of the coarse raster knows: plate and velocity of its middle, the rest of all of it.
struct Patch {
  std::int16_t plate = -1;
  float east = 0.0F, north = 0.0F;
  double continent = 0.0;
};

class Patches {
 public:
  Patches(const Grid& grid, const PlateFields& fields)
      : grid_(grid.nx() <= kColumns
                  ? grid
                  : Grid::sphere(kColumns, kColumns / 2, grid.figure(), grid.turn())),
        patches_(grid_.size()) {
    const int nx = grid.nx(), ny = grid.ny();
    std::vector<std::int32_t> cells(patches_.size(), 0);
    std::vector<int> columns(nx);
    for (int i = 0; i < nx; ++i) columns[i] = scaled(i, grid_.nx(), nx);
    for (int j = 0; j < ny; ++j) {
      const int row = scaled(j, grid_.ny(), ny);
      for (int i = 0; i < nx; ++i) {
        const Index from = grid.cell(i, j), to = grid_.cell(columns[i], row);
        Patch& patch = patches_[to];
        patch.continent += fields.continental_fraction[from];
        ++cells[to];
      }
    }
    for (int row = 0; row < grid_.ny(); ++row) {
      for (int column = 0; column < grid_.nx(); ++column) {
        const Index to = grid_.cell(column, row);
        const Index middle = grid.cell(scaled(column, nx, grid_.nx()), scaled(row, ny, grid_.ny()));
        Patch& patch = patches_[to];
        patch.plate = fields.plate_id[middle];
        patch.east = fields.velocity_east_mm_yr[middle];
        patch.north = fields.velocity_north_mm_yr[middle];
        patch.continent /= std::max(cells[to], 1);
      }
    }
  }

  [[nodiscard]] const Grid& grid() const { return grid_; }
  /// Beyond a pole lies the same row, half-way round.
  [[nodiscard]] const Patch& at(int column, int row) const {
    const int ny = grid_.ny(), nx = grid_.nx();
    if (row < 0 || row >= ny) {
      row = row < 0 ? -1 - row : 2 * ny - 1 - row;
      column += nx / 2;
    }
    return patches_[grid_.cell((column % nx + nx) % nx, row)];
  }

 private:
  /// Cell of an axis of `to` cells in which the middle of cell i of `from` cells lies.
  static int scaled(int i, int to, int from) {
    return static_cast<int>((2 * std::int64_t(i) + 1) * to / (2 * std::int64_t(from)));
  }

  Grid grid_;
  std::vector<Patch> patches_;
};

/// One plate in the neighbourhood of a corner.
struct Side {
  std::int16_t plate;
  double gradient_east = 0.0, gradient_north = 0.0;  // of its indicator, per m
  double east = 0.0, north = 0.0, continent = 0.0;   // sums over its cells
  int cells = 0;

  [[nodiscard]] double steepness() const {
    return std::sqrt(gradient_east * gradient_east + gradient_north * gradient_north);
  }
  [[nodiscard]] bool is_continent() const { return continent >= 0.5 * cells; }
};

/// The plates around the corner above and to the right of a cell, and what joins them.
class Corner {
 public:
  static bool lies_within_a_plate(const Patches& patches, int column, int row) {
    const std::int16_t plate = patches.at(column, row).plate;
    for (int j = 0; j < kReach; ++j) {
      for (int i = 0; i < kReach; ++i) {
        if (patches.at(column - 1 + i, row - 1 + j).plate != plate) return false;
      }
    }
    return true;
  }

  Corner(const Patches& patches, int column, int row) {
    constexpr std::array kAcross{0.125, 0.375, 0.375, 0.125};  // 1:2:1 smoothing, halved cells
    constexpr std::array kAlong{-0.25, -0.25, 0.25, 0.25};     // its difference
    const double east_m = patches.grid().face_north_m(row);
    const double north_m = patches.grid().spacing_north_m(row);
    for (int j = 0; j < kReach; ++j) {
      for (int i = 0; i < kReach; ++i) {
        const Patch& patch = patches.at(column - 1 + i, row - 1 + j);
        Side& side = side_of(patch.plate);
        side.gradient_east += kAlong[i] * kAcross[j] / east_m;
        side.gradient_north += kAlong[j] * kAcross[i] / north_m;
        side.east += patch.east;
        side.north += patch.north;
        side.continent += patch.continent;
        ++side.cells;
      }
    }
    area_m2_ = east_m * north_m;
    std::partial_sort(sides_.begin(), sides_.begin() + std::min<int>(2, count_),
                      sides_.begin() + count_,
                      [](const Side& a, const Side& b) { return a.steepness() > b.steepness(); });
  }

  [[nodiscard]] double length_m() const {
    double sum = 0.0;
    for (int s = 0; s < count_; ++s) sum += sides_[s].steepness();
    return 0.5 * sum * area_m2_;
  }
  /// Relative motion of the two plates that share most of the neighbourhood.
  struct Motion {
    double opening_mm_yr = 0.0, shear_mm_yr = 0.0;
  };
  [[nodiscard]] Motion motion() const {
    const Side &a = sides_[0], &b = sides_[1];
    const double steepness = a.steepness();
    if (steepness == 0.0) return {};
    const double east = a.east / a.cells - b.east / b.cells;
    const double north = a.north / a.cells - b.north / b.cells;
    return {(east * a.gradient_east + north * a.gradient_north) / steepness,
            std::abs(east * a.gradient_north - north * a.gradient_east) / steepness};
  }
  [[nodiscard]] BoundaryKind kind(const Motion& motion) const {
    const Side &a = sides_[0], &b = sides_[1];
    const bool is_land = a.continent / a.cells + b.continent / b.cells >= 1.0;
    if (std::abs(motion.opening_mm_yr) < kSlide * motion.shear_mm_yr) {
      return is_land ? BoundaryKind::continental_transform : BoundaryKind::ocean_transform;
    }
    if (motion.opening_mm_yr > 0.0) {
      return is_land ? BoundaryKind::continental_rift : BoundaryKind::ocean_ridge;
    }
    const bool continents_meet = a.is_continent() && b.is_continent();
    return continents_meet ? BoundaryKind::collision : BoundaryKind::subduction;
  }

 private:
  Side& side_of(std::int16_t plate) {
    for (int s = 0; s < count_; ++s) {
      if (sides_[s].plate == plate) return sides_[s];
    }
    sides_[count_] = Side{.plate = plate};
    return sides_[count_++];
  }

  std::array<Side, kReach * kReach> sides_{};
  int count_ = 0;
  double area_m2_ = 0.0;
};

}  // namespace

double BoundaryFigures::total_m() const {
  return std::accumulate(length_m.begin(), length_m.end(), at_rest_m);
}

BoundaryFigures measure_boundaries(const Grid& grid, const PlateFields& plates) {
  check_shape(grid, plates.plate_id.size(), "plate_id");
  check_shape(grid, plates.continental_fraction.size(), "continental_fraction");
  check_shape(grid, plates.velocity_east_mm_yr.size(), "plate_velocity_east");
  check_shape(grid, plates.velocity_north_mm_yr.size(), "plate_velocity_north");
  const Patches patches(grid, plates);
  BoundaryFigures figures;
  for (int row = 0; row + 1 < patches.grid().ny(); ++row) {
    for (int column = 0; column < patches.grid().nx(); ++column) {
      if (Corner::lies_within_a_plate(patches, column, row)) continue;
      const Corner corner(patches, column, row);
      const double length = corner.length_m();
      const Corner::Motion motion = corner.motion();
      if (motion.opening_mm_yr == 0.0 && motion.shear_mm_yr == 0.0) {
        figures.at_rest_m += length;
        continue;
      }
      const int kind = static_cast<int>(corner.kind(motion));
      figures.length_m[kind] += length;
      figures.opening_mm_yr[kind] += length * motion.opening_mm_yr;
    }
  }
  for (int kind = 0; kind < kBoundaryKinds; ++kind) {
    if (figures.length_m[kind] > 0.0) figures.opening_mm_yr[kind] /= figures.length_m[kind];
  }
  return figures;
}

std::vector<double> plate_shares(const Grid& grid, std::span<const std::int16_t> plate_id) {
  check_shape(grid, plate_id.size(), "plate_id");
  std::map<std::int16_t, double> area;
  for (int j = 0; j < grid.ny(); ++j) {
    // Cells of a row come in long runs of one plate.
    const auto row = plate_id.subspan(std::size_t(j) * grid.nx(), grid.nx());
    for (auto at = row.begin(); at != row.end();) {
      const auto end = std::find_if(at, row.end(), [&](std::int16_t id) { return id != *at; });
      if (*at >= 0) area[*at] += grid.area_m2(j) * static_cast<double>(end - at);
      at = end;
    }
  }
  std::vector<double> shares;
  for (const auto& [plate, m2] : area) shares.push_back(m2 / grid.total_area_m2());
  std::sort(shares.begin(), shares.end(), std::greater<>());
  return shares;
}

double speed_without_net_rotation(const Grid& grid, std::span<const float> velocity_east,
                                  std::span<const float> velocity_north) {
  check_shape(grid, velocity_east.size(), "plate_velocity_east");
  check_shape(grid, velocity_north.size(), "plate_velocity_north");
  const int nx = grid.nx(), ny = grid.ny();
  // Cosine and sine of the longitudes of the grid's own axis, distance from that axis and along it.
  std::vector<std::array<double, 2>> circle(nx), meridian(ny);
  for (int i = 0; i < nx; ++i) {
    const auto r = grid.to_axis(grid.unit_vector(i, ny / 2));
    const double across = std::sqrt(r[0] * r[0] + r[1] * r[1]);
    circle[i] = {r[0] / across, r[1] / across};
  }
  for (int j = 0; j < ny; ++j) {
    const auto r = grid.to_axis(grid.unit_vector(0, j));
    meridian[j] = {std::sqrt(r[0] * r[0] + r[1] * r[1]), r[2]};
  }
  // Of each row: the sums of place x velocity, and of the squares of the speeds.
  std::vector<std::array<double, 3>> turn(ny);
  std::vector<double> squares(ny);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < ny; ++j) {
    double east_cosine = 0.0, east_sine = 0.0, east = 0.0, north_cosine = 0.0, north_sine = 0.0;
    double square = 0.0;
    for (int i = 0; i < nx; ++i) {
      const Index c = grid.cell(i, j);
      const double u = velocity_east[c], v = velocity_north[c];
      east += u;
      east_cosine += u * circle[i][0];
      east_sine += u * circle[i][1];
      north_cosine += v * circle[i][0];
      north_sine += v * circle[i][1];
      square += u * u + v * v;
    }
    const auto [across, along] = meridian[j];
    turn[j] = {north_sine - along * east_cosine, -north_cosine - along * east_sine, across * east};
    squares[j] = square;
  }
  std::array<double, 3> mean{};
  double sum = 0.0;
  for (int j = 0; j < ny; ++j) {
    for (int k = 0; k < 3; ++k) mean[k] += turn[j][k] * grid.area_m2(j) / grid.total_area_m2();
    sum += squares[j] * grid.area_m2(j);
  }
  // |v - w x r|^2 = |v|^2 - 2 w . (r x v) + |w|^2 - (w . r)^2, with w = 3/2 of the mean of r x v.
  const std::array net{1.5 * mean[0], 1.5 * mean[1], 1.5 * mean[2]};
  const double equatorial = net[0] * net[0] + net[1] * net[1], polar = net[2] * net[2];
  for (int j = 0; j < ny; ++j) {
    const auto [across, along] = meridian[j];
    sum += nx * grid.area_m2(j) *
           (equatorial * (1.0 - 0.5 * across * across) + polar * (1.0 - along * along));
  }
  for (int k = 0; k < 3; ++k) sum -= 2.0 * net[k] * mean[k] * grid.total_area_m2();
  return std::sqrt(std::max(sum, 0.0) / grid.total_area_m2());
}

}  // namespace geo
