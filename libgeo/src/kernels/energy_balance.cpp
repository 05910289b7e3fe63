#include "geo/kernels/energy_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/insolation.hpp"
#include "geo/kernels/thermodynamics.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
// The mean is almost a Laplace problem; storage makes the harmonic complex, and strong
// over-relaxation of complex problems diverges.
constexpr double kMeanRelaxation = 1.85, kHarmonicRelaxation = 1.2;

/// Solves one row: diagonal x_i - east_i x_{i+1} - east_{i-1} x_{i-1} = right_i, cyclic
/// (Sherman-Morrison on the Thomas algorithm). All coefficients of a row are diagonally dominant.
template <class T>
class CyclicRow {
 public:
  explicit CyclicRow(int n) : upper_(n), solution_(n), corner_(n) {}

  std::span<const T> solve(std::span<const T> diagonal, std::span<const double> east,
                           std::span<const T> right) {
    const int n = static_cast<int>(diagonal.size());
    const double wrap = east[n - 1];
    // The corner entries are split off as a rank-one term: gamma at both ends.
    const T gamma = -diagonal[0];
    const T first = diagonal[0] - gamma;
    const T last = diagonal[n - 1] - wrap * wrap / gamma;
    T pivot = first;
    solution_[0] = right[0] / pivot;
    corner_[0] = gamma / pivot;
    for (int i = 1; i < n; ++i) {
      upper_[i - 1] = -east[i - 1] / pivot;
      pivot = (i == n - 1 ? last : diagonal[i]) + east[i - 1] * upper_[i - 1];
      const T inverse = T(1.0) / pivot;
      const T corner_right = i == n - 1 ? T(-wrap) : T(0.0);
      solution_[i] = (right[i] + east[i - 1] * solution_[i - 1]) * inverse;
      corner_[i] = (corner_right + east[i - 1] * corner_[i - 1]) * inverse;
    }
    for (int i = n - 2; i >= 0; --i) {
      solution_[i] -= upper_[i] * solution_[i + 1];
      corner_[i] -= upper_[i] * corner_[i + 1];
    }
    const T factor = (solution_[0] - wrap * solution_[n - 1] / gamma) /
                     (T(1.0) + corner_[0] - wrap * corner_[n - 1] / gamma);
    for (int i = 0; i < n; ++i) solution_[i] -= factor * corner_[i];
    return solution_;
  }

 private:
  std::vector<T> upper_, solution_, corner_;
};

/// Heat conductances of all faces for a diffusivity per cell (W m-2 K-1 on the unit sphere).
void face_conductances(const Grid& grid, std::span<const double> diffusivity,
                       std::span<double> east, std::span<double> north) {
  const double radius2 = grid.figure().radius_m * grid.figure().radius_m;
  const int nx = grid.nx();
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    const double per_east = radius2 * grid.face_east_m(j) / grid.spacing_east_m(j);
    const double per_north = radius2 * grid.face_north_m(j) / grid.spacing_north_m(j);
    for (int i = 0; i < nx; ++i) {
      const Index here = grid.cell(i, j);
      const Index to_east = grid.cell(i + 1 == nx ? 0 : i + 1, j);
      const Index to_north = grid.neighbour(i, j, kNorth);
      east[here] = per_east * 0.5 * (diffusivity[here] + diffusivity[to_east]);
      north[here] = per_north * 0.5 * (diffusivity[here] + diffusivity[to_north]);
    }
  }
}

}  // namespace

template <class T>
void relax_heat(const Grid& grid, const HeatProblem<T>& problem, int sweeps, double over_relaxation,
                std::span<T> temperature) {
  if (grid.topology() == Topology::plane) throw Bug("relax_heat: the grid has edges");
  const int nx = grid.nx(), ny = grid.ny();
  const bool sphere = grid.topology() == Topology::sphere;
  CyclicRow<T> row(nx);
  std::vector<T> diagonal(nx), right(nx);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int j = 0; j < ny; ++j) {
      const std::size_t begin = static_cast<std::size_t>(j) * nx;
      const std::size_t below = static_cast<std::size_t>(j == 0 ? ny - 1 : j - 1) * nx;
      const std::size_t above = static_cast<std::size_t>(j + 1 == ny ? 0 : j + 1) * nx;
      const auto east = problem.conductance_east.subspan(begin, nx);
      for (int i = 0; i < nx; ++i) {
        const std::size_t here = begin + i;
        // Faces at a pole have no length: no heat crosses them.
        const double to_north = problem.conductance_north[here];
        const double to_south = sphere && j == 0 ? 0.0 : problem.conductance_north[below + i];
        const double west = east[i == 0 ? nx - 1 : i - 1];
        diagonal[i] = problem.loss[here] + (to_north + to_south + east[i] + west);
        right[i] = problem.source[here] + to_north * temperature[above + i] +
                   to_south * temperature[below + i];
      }
      const auto solved = row.solve(diagonal, east, right);
      for (int i = 0; i < nx; ++i) {
        T& value = temperature[begin + i];
        value += over_relaxation * (solved[i] - value);
      }
    }
  }
}

template void relax_heat(const Grid&, const HeatProblem<double>&, int, double, std::span<double>);
template void relax_heat(const Grid&, const HeatProblem<std::complex<double>>&, int, double,
                         std::span<std::complex<double>>);

void gyre_heat(const Grid& grid, const EnergyBalance& model, std::span<const double> latitude_deg,
               std::span<const float> land_fraction, std::span<double> heat_w_m2) {
  const int nx = grid.nx();
#pragma omp parallel
  {
    std::vector<double> west(nx), east(nx);
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      const double keep = std::exp(-grid.spacing_east_m(j) / (1000.0 * model.gyre_reach_km));
      const auto land = [&](int i) { return land_fraction[grid.cell(i, j)]; };
      double from_west = 0.0, from_east = 0.0;
      // The second turn round the parallel starts from what the first one found.
      for (int turn = 0; turn < 2; ++turn) {
        for (int i = 0; i < nx; ++i) {
          west[i] = from_west;
          east[nx - 1 - i] = from_east;
          from_west = keep * from_west + (1.0 - keep) * land(i);
          from_east = keep * from_east + (1.0 - keep) * land(nx - 1 - i);
        }
      }
      const double gyre = model.gyre_heat_w_m2 * std::cos(2.0 * latitude_deg[j] * kRadians);
      for (int i = 0; i < nx; ++i) {
        heat_w_m2[grid.cell(i, j)] = gyre * (west[i] - east[i]) * (1.0 - land(i));
      }
    }
  }
}

void solve_energy_balance(const Grid& grid, const EnergyBalance& model,
                          std::span<const double> latitude_deg,
                          std::span<const float> land_fraction, std::span<const float> height_m,
                          std::span<double> mean_c, std::span<std::complex<double>> harmonic_k) {
  const int nx = grid.nx(), ny = grid.ny();
  const std::size_t size = static_cast<std::size_t>(grid.size());
  std::vector<InsolationCycle> insolation(ny);
  for (int j = 0; j < ny; ++j) {
    insolation[j] =
        insolation_cycle(latitude_deg[j], model.obliquity_deg, model.solar_constant_w_m2);
    std::fill_n(mean_c.begin() + static_cast<std::ptrdiff_t>(j) * nx, nx,
                27.0 - 40.0 * std::pow(std::sin(latitude_deg[j] * kRadians), 2));
  }
  std::vector<double> absorbed(size), diffusivity(size), east(size), north(size), loss(size),
      source(size), gyres(size);
  gyre_heat(grid, model, latitude_deg, land_fraction, gyres);
  const auto moist_factor = [&](double temperature_c) {
    return 1.0 + model.moist_transport * latent_to_sensible_slope(temperature_c);
  };
  const double reference_factor = moist_factor(15.0);
  const auto update_coefficients = [&] {
#pragma omp parallel for schedule(static)
    for (int j = 0; j < ny; ++j) {
      const double sine = std::sin(latitude_deg[j] * kRadians);
      const double bare = model.coalbedo + model.coalbedo_p2 * 0.5 * (3.0 * sine * sine - 1.0);
      for (int i = 0; i < nx; ++i) {
        const Index here = grid.cell(i, j);
        const double surface_c = mean_c[here] - model.lapse_k_m * height_m[here];
        const double ice =
            model.ice_width_k > 0.0
                ? 1.0 / (1.0 + std::exp((surface_c - model.ice_temperature_c) / model.ice_width_k))
                : 0.0;
        absorbed[here] = bare + ice * (model.ice_coalbedo - bare);
        diffusivity[here] =
            model.diffusivity_w_m2_k * moist_factor(mean_c[here]) / reference_factor;
        const double area_m2 = grid.area_m2(j);
        loss[here] = model.outgoing_slope_w_m2_k * area_m2;
        source[here] =
            (insolation[j].mean_w_m2 * absorbed[here] - model.outgoing_w_m2 + gyres[here]) *
            area_m2;
      }
    }
    face_conductances(grid, diffusivity, east, north);
  };

  // Ice and moist transport follow the temperature slowly; each round relaxes towards the
  // solution of the present ones.
  constexpr int kRounds = 12, kSweepsPerRound = 12, kLastSweeps = 60;
  for (int round = 0; round <= kRounds; ++round) {
    update_coefficients();
    relax_heat<double>(grid, {east, north, loss, source},
                       round < kRounds ? kSweepsPerRound : kLastSweeps, kMeanRelaxation, mean_c);
  }

  std::vector<std::complex<double>> storing(size), forcing(size);
  constexpr double kOmegaPerYear = 2.0 * std::numbers::pi;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Index here = grid.cell(i, j);
      // Sea ice cuts the air off from the water's heat.
      const double ice =
          model.ice_width_k > 0.0
              ? 1.0 / (1.0 + std::exp((mean_c[here] - model.ice_temperature_c) / model.ice_width_k))
              : 0.0;
      const double land = land_fraction[here] + (1.0 - land_fraction[here]) * ice;
      const double capacity = land * model.land_heat_capacity_w_yr_m2_k +
                              (1.0 - land) * model.ocean_heat_capacity_w_yr_m2_k;
      storing[here] = std::complex<double>(model.outgoing_slope_w_m2_k, kOmegaPerYear * capacity) *
                      grid.area_m2(j);
      forcing[here] = insolation[j].harmonic_w_m2 * absorbed[here] * grid.area_m2(j);
      harmonic_k[here] = 0.0;
    }
  }
  constexpr int kHarmonicSweeps = 60;
  relax_heat<std::complex<double>>(grid, {east, north, storing, forcing}, kHarmonicSweeps,
                                   kHarmonicRelaxation, harmonic_k);
}

}  // namespace geo
