#include "geo/kernels/climate/energy_balance.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "kernels/climate/row_preconditioner.hpp"

namespace geo {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;
constexpr double kSecondsPerYear = 365.25 * 86400.0;
constexpr int kHarmonics = TemperatureCycle::kHarmonics;
constexpr double kMelting_c = -1.0;  // of a month on ice that is melting

/// e^(2 pi i k t) in the middle of a month.
Complex month_phase(int harmonic, int month) {
  static const auto phases = [] {
    std::array<Complex, 2 * kMonths> all;  // of half months
    for (int n = 0; n < 2 * kMonths; ++n) all[n] = std::polar(1.0, 2.0 * kPi * n / (2 * kMonths));
    return all;
  }();
  return phases[harmonic * (2 * month + 1) % (2 * kMonths)];
}

/// Rises from 0 to 1 as a temperature falls below a limit; 0 without a width.
double frozen_share(double temperature_c, double limit_c, double width_k) {
  return width_k > 0.0 ? 1.0 / (1.0 + std::exp((temperature_c - limit_c) / width_k)) : 0.0;
}

/// Heat that leaves a cell for its neighbours, and the equations of one harmonic.
class HeatOperator {
 public:
  HeatOperator(const Grid& grid, double advected_heat_j_m2_k,
               std::span<const double> zonal_wind_m_s)
      : grid_(grid), carried_w_k_(grid.ny()) {
    if (grid.topology() == Topology::plane) throw Bug("energy balance: the grid has edges");
    for (int j = 0; j < grid.ny(); ++j) {
      carried_w_k_[j] =
          advected_heat_j_m2_k * zonal_wind_m_s[j] / grid.spacing_east_m(j) * grid.area_m2(j);
    }
  }

  /// (loss + conductances + wind) T = source, loss in W K-1 per cell.
  [[nodiscard]] RowPreconditioner::Matrix matrix(std::span<const double> diffusivity_w_m2_k,
                                                 std::span<const Complex> loss) const {
    const double radius2 = grid_.figure().radius_m * grid_.figure().radius_m;
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(loss.size() * 9);
    const auto exchange = [&](Index here, Index there, double w_k) {
      entries.emplace_back(here, here, w_k);
      entries.emplace_back(there, there, w_k);
      entries.emplace_back(here, there, -w_k);
      entries.emplace_back(there, here, -w_k);
    };
    for (int j = 0; j < grid_.ny(); ++j) {
      const double per_east = radius2 * grid_.face_east_m(j) / grid_.spacing_east_m(j);
      const double per_north = radius2 * grid_.face_north_m(j) / grid_.spacing_north_m(j);
      const bool pole = grid_.topology() == Topology::sphere && j == grid_.ny() - 1;
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index here = grid_.cell(i, j), east = grid_.neighbour(i, j, kEast);
        const auto mean = [&](Index there) {
          return 0.5 * (diffusivity_w_m2_k[here] + diffusivity_w_m2_k[there]);
        };
        entries.emplace_back(here, here, loss[here]);
        exchange(here, east, per_east * mean(east));
        if (!pole) {
          const Index north = grid_.neighbour(i, j, kNorth);
          exchange(here, north, per_north * mean(north));
        }
        const double wind = carried_w_k_[j];
        const Index upwind = wind > 0.0 ? grid_.neighbour(i, j, kWest) : east;
        entries.emplace_back(here, here, std::abs(wind));
        entries.emplace_back(here, upwind, -std::abs(wind));
      }
    }
    const auto size = static_cast<Eigen::Index>(loss.size());
    RowPreconditioner::Matrix result(size, size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

 private:
  const Grid& grid_;
  std::vector<double> carried_w_k_;
};

/// One harmonic's system.
class HarmonicSolver {
 public:
  void factor(RowPreconditioner::Matrix matrix, int nx) {
    matrix_ = std::move(matrix);
    solver_.preconditioner().set_row_length(nx);
    solver_.setMaxIterations(500);
    solver_.compute(matrix_);
  }
  /// Improves `temperature` until the equations hold to a share of their right-hand sides.
  void solve(std::span<const Complex> source, double tolerance, std::span<Complex> temperature) {
    const auto size = static_cast<Eigen::Index>(source.size());
    const Eigen::VectorXcd right = Eigen::Map<const Eigen::VectorXcd>(source.data(), size);
    Eigen::Map<Eigen::VectorXcd> unknown(temperature.data(), size);
    solver_.setTolerance(tolerance);
    const Eigen::VectorXcd solution = solver_.solveWithGuess(right, unknown);
    if (solver_.info() != Eigen::Success) throw Bug("energy balance: the solver does not converge");
    unknown = solution;
  }

 private:
  RowPreconditioner::Matrix matrix_;
  Eigen::BiCGSTAB<RowPreconditioner::Matrix, RowPreconditioner> solver_;
};

/// Albedo, heat capacity and diffusivity as the temperatures have them.
class Surface {
 public:
  Surface(const Grid& grid, const EnergyBalance& model, std::span<const double> latitude_deg,
          std::span<const float> land_fraction, std::span<const float> height_m)
      : grid_(grid), model_(model), land_(land_fraction), height_m_(height_m) {
    for (int j = 0; j < grid.ny(); ++j) {
      insolation_.push_back(
          monthly_insolation_w_m2(latitude_deg[j], model.orbit, model.solar_constant_w_m2));
      const double sine = std::sin(latitude_deg[j] * kRadians);
      bare_.push_back(std::clamp(
          model.coalbedo + model.coalbedo_p2 * 0.5 * (3.0 * sine * sine - 1.0), 0.0, 1.0));
    }
  }

  [[nodiscard]] double sea_ice(double annual_mean_c) const {
    return sea_ice_share(model_, annual_mean_c);
  }

  /// Sunlight that a cell absorbs in each month, less what melts its sea ice.
  [[nodiscard]] std::array<double, kMonths> absorbed_w_m2(const TemperatureCycle& temperature,
                                                          Index cell) const {
    const int row = grid_.row(cell);
    std::array<double, kMonths> ground_c{}, absorbed{};
    for (int m = 0; m < kMonths; ++m) {
      ground_c[m] = temperature.month_c(cell, m) - model_.lapse_k_m * height_m_[cell];
    }
    // Snow that outlasts the warmest month becomes ice.
    const double warmest_c = *std::max_element(ground_c.begin(), ground_c.end());
    const double ice = frozen_share(warmest_c, 0.0, model_.ice_width_k);
    const double land = land_[cell], bare = bare_[row];
    const double snowy = model_.snow_coalbedo + ice * (model_.ice_coalbedo - model_.snow_coalbedo);
    const double sea = bare + sea_ice(temperature.mean_c(cell)) * (model_.sea_ice_coalbedo - bare);
    const double melting = (1.0 - land) * sea_ice(temperature.mean_c(cell)) * model_.melt_w_m2_k;
    for (int m = 0; m < kMonths; ++m) {
      const double snow =
          std::max(ice, frozen_share(ground_c[m], model_.snow_temperature_c, model_.ice_width_k));
      const double share = land * (bare + snow * (snowy - bare)) + (1.0 - land) * sea;
      absorbed[m] = insolation_[row][m] * share -
                    melting * std::max(0.0, temperature.month_c(cell, m) - kMelting_c);
    }
    return absorbed;
  }

  /// Sea ice cuts the air off from the water's heat, but melts.
  [[nodiscard]] double capacity_w_yr_m2_k(double annual_mean_c, Index cell) const {
    const double ice = sea_ice(annual_mean_c);
    const double sea =
        model_.ocean_heat_capacity_w_yr_m2_k +
        ice * (model_.ice_heat_capacity_w_yr_m2_k - model_.ocean_heat_capacity_w_yr_m2_k);
    return land_[cell] * model_.land_heat_capacity_w_yr_m2_k + (1.0 - land_[cell]) * sea;
  }

  [[nodiscard]] double diffusivity_w_m2_k(double annual_mean_c) const {
    const auto moist = [&](double temperature_c) {
      return 1.0 + model_.moist_transport * latent_to_sensible_slope(temperature_c);
    };
    return model_.diffusivity_w_m2_k * moist(annual_mean_c) / moist(15.0);
  }

 private:
  const Grid& grid_;
  const EnergyBalance& model_;
  std::span<const float> land_, height_m_;
  std::vector<std::array<double, kMonths>> insolation_;
  std::vector<double> bare_;
};

}  // namespace

double TemperatureCycle::month_c(std::size_t cell, int month) const {
  double sum = harmonics_[0][cell].real();
  for (int k = 1; k <= kHarmonics; ++k) {
    sum += (harmonics_[k][cell] * month_phase(k, month)).real();
  }
  return sum;
}

double sea_ice_share(const EnergyBalance& model, double annual_mean_c) {
  return frozen_share(annual_mean_c, model.ice_temperature_c, model.ice_width_k);
}

void gyre_heat(const Grid& grid, const EnergyBalance& model, bool retrograde,
               std::span<const double> latitude_deg, std::span<const float> land_fraction,
               std::span<double> heat_w_m2) {
  check_sizes("gyre_heat", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("gyre_heat", grid.size(),
              {{"land_fraction", land_fraction.size()}, {"heat_w_m2", heat_w_m2.size()}});
  const int nx = grid.nx();
  std::vector<double> west(nx), east(nx);
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
    const double gyre = (retrograde ? -1.0 : 1.0) * model.gyre_heat_w_m2 *
                        std::cos(2.0 * latitude_deg[j] * kRadians);
    for (int i = 0; i < nx; ++i) {
      heat_w_m2[grid.cell(i, j)] = gyre * (west[i] - east[i]) * (1.0 - land(i));
    }
  }
}

TemperatureCycle solve_energy_balance(const Grid& grid, const EnergyBalance& model, bool retrograde,
                                      std::span<const double> latitude_deg,
                                      std::span<const double> zonal_wind_m_s,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m) {
  check_sizes("solve_energy_balance", grid.ny(),
              {{"latitude_deg", latitude_deg.size()}, {"zonal_wind_m_s", zonal_wind_m_s.size()}});
  check_sizes("solve_energy_balance", grid.size(),
              {{"land_fraction", land_fraction.size()}, {"height_m", height_m.size()}});
  const auto size = static_cast<std::size_t>(grid.size());
  const HeatOperator heat(grid, model.advected_heat_j_m2_k, zonal_wind_m_s);
  const Surface surface(grid, model, latitude_deg, land_fraction, height_m);
  std::vector<double> gyres(size), diffusivity(size), capacity(size);
  gyre_heat(grid, model, retrograde, latitude_deg, land_fraction, gyres);
  TemperatureCycle temperature(size);
  for (std::size_t cell = 0; cell < size; ++cell) {
    const double sine = std::sin(latitude_deg[grid.row(static_cast<Index>(cell))] * kRadians);
    temperature.harmonic(0)[cell] = 27.0 - 40.0 * sine * sine;
  }
  std::array<HarmonicSolver, kHarmonics + 1> solvers;
  std::array<std::vector<Complex>, kHarmonics + 1> sources;
  for (auto& source : sources) source.resize(size);
  ParallelErrors errors;

  const auto gather_sources = [&](bool started) {
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
        const auto absorbed = surface.absorbed_w_m2(temperature, cell);
        for (int k = 0; k <= kHarmonics; ++k) {
          Complex sum = 0.0;
          for (int m = 0; m < kMonths; ++m) sum += absorbed[m] * std::conj(month_phase(k, m));
          sum *= (k == 0 ? 1.0 : 2.0) / kMonths;
          if (k == 0) sum += gyres[cell] - model.outgoing_w_m2;
          sum *= grid.area_m2(j);
          // Half-way, so that snow, ice and melting settle.
          sources[k][cell] += (started ? 0.5 : 1.0) * (sum - sources[k][cell]);
        }
      }
    }
  };
  const auto factor = [&](int k) {
    std::vector<Complex> loss(size);
    for (std::size_t cell = 0; cell < size; ++cell) {
      loss[cell] = Complex(model.outgoing_slope_w_m2_k, 2.0 * kPi * k * capacity[cell]) *
                   grid.area_m2(grid.row(static_cast<Index>(cell)));
    }
    solvers[k].factor(heat.matrix(diffusivity, loss), grid.nx());
  };

  // Snow and ice and moist transport follow the temperature; factors are kept while they still do.
  constexpr int kRounds = 14, kFactorRounds = 3;
  constexpr double kNear = 1e-3, kClosed = 1e-6;
  for (int round = 0; round < kRounds; ++round) {
    if (round < kFactorRounds) {
      for (std::size_t cell = 0; cell < size; ++cell) {
        diffusivity[cell] = surface.diffusivity_w_m2_k(temperature.mean_c(cell));
        capacity[cell] =
            surface.capacity_w_yr_m2_k(temperature.mean_c(cell), static_cast<Index>(cell));
      }
    }
    gather_sources(round > 0);
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k <= kHarmonics; ++k) {
      errors.guard([&] {
        if (round < kFactorRounds) factor(k);
        solvers[k].solve(sources[k], round + 1 < kRounds ? kNear : kClosed,
                         temperature.harmonic(k));
      });
    }
    errors.rethrow();
  }
  return temperature;
}

}  // namespace geo
