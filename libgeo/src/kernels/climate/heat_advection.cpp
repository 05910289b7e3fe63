#include "kernels/climate/heat_advection.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/numerics/area_sum.hpp"

namespace geo {

std::complex<double> month_phase(int harmonic, int month) {
  static const auto phases = [] {
    std::array<std::complex<double>, 2 * kMonths> all;  // of half months
    for (int n = 0; n < 2 * kMonths; ++n) {
      all[n] = std::polar(1.0, 2.0 * std::numbers::pi * n / (2 * kMonths));
    }
    return all;
  }();
  return phases[harmonic * (2 * month + 1) % (2 * kMonths)];
}

HeatAdvection::HeatAdvection(const Grid& grid, double heat_j_m2_k, const HeatWinds& winds)
    : grid_(grid),
      heat_j_m2_k_(heat_j_m2_k),
      winds_(winds),
      mean_wind_m_s_(grid.ny(), 0.0),
      annual_mean_c_(grid.ny(), 0.0) {
  for (auto& heat : besides_) heat.assign(static_cast<std::size_t>(grid.size()), 0.0);
}

void HeatAdvection::find_annual_mean(const TemperatureCycle& temperature) {
  for (int j = 0; j < grid_.ny(); ++j) {
    double sum = 0.0;
    for (int i = 0; i < grid_.nx(); ++i) sum += temperature.mean_c(grid_.cell(i, j));
    annual_mean_c_[j] = sum / grid_.nx();
  }
}

HeatAdvection::Month HeatAdvection::blow(const TemperatureCycle& temperature, int month) const {
  const auto size = static_cast<std::size_t>(grid_.size());
  Month air{std::vector<float>(size), std::vector<float>(size), std::vector<float>(size), {}};
  for (std::size_t cell = 0; cell < size; ++cell) {
    air.temperature_c[cell] = static_cast<float>(temperature.month_c(cell, month));
  }
  winds_(air.temperature_c, annual_mean_c_, air.east, air.north);
  return air;
}

void HeatAdvection::average(const TemperatureCycle& temperature,
                            std::vector<double> stiffness_w_m2_k) {
  if (!winds_) return;
  stiffness_w_m2_k_ = std::move(stiffness_w_m2_k);
  find_annual_mean(temperature);
  std::array<std::vector<double>, kMonths> zonal;
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) {
    errors.guard([&] {
      const Month air = blow(temperature, m);
      zonal[m].assign(grid_.ny(), 0.0);
      for (int j = 0; j < grid_.ny(); ++j) {
        for (int i = 0; i < grid_.nx(); ++i) zonal[m][j] += air.east[grid_.cell(i, j)] / grid_.nx();
      }
    });
  }
  errors.rethrow();
  for (int j = 0; j < grid_.ny(); ++j) {
    double sum = 0.0;
    for (const auto& month : zonal) sum += month[j];
    mean_wind_m_s_[j] = sum / kMonths;
  }
}

/// -F (u . grad T) upwind, less what the mean wind carries, less its own mean over the planet.
void HeatAdvection::carry(Month& month) const {
  constexpr double kMostOfStiffness = 0.2;
  month.heat_w_m2.resize(month.temperature_c.size());
  for (int j = 0; j < grid_.ny(); ++j) {
    const double per_east = heat_j_m2_k_ / grid_.spacing_east_m(j);
    const double per_north = heat_j_m2_k_ / grid_.spacing_north_m(j);
    for (int i = 0; i < grid_.nx(); ++i) {
      const Index here = grid_.cell(i, j);
      const double own = month.temperature_c[here];
      const auto carried = [&](double wind, int behind, int ahead) {
        const Index upwind = grid_.neighbour(i, j, wind > 0.0 ? behind : ahead);
        return std::abs(wind) * (month.temperature_c[upwind] - own);
      };
      const double exchange_w_m2_k =
          per_east * (std::abs(month.east[here]) + std::abs(mean_wind_m_s_[j])) +
          per_north * std::abs(month.north[here]);
      const double most_w_m2_k = kMostOfStiffness * stiffness_w_m2_k_[here];
      const double held = exchange_w_m2_k > most_w_m2_k ? most_w_m2_k / exchange_w_m2_k : 1.0;
      month.heat_w_m2[here] =
          static_cast<float>(held * (per_east * (carried(month.east[here], kWest, kEast) -
                                                 carried(mean_wind_m_s_[j], kWest, kEast)) +
                                     per_north * carried(month.north[here], kSouth, kNorth)));
    }
  }
  const double mean_w_m2 =
      area_sum<double>(grid_, [&](Index cell) -> double { return month.heat_w_m2[cell]; }) /
      grid_.total_area_m2();
  for (float& heat : month.heat_w_m2) heat -= static_cast<float>(mean_w_m2);
}

void HeatAdvection::advance(const TemperatureCycle& temperature) {
  if (!winds_) return;
  find_annual_mean(temperature);
  std::array<Month, kMonths> months;
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) {
    errors.guard([&] {
      months[m] = blow(temperature, m);
      carry(months[m]);
    });
  }
  errors.rethrow();
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid_.ny(); ++j) {
    const double area_m2 = grid_.area_m2(j);
    for (Index cell = grid_.cell(0, j); cell < grid_.cell(0, j) + grid_.nx(); ++cell) {
      for (int k = 0; k <= TemperatureCycle::kHarmonics; ++k) {
        Complex sum = 0.0;
        for (int m = 0; m < kMonths; ++m) {
          sum += static_cast<double>(months[m].heat_w_m2[cell]) * std::conj(month_phase(k, m));
        }
        sum *= (k == 0 ? 1.0 : 2.0) / kMonths * area_m2;
        besides_[k][cell] += 0.5 * (sum - besides_[k][cell]);
      }
    }
  }
}

}  // namespace geo
