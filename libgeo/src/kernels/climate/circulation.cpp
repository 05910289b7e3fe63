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

double hadley_edge_deg(const Circulation& model) {
  return std::min(90.0, 30.0 * model.cell_width());
}

/// Latitude as the cells see it: displaced with the trough at the trough, less and less from there
/// to the pole, which stays.
double cell_latitude_deg(double latitude_deg, double trough_deg, double decay) {
  const double span = latitude_deg >= trough_deg ? 90.0 - trough_deg : 90.0 + trough_deg;
  const double to_pole = std::clamp(1.0 - std::abs(latitude_deg - trough_deg) / span, 0.0, 1.0);
  // A displacement that fell off faster would turn the order of latitudes round.
  const double steepest = (90.0 + std::abs(trough_deg)) / std::max(std::abs(trough_deg), 1e-9);
  return latitude_deg - trough_deg * std::pow(to_pole, std::min(decay, steepest));
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

double hadley_pressure_hpa(double latitude_deg, const Circulation& model, double trough_deg) {
  const double seen_deg =
      std::abs(cell_latitude_deg(latitude_deg, trough_deg, model.displacement_decay));
  const double along = std::min(seen_deg / hadley_edge_deg(model), 1.0);
  return model.subtropical_high_hpa * 0.5 * (1.0 - std::cos(kPi * along));
}

std::vector<double> eddy_driven_wind_m_s(const Grid& grid, const Circulation& model,
                                         std::span<const double> latitude_deg,
                                         std::span<const double> zonal_temperature_c,
                                         std::span<const double> roughness) {
  constexpr double kEddy_deg = 8.0, kReference_k_m = 5.0e-6, kStable_c = 10.0;
  const int ny = grid.ny();
  check_sizes("eddy_driven_wind_m_s", ny,
              {{"latitude_deg", latitude_deg.size()},
               {"zonal_temperature_c", zonal_temperature_c.size()},
               {"roughness", roughness.size()}});
  const int reach = std::max(1, static_cast<int>(std::lround(kEddy_deg / 180.0 * ny)));
  const double turning = model.rotation_rad_s() / Circulation{}.rotation_rad_s();
  const double row_deg = 180.0 / ny;
  const double edge_deg = hadley_edge_deg(model);
  const double rows_spread = model.cell_width() * model.eddy_reach_deg / row_deg;
  std::vector<double> source(ny), to_south(ny, 0.0), own(ny, 1.0), to_north(ny, 0.0);
  for (int j = 0; j < ny; ++j) {
    const int south = std::max(j - reach, 0), north = std::min(j + reach, ny - 1);
    const double across_m = (north - south) * grid.spacing_north_m(0);
    const double slope_k_m =
        std::abs(zonal_temperature_c[north] - zonal_temperature_c[south]) / across_m;
    source[j] = std::pow(std::min(std::abs(latitude_deg[j]) / edge_deg, 1.0), 4) *
                std::abs(turning * std::sin(latitude_deg[j] * kRadians)) * slope_k_m /
                kReference_k_m *
                std::exp(model.stability_1_k * std::min(zonal_temperature_c[j] - kStable_c, 0.0));
    const auto arm2 = [](double at_deg) { return std::pow(std::cos(at_deg * kRadians), 2); };
    const double spread = rows_spread * rows_spread / arm2(latitude_deg[j]);
    if (j > 0) to_south[j] = -spread * arm2(latitude_deg[j] - 0.5 * row_deg);
    if (j + 1 < ny) to_north[j] = -spread * arm2(latitude_deg[j] + 0.5 * row_deg);
    own[j] -= to_south[j] + to_north[j];
  }
  std::vector<double> breaking = source;
  factor_tridiagonal<double>(to_south, to_north, own);
  solve_tridiagonal<double>(to_south, to_north, own, breaking);
  std::vector<double> wind_m_s(ny);
  const double along = model.retrograde ? -model.eddy_wind_m_s : model.eddy_wind_m_s;
  for (int j = 0; j < ny; ++j) wind_m_s[j] = along * (source[j] - breaking[j]) / roughness[j];
  return wind_m_s;
}

CellWinds cell_winds(const Grid& grid, const Circulation& model,
                     std::span<const double> latitude_deg, std::span<const double> pressure_hpa,
                     std::span<const double> eddy_driven_m_s) {
  using Complex = std::complex<double>;
  const int ny = grid.ny();
  check_sizes("cell_winds", ny,
              {{"latitude_deg", latitude_deg.size()},
               {"pressure_hpa", pressure_hpa.size()},
               {"eddy_driven_m_s", eddy_driven_m_s.size()}});
  // With w = u + i v the two equations are one: (r + i f) w - r L^2 w'' = i (f U - p' / rho).
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
    wind[j] = Complex(0.0, coriolis * eddy_driven_m_s[j] - slope / model.air_density_kg_m3);
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
