#include "geo/kernels/climate/circulation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "kernels/numerics/thomas.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

/// Latitude as the cells see it: displaced with the trough at the trough, less and less from there
/// to the pole, which stays.
double cell_latitude_deg(double latitude_deg, double trough_deg, double decay) {
  const double span = latitude_deg >= trough_deg ? 90.0 - trough_deg : 90.0 + trough_deg;
  const double to_pole = std::clamp(1.0 - std::abs(latitude_deg - trough_deg) / span, 0.0, 1.0);
  // A displacement that fell off faster would turn the order of latitudes round.
  const double steepest = (90.0 + std::abs(trough_deg)) / std::max(std::abs(trough_deg), 1e-9);
  return latitude_deg - trough_deg * std::pow(to_pole, std::min(decay, steepest));
}

double cell_rise_hpa(int cell, const Circulation& model) {
  if (cell == 0) return model.subtropical_high_hpa;
  if (cell == 1) return -model.subpolar_low_hpa;
  return cell % 2 == 0 ? model.polar_high_hpa : -model.polar_high_hpa;
}

}  // namespace

WindDirection three_cell_wind(double latitude_deg, double deflection, double blend_deg) {
  const double distance = std::abs(latitude_deg);
  const auto passed = [&](double boundary) {
    return std::clamp((distance - boundary) / blend_deg + 0.5, 0.0, 1.0);
  };
  const double westerly = passed(30.0) - passed(60.0);
  const double east = 2.0 * westerly - 1.0;
  const double poleward = deflection * std::sin(distance * kRadians) * east;
  return {east, latitude_deg >= 0.0 ? poleward : -poleward};
}

double Circulation::rotation_rad_s() const {
  return (retrograde ? -1.0 : 1.0) * 2.0 * kPi / (rotation_period_h * 3600.0);
}

double Circulation::cell_width() const {
  constexpr double kSiderealDay_h = 23.934;
  return std::sqrt(rotation_period_h / kSiderealDay_h);
}

double three_cell_pressure_hpa(double latitude_deg, const Circulation& model, double trough_deg) {
  const double seen_deg = std::min(
      std::abs(cell_latitude_deg(latitude_deg, trough_deg, model.displacement_decay)), 90.0);
  const double width_deg = std::min(90.0, 30.0 * model.cell_width());
  double pressure = 0.0;
  for (int cell = 0; cell == 0 || width_deg * cell < 90.0 - 1e-9; ++cell) {
    const double along = std::clamp((seen_deg - width_deg * cell) / width_deg, 0.0, 1.0);
    pressure += cell_rise_hpa(cell, model) * 0.5 * (1.0 - std::cos(kPi * along));
  }
  return pressure;
}

CellWinds cell_winds(const Grid& grid, const Circulation& model,
                     std::span<const double> latitude_deg, std::span<const double> pressure_hpa) {
  using Complex = std::complex<double>;
  const int ny = grid.ny();
  check_sizes("cell_winds", ny,
              {{"latitude_deg", latitude_deg.size()}, {"pressure_hpa", pressure_hpa.size()}});
  // With w = u + i v the two equations are one: (r + i f) w - r L^2 w'' = -i p' / rho.
  const double drag = model.drag_ocean_s;
  std::vector<Complex> to_south(ny), own(ny), to_north(ny), wind(ny);
  for (int j = 0; j < ny; ++j) {
    const int south = std::max(j - 1, 0), north = std::min(j + 1, ny - 1);
    const double row_m = grid.spacing_north_m(std::min(j, ny - 2));
    const double slope = 100.0 * (pressure_hpa[north] - pressure_hpa[south]) / (2.0 * row_m);
    const double rows_mixed = 1000.0 * model.cell_mixing_km / row_m;
    const double mixing = drag * rows_mixed * rows_mixed;
    const double coriolis = 2.0 * model.rotation_rad_s() * std::sin(latitude_deg[j] * kRadians);
    to_south[j] = to_north[j] = -mixing;  // no wind at the poles
    own[j] = Complex(drag + 2.0 * mixing, coriolis);
    wind[j] = Complex(0.0, -slope / model.air_density_kg_m3);
  }
  factor_tridiagonal<Complex>(to_south, to_north, own);
  solve_tridiagonal<Complex>(to_south, to_north, own, wind);
  CellWinds winds;
  for (const Complex& w : wind) {
    winds.east.push_back(w.real());
    winds.north.push_back(model.overturning_share * w.imag());
  }
  return winds;
}

void balanced_winds(const Grid& grid, const Circulation& model,
                    std::span<const double> latitude_deg, std::span<const float> land_fraction,
                    std::span<const float> pressure_hpa, std::span<float> wind_east,
                    std::span<float> wind_north) {
  check_sizes("balanced_winds", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("balanced_winds", grid.size(),
              {{"land_fraction", land_fraction.size()},
               {"pressure_hpa", pressure_hpa.size()},
               {"wind_east", wind_east.size()},
               {"wind_north", wind_north.size()}});
  const double twice_rotation_s = 2.0 * model.rotation_rad_s();
  const double push_per_slope = -100.0 / model.air_density_kg_m3;  // from hPa
  for (int j = 0; j < grid.ny(); ++j) {
    const double coriolis = twice_rotation_s * std::sin(latitude_deg[j] * kRadians);
    const double two_steps_east_m = 2.0 * grid.spacing_east_m(j);
    const auto& distances = grid.distances_m(j);
    const double two_steps_north_m = distances[kNorth] + distances[kSouth];
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      const auto pressure = [&](int k) {
        return static_cast<double>(pressure_hpa[grid.neighbour(i, j, k)]);
      };
      const double push_east =
          push_per_slope * (pressure(kEast) - pressure(kWest)) / two_steps_east_m;
      const double push_north =
          push_per_slope * (pressure(kNorth) - pressure(kSouth)) / two_steps_north_m;
      const double drag =
          model.drag_ocean_s + land_fraction[here] * (model.drag_land_s - model.drag_ocean_s);
      const double norm = 1.0 / (drag * drag + coriolis * coriolis);
      wind_east[here] = static_cast<float>((drag * push_east + coriolis * push_north) * norm);
      wind_north[here] = static_cast<float>((drag * push_north - coriolis * push_east) * norm);
    }
  }
}

}  // namespace geo
