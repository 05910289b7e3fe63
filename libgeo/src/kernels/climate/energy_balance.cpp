#include "geo/kernels/climate/energy_balance.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/ocean_heat.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "kernels/climate/heat_advection.hpp"
#include "kernels/climate/ring_equations.hpp"

namespace geo {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;
constexpr int kHarmonics = TemperatureCycle::kHarmonics;
constexpr double kMelting_c = -1.0;  // of a month over ice that is melting

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
  [[nodiscard]] RingEquations equations(std::span<const double> diffusivity_w_m2_k,
                                        std::span<const Complex> loss) const {
    const double radius2 = grid_.figure().radius_m * grid_.figure().radius_m;
    RingEquations result(grid_);
    for (int j = 0; j < grid_.ny(); ++j) {
      const double per_east = radius2 * grid_.face_east_m(j) / grid_.spacing_east_m(j);
      const double per_north = radius2 * grid_.face_north_m(j) / grid_.spacing_north_m(j);
      const bool pole = grid_.topology() == Topology::sphere && j == grid_.ny() - 1;
      for (int i = 0; i < grid_.nx(); ++i) {
        const Index here = grid_.cell(i, j);
        const auto mean = [&](Index there) {
          return 0.5 * (diffusivity_w_m2_k[here] + diffusivity_w_m2_k[there]);
        };
        result.add_own(here, loss[here]);
        const double to_east = per_east * mean(grid_.neighbour(i, j, kEast));
        result.add_exchange(i, j, kEast, to_east);
        result.add_exchange((i + 1) % grid_.nx(), j, kWest, to_east);
        if (!pole) {
          const double to_north = per_north * mean(grid_.neighbour(i, j, kNorth));
          result.add_exchange(i, j, kNorth, to_north);
          result.add_exchange(i, (j + 1) % grid_.ny(), kSouth, to_north);
        }
        const double wind = carried_w_k_[j];
        result.add_exchange(i, j, wind > 0.0 ? kWest : kEast, std::abs(wind));
      }
    }
    return result;
  }

 private:
  const Grid& grid_;
  std::vector<double> carried_w_k_;
};

/// One harmonic's system.
class HarmonicSolver {
 public:
  void factor(RingEquations equations) {
    equations_ = std::move(equations);
    solver_.setMaxIterations(500);
    solver_.compute(equations_);
  }
  /// Improves `temperature` until the equations hold to a share of their right-hand sides.
  void solve(std::span<const Complex> source, double tolerance, std::span<Complex> temperature) {
    RingEquations::Vector right, guess;
    equations_.gather(source, right);
    equations_.gather(temperature, guess);
    solver_.setTolerance(tolerance);
    const RingEquations::Vector solution = solver_.solveWithGuess(right, guess);
    if (solver_.info() != Eigen::Success) throw Bug("energy balance: the solver does not converge");
    equations_.scatter(solution, temperature);
  }

 private:
  RingEquations equations_;
  Eigen::BiCGSTAB<RingEquations, ZebraRows> solver_;
};

/// Albedo, heat capacity and diffusivity as the temperatures have them.
class Surface {
 public:
  using Months = std::array<double, kMonths>;
  Surface(const Grid& grid, const EnergyBalance& model, std::span<const double> latitude_deg,
          std::span<const float> land_fraction, std::span<const float> height_m,
          std::span<const float> glacier_fraction)
      : grid_(grid),
        model_(model),
        land_(land_fraction),
        height_m_(height_m),
        glacier_(glacier_fraction),
        channel_(open_channels(grid, latitude_deg, land_fraction)) {
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

  /// Sunlight that a cell absorbs in each month, less what melts its ice, and what that gives back.
  [[nodiscard]] Months absorbed_w_m2(const TemperatureCycle& temperature, Index cell) const {
    const int row = grid_.row(cell);
    Months air_c{}, ground_c{}, absorbed{};
    for (int m = 0; m < kMonths; ++m) {
      air_c[m] = temperature.month_c(cell, m);
      ground_c[m] = air_c[m] - model_.lapse_k_m * height_m_[cell];
    }
    // Snow that outlasts the warmest month becomes ice.
    const double warmest_c = *std::max_element(ground_c.begin(), ground_c.end());
    const double stays = frozen_share(warmest_c, 0.0, model_.ice_width_k);
    const auto unless_it_stays = [&](double coalbedo) {
      return coalbedo + stays * (model_.ice_coalbedo - coalbedo);
    };
    const double land = land_[cell], bare = bare_[row];
    const double glacier = glacier_.empty() ? 0.0 : glacier_[cell];
    const double icy = unless_it_stays(model_.glacier_coalbedo);
    const double treeless = frozen_share(warmest_c, model_.tree_temperature_c, model_.ice_width_k);
    const double snowy = unless_it_stays(std::min(
        bare,
        model_.snow_coalbedo + treeless * (model_.open_snow_coalbedo - model_.snow_coalbedo)));
    const double sea_ice_here = sea_ice(temperature.mean_c(cell));
    const double sea = bare + sea_ice_here * (std::min(bare, model_.sea_ice_coalbedo) - bare);
    Months frozen{};
    for (int m = 0; m < kMonths; ++m) {
      frozen[m] = frozen_share(ground_c[m], 0.0, model_.ice_width_k);
      const double snow =
          std::max(stays, frozen_share(ground_c[m], model_.snow_temperature_c, model_.ice_width_k));
      const double ground = (1.0 - glacier) * (bare + snow * (snowy - bare)) + glacier * icy;
      absorbed[m] = insolation_[row][m] * (land * ground + (1.0 - land) * sea);
    }
    freeze(land * (1.0 - glacier), frozen, absorbed);
    melt_and_freeze((1.0 - land) * sea_ice_here, air_c, absorbed);
    melt_and_freeze(land * glacier, ground_c, absorbed);
    return absorbed;
  }

  /// Sea ice cuts the air off from the water's heat, but melts.
  [[nodiscard]] double sea_capacity_w_yr_m2_k(double annual_mean_c) const {
    return model_.ocean_heat_capacity_w_yr_m2_k +
           sea_ice(annual_mean_c) *
               (model_.ice_heat_capacity_w_yr_m2_k - model_.ocean_heat_capacity_w_yr_m2_k);
  }

  /// How the sea answers one harmonic of the year through its exchange with the air, C dT_s/dt =
  /// Q_s + g (T - T_s): what takes the place of i omega C in the air's equation, and the share of
  /// the source that reaches the air.
  struct Answer {
    Complex loss_w_m2_k, share;
  };
  [[nodiscard]] Answer answer(int k, double annual_mean_c, Index cell) const {
    const Complex land_loss(0.0, 2.0 * kPi * k * model_.land_heat_capacity_w_yr_m2_k);
    const Complex sea_loss(0.0, 2.0 * kPi * k * sea_capacity_w_yr_m2_k(annual_mean_c));
    const double land = land_[cell], exchange = sea_exchange_w_m2_k(model_, annual_mean_c);
    const Complex passed = exchange / (exchange + sea_loss);
    return {
        land * land_loss + (1.0 - land) * sea_loss * passed,
        land + (1.0 - land) * (model_.sunlit_air_share + (1.0 - model_.sunlit_air_share) * passed)};
  }

  [[nodiscard]] double diffusivity_w_m2_k(double annual_mean_c, Index cell) const {
    const auto moist = [&](double temperature_c) {
      return 1.0 + model_.moist_transport * latent_to_sensible_slope(temperature_c);
    };
    const double in_channel = (1.0 - land_[cell]) * channel_[grid_.row(cell)];
    return model_.diffusivity_w_m2_k * (1.0 - model_.channel_share * in_channel) *
           open_to_heat(model_, height_m_[cell]) * moist(annual_mean_c) / moist(15.0);
  }

 private:
  /// Ground, a share of the cell, gives heat as its water freezes in autumn, and takes it in
  /// spring.
  void freeze(double ground, const Months& frozen, Months& absorbed_w_m2) const {
    for (int m = 0; m < kMonths; ++m) {
      const double growth_1_yr =
          0.5 * kMonths * (frozen[(m + 1) % kMonths] - frozen[(m + kMonths - 1) % kMonths]);
      absorbed_w_m2[m] += ground * model_.freezing_heat_w_yr_m2 * growth_1_yr;
    }
  }

  /// What ice, a share of the cell, takes as it melts in summer it gives as it freezes in winter,
  /// most in the coldest months.
  void melt_and_freeze(double ice, const Months& temperature_c, Months& absorbed_w_m2) const {
    if (ice <= 0.0) return;
    double melted_w_m2 = 0.0, frost_k = 0.0;
    for (int m = 0; m < kMonths; ++m) {
      const double warmer_k = temperature_c[m] - kMelting_c;
      const double melt_w_m2 = ice * model_.melt_w_m2_k * std::max(0.0, warmer_k);
      absorbed_w_m2[m] -= melt_w_m2;
      melted_w_m2 += melt_w_m2;
      frost_k += std::max(0.0, -warmer_k);
    }
    for (int m = 0; m < kMonths && frost_k > 0.0; ++m) {
      absorbed_w_m2[m] += melted_w_m2 * std::max(0.0, kMelting_c - temperature_c[m]) / frost_k;
    }
  }

  const Grid& grid_;
  const EnergyBalance& model_;
  std::span<const float> land_, height_m_, glacier_;
  std::vector<double> channel_;
  std::vector<Months> insolation_;
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

double open_to_heat(const EnergyBalance& model, double height_m) {
  const double relative = height_m / model.blocking_height_m;
  return 1.0 / (1.0 + relative * relative);
}

double sea_exchange_w_m2_k(const EnergyBalance& model, double annual_mean_c) {
  const auto moist = [](double temperature_c) {
    return 1.0 + latent_to_sensible_slope(temperature_c);
  };
  return model.sea_exchange_w_m2_k * moist(annual_mean_c) / moist(15.0);
}

double dry_sea_exchange_w_m2_k(const EnergyBalance& model) {
  return model.sea_exchange_w_m2_k / (1.0 + latent_to_sensible_slope(15.0));
}

double sea_ice_share(const EnergyBalance& model, double annual_mean_c) {
  return frozen_share(annual_mean_c, model.ice_temperature_c, model.ice_width_k);
}

namespace {

/// The temperatures that are sought, and what is known of their heat.
class PeriodicYear {
 public:
  PeriodicYear(const Grid& grid, const EnergyBalance& model, bool retrograde,
               std::span<const double> latitude_deg, std::span<const float> land_fraction,
               std::span<const float> height_m, HeatWinds winds,
               std::span<const float> glacier_fraction)
      : grid_(grid),
        model_(model),
        retrograde_(retrograde),
        latitude_deg_(latitude_deg),
        land_(land_fraction),
        winds_(std::move(winds)),
        size_(static_cast<std::size_t>(grid.size())),
        surface_(grid, model, latitude_deg, land_fraction, height_m, glacier_fraction),
        advection_(grid, model.advected_heat_j_m2_k, winds_),
        ocean_(size_),
        diffusivity_(size_),
        temperature_(size_) {
    ocean_heat(grid, model, retrograde, latitude_deg, land_fraction, ocean_);
    for (std::size_t cell = 0; cell < size_; ++cell) {
      const double sine = std::sin(latitude_deg[grid.row(static_cast<Index>(cell))] * kRadians);
      temperature_.harmonic(0)[cell] = 27.0 - 40.0 * sine * sine;
    }
    for (auto& source : sources_) source.resize(size_);
    for (auto& answers : answers_) answers.resize(size_);
  }

  /// Snow, ice, winds and moist transport follow the temperature; factors are kept while they still
  /// do.
  void solve() {
    constexpr int kRounds = 14, kFactorRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      const bool refactor = round < kFactorRounds;
      if (refactor) take_coefficients();
      gather_sources(round > 0);
      if (round > 0) advection_.advance(temperature_);
      solve_harmonics(refactor, round + 1 == kRounds);
    }
  }

  void upwell(std::span<const double> equatorial_wind_m_s) {
    constexpr int kRounds = 6;
    const std::vector<double> before = ocean_;
    ocean_heat(grid_, model_, retrograde_, latitude_deg_, land_, ocean_, equatorial_wind_m_s);
    for (std::size_t cell = 0; cell < size_; ++cell) {
      sources_[0][cell] +=
          grid_.area_m2(grid_.row(static_cast<Index>(cell))) * (ocean_[cell] - before[cell]);
    }
    for (int round = 0; round < kRounds; ++round) {
      if (round > 0) {
        gather_sources(true);
        advection_.advance(temperature_);
      }
      solve_harmonics(false, round + 1 == kRounds);
    }
  }

  [[nodiscard]] const TemperatureCycle& temperature() const { return temperature_; }

 private:
  void solve_harmonics(bool refactor, bool last) {
    constexpr double kNear = 1e-4, kClosed = 1e-7;
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k <= kHarmonics; ++k) {
      errors.guard([&] {
        if (refactor) factor(k);
        solve(k, last ? kClosed : kNear);
      });
    }
    errors.rethrow();
  }

  void take_coefficients() {
    for (std::size_t cell = 0; cell < size_; ++cell) {
      diffusivity_[cell] =
          surface_.diffusivity_w_m2_k(temperature_.mean_c(cell), static_cast<Index>(cell));
      for (int k = 0; k <= kHarmonics; ++k) {
        answers_[k][cell] = surface_.answer(k, temperature_.mean_c(cell), static_cast<Index>(cell));
      }
    }
    advection_.average(temperature_, stiffness_w_m2_k());
  }

  /// How fast diffusion and radiation level a departure of one cell, W m-2 K-1.
  [[nodiscard]] std::vector<double> stiffness_w_m2_k() const {
    std::vector<double> stiffness(size_);
    const double radius2 = grid_.figure().radius_m * grid_.figure().radius_m;
    for (std::size_t cell = 0; cell < size_; ++cell) {
      const int row = grid_.row(static_cast<Index>(cell));
      const double per_east = 2.0 * grid_.face_east_m(row) / grid_.spacing_east_m(row);
      const double per_north = 2.0 * grid_.face_north_m(row) / grid_.spacing_north_m(row);
      stiffness[cell] = model_.outgoing_slope_w_m2_k +
                        radius2 / grid_.area_m2(row) * (per_east + per_north) * diffusivity_[cell];
    }
    return stiffness;
  }

  void gather_sources(bool started) {
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      for (Index cell = grid_.cell(0, j); cell < grid_.cell(0, j) + grid_.nx(); ++cell) {
        const auto absorbed = surface_.absorbed_w_m2(temperature_, cell);
        for (int k = 0; k <= kHarmonics; ++k) {
          Complex sum = 0.0;
          for (int m = 0; m < kMonths; ++m) sum += absorbed[m] * std::conj(month_phase(k, m));
          sum *= (k == 0 ? 1.0 : 2.0) / kMonths;
          sum *= answers_[k][cell].share;
          if (k == 0) sum += ocean_[cell] - model_.outgoing_w_m2;
          sum *= grid_.area_m2(j);
          // Half-way, so that snow, ice and melting settle.
          sources_[k][cell] += (started ? 0.5 : 1.0) * (sum - sources_[k][cell]);
        }
      }
    }
  }

  void factor(int k) {
    std::vector<Complex> loss(size_);
    for (std::size_t cell = 0; cell < size_; ++cell) {
      loss[cell] = (model_.outgoing_slope_w_m2_k + answers_[k][cell].loss_w_m2_k) *
                   grid_.area_m2(grid_.row(static_cast<Index>(cell)));
    }
    const HeatOperator heat(grid_, model_.advected_heat_j_m2_k, advection_.mean_wind_m_s());
    solvers_[k].factor(heat.equations(diffusivity_, loss));
  }

  void solve(int k, double tolerance) {
    std::vector<Complex> all = sources_[k];
    const auto carried = advection_.besides(k);
    for (std::size_t cell = 0; cell < size_; ++cell) all[cell] += carried[cell];
    solvers_[k].solve(all, tolerance, temperature_.harmonic(k));
  }

  const Grid& grid_;
  const EnergyBalance& model_;
  bool retrograde_;
  std::span<const double> latitude_deg_;
  std::span<const float> land_;
  HeatWinds winds_;
  std::size_t size_;
  Surface surface_;
  HeatAdvection advection_;
  std::vector<double> ocean_, diffusivity_;
  std::array<std::vector<Surface::Answer>, kHarmonics + 1> answers_;
  TemperatureCycle temperature_;
  std::array<HarmonicSolver, kHarmonics + 1> solvers_;
  std::array<std::vector<Complex>, kHarmonics + 1> sources_;
};

}  // namespace

class EnergyBalanceYear::Solver : public PeriodicYear {
  using PeriodicYear::PeriodicYear;
};

EnergyBalanceYear::EnergyBalanceYear(const Grid& grid, const EnergyBalance& model, bool retrograde,
                                     std::span<const double> latitude_deg,
                                     std::span<const float> land_fraction,
                                     std::span<const float> height_m, HeatWinds winds,
                                     std::span<const float> glacier_fraction) {
  check_sizes("solve_energy_balance", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("solve_energy_balance", grid.size(),
              {{"land_fraction", land_fraction.size()},
               {"height_m", height_m.size()},
               {"glacier_fraction", glacier_fraction.size(), ArraySize::May::be_empty}});
  solver_ = std::make_unique<Solver>(grid, model, retrograde, latitude_deg, land_fraction, height_m,
                                     std::move(winds), glacier_fraction);
  solver_->solve();
}

EnergyBalanceYear::EnergyBalanceYear(EnergyBalanceYear&&) noexcept = default;
EnergyBalanceYear::~EnergyBalanceYear() = default;

const TemperatureCycle& EnergyBalanceYear::temperature() const { return solver_->temperature(); }

void EnergyBalanceYear::upwell(std::span<const double> equatorial_wind_m_s) {
  solver_->upwell(equatorial_wind_m_s);
}

TemperatureCycle solve_energy_balance(const Grid& grid, const EnergyBalance& model, bool retrograde,
                                      std::span<const double> latitude_deg,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m, const HeatWinds& winds,
                                      std::span<const float> glacier_fraction) {
  return EnergyBalanceYear(grid, model, retrograde, latitude_deg, land_fraction, height_m, winds,
                           glacier_fraction)
      .temperature();
}

}  // namespace geo
