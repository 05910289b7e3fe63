#include "geo/kernels/climate/circulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;

/// Latitude as the cells see it: the tropical boundary moves with the ITCZ, the pole stays.
double cell_latitude_deg(double latitude_deg, double itcz_deg) {
  const double span = latitude_deg >= itcz_deg ? 90.0 - itcz_deg : 90.0 + itcz_deg;
  return (latitude_deg - itcz_deg) / span * 90.0;
}

double cell_rise_hpa(int cell, const Circulation& model) {
  if (cell == 0) return model.subtropical_high_hpa;
  return cell == 1 ? -model.subpolar_low_hpa : model.polar_high_hpa;
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

double three_cell_pressure_hpa(double latitude_deg, const Circulation& model) {
  const double distance = std::min(std::abs(latitude_deg), 90.0);
  double pressure = 0.0;
  for (int cell = 0; cell < 3; ++cell) {
    const double along = std::clamp((distance - 30.0 * cell) / 30.0, 0.0, 1.0);
    pressure += cell_rise_hpa(cell, model) * 0.5 * (1.0 - std::cos(kPi * along));
  }
  return pressure;
}

double three_cell_gradient_hpa(double latitude_deg, const Circulation& model) {
  const double distance = std::min(std::abs(latitude_deg), 90.0);
  const int cell = std::min(2, static_cast<int>(distance / 30.0));
  const double along = distance / 30.0 - cell;
  const double slope = cell_rise_hpa(cell, model) * 3.0 * std::sin(kPi * along);
  return latitude_deg >= 0.0 ? slope : -slope;
}

void thermal_winds(const Grid& grid, const Circulation& model, std::span<const double> latitude_deg,
                   double itcz_deg, std::span<const float> land_fraction,
                   std::span<const float> heat_anomaly_k, std::span<float> wind_east,
                   std::span<float> wind_north) {
  const double twice_rotation_s = 4.0 * kPi / (model.rotation_period_h * 3600.0);
  const double pascals_per_kelvin = -100.0 * model.thermal_low_hpa_k;
  for (int j = 0; j < grid.ny(); ++j) {
    const double latitude = latitude_deg[j];
    const double coriolis = twice_rotation_s * std::sin(latitude * kRadians);
    const double cell_latitude = cell_latitude_deg(latitude, itcz_deg);
    const double stretch =
        latitude >= itcz_deg ? 90.0 / (90.0 - itcz_deg) : 90.0 / (90.0 + itcz_deg);
    const double cells =
        100.0 * three_cell_gradient_hpa(cell_latitude, model) * stretch / grid.figure().radius_m;
    const double two_steps_east_m = 2.0 * grid.spacing_east_m(j);
    const auto& distances = grid.distances_m(j);
    const double two_steps_north_m = distances[kNorth] + distances[kSouth];
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      const auto anomaly = [&](int k) {
        return static_cast<double>(heat_anomaly_k[grid.neighbour(i, j, k)]);
      };
      const double push_east = -pascals_per_kelvin * (anomaly(kEast) - anomaly(kWest)) /
                               two_steps_east_m / model.air_density_kg_m3;
      const double push_north =
          -(cells + pascals_per_kelvin * (anomaly(kNorth) - anomaly(kSouth)) / two_steps_north_m) /
          model.air_density_kg_m3;
      const double drag =
          model.drag_ocean_s + land_fraction[here] * (model.drag_land_s - model.drag_ocean_s);
      const double norm = 1.0 / (drag * drag + coriolis * coriolis);
      wind_east[here] = static_cast<float>((drag * push_east + coriolis * push_north) * norm);
      wind_north[here] = static_cast<float>((drag * push_north - coriolis * push_east) * norm);
    }
  }
}

}  // namespace geo
