#include "geo/kernels/climate/ocean_currents.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kLandFriction = 1e7;  // over that of water

/// The sea as finite volumes about the values of a stream function.
class StreamFunction {
 public:
  StreamFunction(const Grid& grid, const OceanCurrents& model, double rotation_rad_s,
                 std::span<const double> latitude_deg, std::span<const float> land_fraction)
      : grid_(grid),
        model_(model),
        rotation_rad_s_(rotation_rad_s),
        latitude_deg_(latitude_deg),
        land_fraction_(land_fraction) {}

  [[nodiscard]] bool is_land(Index cell) const { return land_fraction_[cell] > 0.5F; }

  /// Psi, m3 s-1, up to a constant.
  [[nodiscard]] Eigen::VectorXd solve(std::span<const double> stress_east_pa,
                                      std::span<const double> stress_north_pa) const {
    const Eigen::SparseMatrix<double> equations = matrix();
    Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(equations);
    if (solver.info() != Eigen::Success) throw Bug("ocean currents: no factors");
    return solver.solve(curl(stress_east_pa, stress_north_pa));
  }

  /// Psi at the corner north-east of a cell, of row -1 and the last at a pole: that of the coast
  /// where one of the cells around is land, else the mean of the four.
  [[nodiscard]] double corner(const Eigen::VectorXd& psi, int i, int j) const {
    const int next = (i + 1) % grid_.nx();
    const int south = std::max(j, 0), north = std::min(j + 1, grid_.ny() - 1);
    double coast = 0.0, all = 0.0;
    int land = 0;
    for (const Index cell : {grid_.cell(i, south), grid_.cell(next, south), grid_.cell(i, north),
                             grid_.cell(next, north)}) {
      all += psi[cell];
      if (!is_land(cell)) continue;
      coast += psi[cell];
      ++land;
    }
    return land > 0 ? coast / land : 0.25 * all;
  }

 private:
  [[nodiscard]] double friction(Index cell) const {
    return model_.friction_1_s * (is_land(cell) ? kLandFriction : 1.0);
  }
  [[nodiscard]] double coriolis(double latitude_deg) const {
    return 2.0 * rotation_rad_s_ * std::sin(latitude_deg * kRadians);
  }
  [[nodiscard]] bool at_pole(int j) const { return j == grid_.ny() - 1; }

  /// Friction through the faces of every cell, and beta's term from the side that waves come from.
  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(grid_.size()) * 11);
    const auto exchange = [&](Index here, Index there, double geometry) {
      const double r = friction(here), s = friction(there);
      const double through = geometry * 2.0 * r * s / (r + s);
      entries.emplace_back(here, here, -through);
      entries.emplace_back(here, there, through);
      entries.emplace_back(there, there, -through);
      entries.emplace_back(there, here, through);
    };
    const double half_row_deg = 90.0 / grid_.ny();
    for (int j = 0; j < grid_.ny(); ++j) {
      const double per_east = grid_.face_east_m(j) / grid_.spacing_east_m(j);
      const double per_north = at_pole(j) ? 0.0 : grid_.face_north_m(j) / grid_.spacing_north_m(j);
      // The area times beta over the width: the change of f over the row.
      const double beta =
          coriolis(latitude_deg_[j] + half_row_deg) - coriolis(latitude_deg_[j] - half_row_deg);
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index here = grid_.cell(i, j), east = grid_.neighbour(i, j, kEast);
        exchange(here, east, per_east);
        if (!at_pole(j)) exchange(here, grid_.neighbour(i, j, kNorth), per_north);
        const Index upwind = beta > 0.0 ? east : grid_.neighbour(i, j, kWest);
        entries.emplace_back(here, upwind, std::abs(beta));
        entries.emplace_back(here, here, -std::abs(beta));
        // Psi has no level of its own: what little it leaks here gives it one.
        entries.emplace_back(here, here, -1e-9 * (friction(here) + std::abs(beta)));
      }
    }
    Eigen::SparseMatrix<double> result(grid_.size(), grid_.size());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  /// Circulation of the stress round every cell over the density of water.
  [[nodiscard]] Eigen::VectorXd curl(std::span<const double> east_pa,
                                     std::span<const double> north_pa) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(grid_.size());
    const auto on_water = [&](Index here, Index there, std::span<const double> stress_pa) {
      return is_land(here) || is_land(there) ? 0.0 : 0.5 * (stress_pa[here] + stress_pa[there]);
    };
    for (int j = 0; j < grid_.ny(); ++j) {
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index here = grid_.cell(i, j), east = grid_.neighbour(i, j, kEast);
        const double along_east =
            on_water(here, east, north_pa) * grid_.face_east_m(j) / model_.water_density_kg_m3;
        result[here] += along_east;
        result[east] -= along_east;
        if (at_pole(j)) continue;
        const Index north = grid_.neighbour(i, j, kNorth);
        const double along_north =
            on_water(here, north, east_pa) * grid_.face_north_m(j) / model_.water_density_kg_m3;
        result[here] -= along_north;
        result[north] += along_north;
      }
    }
    return result;
  }

  const Grid& grid_;
  const OceanCurrents& model_;
  double rotation_rad_s_;
  std::span<const double> latitude_deg_;
  std::span<const float> land_fraction_;
};

}  // namespace

WindStress wind_stress(const OceanCurrents& model, double wind_east_m_s, double wind_north_m_s) {
  const double per_wind =
      model.air_density_kg_m3 * model.drag_coefficient * std::hypot(wind_east_m_s, wind_north_m_s);
  return {per_wind * wind_east_m_s, per_wind * wind_north_m_s};
}

void ocean_currents(const Grid& grid, const OceanCurrents& model, double rotation_rad_s,
                    std::span<const double> latitude_deg, std::span<const float> land_fraction,
                    std::span<const double> stress_east_pa, std::span<const double> stress_north_pa,
                    std::span<float> current_east_m_s, std::span<float> current_north_m_s) {
  if (grid.topology() != Topology::sphere) throw Bug("ocean_currents: the grid is no sphere");
  check_sizes("ocean_currents", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("ocean_currents", grid.size(),
              {{"land_fraction", land_fraction.size()},
               {"stress_east_pa", stress_east_pa.size()},
               {"stress_north_pa", stress_north_pa.size()},
               {"current_east_m_s", current_east_m_s.size()},
               {"current_north_m_s", current_north_m_s.size()}});
  const StreamFunction sea(grid, model, rotation_rad_s, latitude_deg, land_fraction);
  const Eigen::VectorXd psi = sea.solve(stress_east_pa, stress_north_pa);
  const int nx = grid.nx();
  for (int j = 0; j < grid.ny(); ++j) {
    // Towards the poles over several columns: cells there are narrower than what they resolve.
    const int reach =
        std::min(nx / 4, static_cast<int>(0.25 * grid.spacing_north_m(j) / grid.spacing_east_m(j)));
    const double across_m = (2 * reach + 1) * grid.spacing_east_m(j);
    for (int i = 0; i < nx; ++i) {
      const Index here = grid.cell(i, j);
      if (sea.is_land(here)) {
        current_east_m_s[here] = current_north_m_s[here] = 0.0F;
        continue;
      }
      const auto corner = [&](int column, int row) {
        return sea.corner(psi, (column + nx) % nx, row);
      };
      const double northward = 0.5 * (corner(i + reach, j) + corner(i + reach, j - 1) -
                                      corner(i - 1 - reach, j) - corner(i - 1 - reach, j - 1)),
                   eastward = 0.5 * (corner(i - 1, j - 1) + corner(i, j - 1) - corner(i - 1, j) -
                                     corner(i, j));
      current_north_m_s[here] = static_cast<float>(northward / across_m / model.layer_m);
      current_east_m_s[here] = static_cast<float>(eastward / grid.face_east_m(j) / model.layer_m);
    }
  }
}

}  // namespace geo
