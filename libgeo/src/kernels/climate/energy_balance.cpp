#include "geo/kernels/climate/energy_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kConverged_k = 1.0e-5;  // change of a step

/// Rows of the matrix, factored once: diagonal x_i - east_i x_{i+1} - east_{i-1} x_{i-1} = right_i,
/// cyclic (Thomas algorithm; the corner entries split off as a rank-one term, Sherman-Morrison).
template <class T>
class CyclicRows {
 public:
  CyclicRows(int nx, int ny)
      : nx_(nx),
        upper_(static_cast<std::size_t>(nx) * ny),
        inverse_(upper_.size()),
        corner_(upper_.size()),
        gamma_(ny),
        closing_(ny) {}

  void factor(int row, std::span<const T> diagonal, std::span<const double> east) {
    const std::size_t begin = static_cast<std::size_t>(row) * nx_;
    T* upper = upper_.data() + begin;
    T* inverse = inverse_.data() + begin;
    T* corner = corner_.data() + begin;
    const double wrap = east[nx_ - 1];
    const T gamma = -diagonal[0];
    inverse[0] = T(1.0) / (diagonal[0] - gamma);
    corner[0] = gamma * inverse[0];
    for (int i = 1; i < nx_; ++i) {
      upper[i - 1] = -east[i - 1] * inverse[i - 1];
      const bool last = i == nx_ - 1;
      const T own = last ? diagonal[i] - wrap * wrap / gamma : diagonal[i];
      inverse[i] = T(1.0) / (own + east[i - 1] * upper[i - 1]);
      corner[i] = ((last ? T(-wrap) : T(0.0)) + east[i - 1] * corner[i - 1]) * inverse[i];
    }
    for (int i = nx_ - 2; i >= 0; --i) corner[i] -= upper[i] * corner[i + 1];
    gamma_[row] = wrap / gamma;
    closing_[row] = T(1.0) / (T(1.0) + corner[0] - gamma_[row] * corner[nx_ - 1]);
  }

  /// Solves in place: `values` holds the right-hand side, then the solution.
  void solve(int row, std::span<const double> east, std::span<T> values) const {
    const std::size_t begin = static_cast<std::size_t>(row) * nx_;
    const T* upper = upper_.data() + begin;
    const T* inverse = inverse_.data() + begin;
    const T* corner = corner_.data() + begin;
    values[0] *= inverse[0];
    for (int i = 1; i < nx_; ++i)
      values[i] = (values[i] + east[i - 1] * values[i - 1]) * inverse[i];
    for (int i = nx_ - 2; i >= 0; --i) values[i] -= upper[i] * values[i + 1];
    const T factor = (values[0] - gamma_[row] * values[nx_ - 1]) * closing_[row];
    for (int i = 0; i < nx_; ++i) values[i] -= factor * corner[i];
  }

 private:
  int nx_;
  std::vector<T> upper_, inverse_, corner_, gamma_, closing_;
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
void solve_heat(const Grid& grid, const HeatProblem<T>& problem, int iterations,
                std::span<T> temperature) {
  if (grid.topology() == Topology::plane) throw Bug("solve_heat: the grid has edges");
  const int nx = grid.nx(), ny = grid.ny();
  const bool sphere = grid.topology() == Topology::sphere;
  CyclicRows<T> rows(nx, ny);
  std::vector<T> values(nx);
  const auto row_below = [&](int j) {
    return static_cast<std::size_t>(j == 0 ? ny - 1 : j - 1) * nx;
  };
  const auto row_above = [&](int j) {
    return static_cast<std::size_t>(j + 1 == ny ? 0 : j + 1) * nx;
  };
  // Faces at a pole have no length: no heat crosses them.
  const auto to_south = [&](int j, int i) {
    return sphere && j == 0 ? 0.0 : problem.conductance_north[row_below(j) + i];
  };
  for (int j = 0; j < ny; ++j) {
    const std::size_t begin = static_cast<std::size_t>(j) * nx;
    const auto east = problem.conductance_east.subspan(begin, nx);
    for (int i = 0; i < nx; ++i) {
      values[i] = problem.loss[begin + i] + (problem.conductance_north[begin + i] + to_south(j, i) +
                                             east[i] + east[i == 0 ? nx - 1 : i - 1]);
    }
    rows.factor(j, values, east);
  }
  // A x: loss and outgoing conductances on the diagonal, neighbours off it.
  const auto apply = [&](std::span<const T> x, std::span<T> out) {
    for (int j = 0; j < ny; ++j) {
      const std::size_t begin = static_cast<std::size_t>(j) * nx;
      const T* above = x.data() + row_above(j);
      const T* below = x.data() + row_below(j);
      const double* east = problem.conductance_east.data() + begin;
      for (int i = 0; i < nx; ++i) {
        const double west = east[i == 0 ? nx - 1 : i - 1];
        const double north = problem.conductance_north[begin + i], south = to_south(j, i);
        out[begin + i] =
            (problem.loss[begin + i] + (north + south + east[i] + west)) * x[begin + i] -
            north * above[i] - south * below[i] - east[i] * x[begin + (i + 1 == nx ? 0 : i + 1)] -
            west * x[begin + (i == 0 ? nx - 1 : i - 1)];
      }
    }
  };
  const auto precondition = [&](std::span<const T> from, std::span<T> to) {
    std::copy(from.begin(), from.end(), to.begin());
    for (int j = 0; j < ny; ++j) {
      const std::size_t begin = static_cast<std::size_t>(j) * nx;
      rows.solve(j, problem.conductance_east.subspan(begin, nx), to.subspan(begin, nx));
    }
  };
  const auto product = [](std::span<const T> a, std::span<const T> b) {
    T sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
  };
  const std::size_t size = temperature.size();
  std::vector<T> residual(size), direction(size), step(size), image(size);
  apply(temperature, image);
  for (std::size_t k = 0; k < size; ++k) residual[k] = problem.source[k] - image[k];
  precondition(residual, direction);
  T energy = product(residual, direction);
  for (int iteration = 0; iteration < iterations && std::abs(energy) > 0.0; ++iteration) {
    apply(direction, image);
    const T length = energy / product(direction, image);
    double largest = 0.0;
    for (std::size_t k = 0; k < size; ++k) {
      const T change = length * direction[k];
      temperature[k] += change;
      residual[k] -= length * image[k];
      largest = std::max(largest, std::abs(std::real(change)) + std::abs(std::imag(change)));
    }
    if (largest < kConverged_k) break;
    precondition(residual, step);
    const T next = product(residual, step);
    const T turn = next / energy;
    for (std::size_t k = 0; k < size; ++k) direction[k] = step[k] + turn * direction[k];
    energy = next;
  }
}

template void solve_heat(const Grid&, const HeatProblem<double>&, int, std::span<double>);
template void solve_heat(const Grid&, const HeatProblem<std::complex<double>>&, int,
                         std::span<std::complex<double>>);

void gyre_heat(const Grid& grid, const EnergyBalance& model, std::span<const double> latitude_deg,
               std::span<const float> land_fraction, std::span<double> heat_w_m2) {
  const int nx = grid.nx();
  ParallelErrors errors;
#pragma omp parallel
  {
    auto west = errors.make<std::vector<double>>(nx);
    auto east = errors.make<std::vector<double>>(nx);
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      if (errors.any()) continue;
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
  errors.rethrow();
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
        const double frozen = model.sea_ice_coalbedo +
                              land_fraction[here] * (model.ice_coalbedo - model.sea_ice_coalbedo);
        absorbed[here] = bare + ice * (frozen - bare);
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
  constexpr int kRounds = 12, kStepsPerRound = 10, kLastSteps = 300;
  for (int round = 0; round <= kRounds; ++round) {
    update_coefficients();
    solve_heat<double>(grid, {east, north, loss, source},
                       round < kRounds ? kStepsPerRound : kLastSteps, mean_c);
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
  constexpr int kHarmonicSteps = 300;
  solve_heat<std::complex<double>>(grid, {east, north, storing, forcing}, kHarmonicSteps,
                                   harmonic_k);
}

}  // namespace geo
