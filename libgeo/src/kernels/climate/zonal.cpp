#include "kernels/climate/zonal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Latitude of the warmest rows.
template <class TemperatureOf>
double warmest_latitude_deg(std::span<const double> latitude_deg, TemperatureOf&& temperature_c) {
  constexpr double kSharpness_k = 1.5;
  const int ny = static_cast<int>(latitude_deg.size());
  double warmest = -1e30;
  for (int j = 0; j < ny; ++j) warmest = std::max(warmest, temperature_c(j));
  double weight = 0.0, moment = 0.0;
  for (int j = 0; j < ny; ++j) {
    const double w = std::cos(latitude_deg[j] * kRadians) *
                     std::exp((temperature_c(j) - warmest) / kSharpness_k);
    weight += w;
    moment += w * latitude_deg[j];
  }
  return moment / weight;
}

/// Mean of a closed line within `reach` places on both sides of each.
std::vector<double> running_mean(std::span<const double> line, int reach) {
  const int n = static_cast<int>(line.size());
  std::vector<double> means(n);
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int k = -reach; k <= reach; ++k) sum += line[((i + k) % n + n) % n];
    means[i] = sum / (2 * reach + 1);
  }
  return means;
}

}  // namespace

std::vector<double> smooth_rows(std::span<const double> latitude_deg,
                                std::span<const double> values, double reach_deg) {
  std::vector<double> means(values.size());
  for (std::size_t j = 0; j < values.size(); ++j) {
    double sum = 0.0, weight = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (std::abs(latitude_deg[k] - latitude_deg[j]) > reach_deg) continue;
      const double w = std::cos(latitude_deg[k] * kRadians);
      sum += w * values[k];
      weight += w;
    }
    means[j] = sum / weight;
  }
  return means;
}

double trade_wind_m_s(double latitude_deg, const Circulation& model, double radius_m) {
  constexpr double kStep_deg = 1.0;
  const double slope_pa_m = 100.0 *
                            (hadley_pressure_hpa(latitude_deg + 0.5 * kStep_deg, model) -
                             hadley_pressure_hpa(latitude_deg - 0.5 * kStep_deg, model)) /
                            (kStep_deg * kRadians * radius_m);
  const double coriolis = 2.0 * model.rotation_rad_s() * std::sin(latitude_deg * kRadians);
  const double drag = model.drag_ocean_s;
  return -coriolis * slope_pa_m / model.air_density_kg_m3 / (drag * drag + coriolis * coriolis);
}

std::vector<double> thermal_wind_m_s(const Grid& grid, const Circulation& model,
                                     std::span<const double> latitude_deg,
                                     std::span<const double> zonal_temperature_c) {
  constexpr double kGasConstantOverLayer = 287.0 * 0.6931;  // of air from 1000 to 500 hPa
  constexpr double kTropics_deg = 10.0;
  const int ny = grid.ny();
  const double radius_m = grid.figure().radius_m;
  std::vector<double> wind(ny);
  for (int j = 0; j < ny; ++j) {
    const int south = std::max(0, j - 2), north = std::min(ny - 1, j + 2);
    const double across_m = (latitude_deg[north] - latitude_deg[south]) * kRadians * radius_m;
    const double slope_k_m =
        across_m > 0.0 ? (zonal_temperature_c[north] - zonal_temperature_c[south]) / across_m : 0.0;
    const double turning = 2.0 * model.rotation_rad_s();
    const double coriolis = turning * std::sin(latitude_deg[j] * kRadians);
    const double least = turning * std::sin(kTropics_deg * kRadians);
    wind[j] = trade_wind_m_s(latitude_deg[j], model, radius_m) -
              kGasConstantOverLayer * slope_k_m * coriolis / (coriolis * coriolis + least * least);
  }
  return wind;
}

std::vector<double> trough_latitudes_deg(const Grid& grid, std::span<const double> latitude_deg,
                                         std::span<const float> temperature_c,
                                         std::span<const double> zonal_temperature_c,
                                         double locality) {
  const int nx = grid.nx(), ny = grid.ny();
  const double zonal_deg =
      warmest_latitude_deg(latitude_deg, [&](int j) { return zonal_temperature_c[j]; });
  std::vector<double> trough(nx, zonal_deg);
  if (locality <= 0.0) return trough;
  const int reach = nx / 16;
  std::vector<double> around(static_cast<std::size_t>(nx) * ny), line(nx);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) line[i] = temperature_c[grid.cell(i, j)];
    const std::vector<double> means = running_mean(line, reach);
    std::copy(means.begin(), means.end(), around.begin() + static_cast<std::ptrdiff_t>(j) * nx);
  }
  for (int i = 0; i < nx; ++i) {
    const double own_deg =
        warmest_latitude_deg(latitude_deg, [&](int j) { return around[grid.cell(i, j)]; });
    trough[i] += locality * (own_deg - zonal_deg);
  }
  return running_mean(trough, reach);
}

std::vector<float> eddy_strength(const Grid& grid, std::span<const double> latitude_deg,
                                 std::span<const float> temperature_c,
                                 std::span<const double> zonal_temperature_c,
                                 double reference_k_1000km, double exponent, double locality) {
  const int nx = grid.nx(), ny = grid.ny();
  std::vector<float> strength(static_cast<std::size_t>(grid.size()), 0.0F);
  if (latitude_deg[0] == latitude_deg[ny - 1]) return strength;  // a torus at one latitude
  const int reach = std::max(1, ny / 36);
  const double radius_1000km = grid.figure().radius_m / 1.0e6;
  for (int j = 0; j < ny; ++j) {
    const int south = std::max(0, j - reach), north = std::min(ny - 1, j + reach);
    const double distance = (latitude_deg[north] - latitude_deg[south]) * kRadians * radius_1000km;
    const double zonal =
        std::abs(zonal_temperature_c[north] - zonal_temperature_c[south]) / distance;
    const double across = 1.0e-6 * grid.spacing_east_m(j);
    const int sideways =
        std::clamp(static_cast<int>(std::lround(0.5 * distance / across)), 1, nx / 4);
    for (int i = 0; i < nx; ++i) {
      const double along_y =
          (temperature_c[grid.cell(i, north)] - temperature_c[grid.cell(i, south)]) / distance;
      const double along_x = (temperature_c[grid.cell((i + sideways) % nx, j)] -
                              temperature_c[grid.cell((i - sideways + nx) % nx, j)]) /
                             (2.0 * sideways * across);
      const double local = std::hypot(along_x, along_y);
      const double gradient = zonal + locality * (local - zonal);
      strength[grid.cell(i, j)] =
          static_cast<float>(std::pow(gradient / reference_k_1000km, exponent));
    }
  }
  return strength;
}

std::vector<float> convergence(const Grid& grid, std::span<const float> wind_east,
                               std::span<const float> wind_north) {
  std::vector<float> result(static_cast<std::size_t>(grid.size()));
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      const Index east = grid.neighbour(i, j, kEast), west = grid.neighbour(i, j, kWest);
      const Index north = grid.neighbour(i, j, kNorth), south = grid.neighbour(i, j, kSouth);
      const double zonal = 0.5 * (wind_east[west] - wind_east[east]) * grid.face_east_m(j);
      const double meridional =
          0.5 * (wind_north[south] + wind_north[here]) * grid.face_north_m(j - 1) -
          0.5 * (wind_north[north] + wind_north[here]) * grid.face_north_m(j);
      result[here] = static_cast<float>((zonal + meridional) / grid.area_m2(j));
    }
  }
  return result;
}

}  // namespace geo
