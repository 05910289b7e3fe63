// Temperatures of the months, and what of their air follows from them alone.
#include <algorithm>
#include <cmath>

#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/ocean_heat.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "kernels/climate/zonal.hpp"
#include "seasonal_year.hpp"

namespace geo {

std::vector<float> SeasonalYear::share_of_open_flow() const {
  std::vector<float> open(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double relative = height_m_[cell] / model_.blocking_height_m;
    open[cell] = static_cast<float>(1.0 / (1.0 + relative * relative));
  }
  return open;
}

/// Pressure over ground that is warmer or colder than its parallel is through the year, hPa.
double SeasonalYear::thermal_pressure_hpa(double warmer_k) const {
  return -model_.circulation.thermal_low_hpa_k * warmer_k *
         (warmer_k > 0.0 ? 1.0 : model_.circulation.cold_high_share);
}

/// Winds that carry heat: a share of the thermal wind, the same all along a parallel, and a share
/// of the winds about heat lows and cold highs.
void SeasonalYear::carry_heat(std::span<const float> month_c, std::span<const double> annual_mean_c,
                              std::span<float> east, std::span<float> north) const {
  std::vector<float> pressure_hpa(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    pressure_hpa[cell] =
        static_cast<float>(thermal_pressure_hpa(month_c[cell] - annual_mean_c[row]));
  }
  balanced_winds(grid_, model_.circulation, latitude_deg_, land_, pressure_hpa, east, north);
  const auto mean_east = row_means<float>(grid_, east), mean_north = row_means<float>(grid_, north);
  const std::vector<double> aloft =
      thermal_wind_m_s(grid_, model_.circulation, latitude_deg_, row_means<float>(grid_, month_c));
  const EnergyBalance& energy = model_.energy;
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    east[cell] = static_cast<float>(energy.heat_wave_share * (east[cell] - mean_east[row]) +
                                    energy.heat_wind_share * aloft[row]);
    north[cell] = static_cast<float>(energy.heat_wave_share * (north[cell] - mean_north[row]));
    const double open = open_to_heat(energy, height_m_[cell]);
    east[cell] *= static_cast<float>(open);
    north[cell] *= static_cast<float>(open);
  }
}

/// What currents make the sea warmer than the air, and how an eddy as wide as the deformation
/// radius feels it.
void SeasonalYear::find_warm_sea(std::span<const double> equatorial_wind_m_s) {
  constexpr double kEddy_m = 600e3;
  const TemperatureCycle& temperature = temperatures_->temperature();
  std::vector<double> annual_mean_c(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) annual_mean_c[cell] = temperature.mean_c(cell);
  sea_warmer_k_ = sea_warmth_k(grid_, model_.energy, model_.circulation.retrograde, latitude_deg_,
                               land_, annual_mean_c, equatorial_wind_m_s);
  warmer_below_eddies_k_.resize(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    warmer_below_eddies_k_[cell] = (1.0F - land_[cell]) * sea_warmer_k_[cell];
  }
  smooth(grid_, warmer_below_eddies_k_, kEddy_m);
}

void SeasonalYear::begin_months(std::span<const double> equatorial_wind_m_s) {
  find_warm_sea(equatorial_wind_m_s);
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) errors.guard([&] { begin_month(m); });
  errors.rethrow();
}

/// All that follows from the temperatures of the months alone.
void SeasonalYear::warm() {
  // Evaporation in series with the energy that the sun gives through the year.
  constexpr double kWattsEvaporating = 28.36;
  most_evaporation_mm_d_.resize(grid_.ny());
  const std::vector<double> sun_w_m2 =
      annual_insolation_w_m2(latitude_deg_, model_.energy.orbit, model_.energy.solar_constant_w_m2);
  for (int j = 0; j < grid_.ny(); ++j) {
    most_evaporation_mm_d_[j] =
        std::max(1.0e-6, model_.moisture.evaporating_share * sun_w_m2[j] / kWattsEvaporating);
  }
  temperatures_.emplace(
      grid_, model_.energy, model_.circulation.retrograde, latitude_deg_, land_, height_m_,
      [this](auto... fields) { carry_heat(fields...); }, glacier_);
  for (AirOfMonth& month : months_) clear(month);
  begin_months({});
  for (AirOfMonth& month : months_) guess(month);
}

/// Water wells up along the equator where trades blow.
void SeasonalYear::warm_again() {
  const std::vector<double> wind_m_s = equatorial_wind_m_s();
  if (has_sea_ && model_.energy.upwelling_w_m2 > 0.0 && !wind_m_s.empty()) {
    temperatures_->upwell(wind_m_s);
    begin_months(wind_m_s);
  }
  temperatures_.reset();
}

/// Annual mean of the wind along the equator, east, by column; none where no row is near it.
std::vector<double> SeasonalYear::equatorial_wind_m_s() const {
  constexpr double kNear_deg = 5.0;
  std::vector<double> sum(grid_.nx(), 0.0);
  int count = 0;
  for (int j = 0; j < grid_.ny(); ++j) {
    if (std::abs(latitude_deg_[j]) > kNear_deg) continue;
    ++count;
    for (const AirOfMonth& month : months_) {
      for (int i = 0; i < grid_.nx(); ++i) sum[i] += month.wind_east[grid_.cell(i, j)];
    }
  }
  if (count == 0) return {};
  for (double& wind : sum) wind /= count * kMonths;
  return sum;
}

void SeasonalYear::begin_month(int m) {
  AirOfMonth& month = months_[m];
  const TemperatureCycle& temperature = temperatures_->temperature();
  std::vector<double> annual_c(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    month.temperature_c[cell] = static_cast<float>(temperature.month_c(cell, m));
    annual_c[cell] = temperature.mean_c(cell);
  }
  month.sun_w_m2.resize(grid_.ny());
  for (int j = 0; j < grid_.ny(); ++j) {
    month.sun_w_m2[j] =
        daily_insolation_w_m2(latitude_deg_[j], sun_of_month(model_.energy.orbit, m),
                              model_.energy.orbit.obliquity_deg, model_.energy.solar_constant_w_m2);
  }
  const std::vector<double> zonal_c = row_means<float>(grid_, month.temperature_c);
  month.zonal_wind_m_s = thermal_wind_m_s(grid_, model_.circulation, latitude_deg_, zonal_c);
  const auto some_time_ago = [&](double months) {
    std::vector<float> late_c(size_);
    for (std::size_t cell = 0; cell < size_; ++cell) {
      const double before_c = temperature.month_c(cell, (m + kMonths - 1) % kMonths);
      late_c[cell] = static_cast<float>(month.temperature_c[cell] +
                                        months * (before_c - month.temperature_c[cell]));
    }
    return late_c;
  };
  press(month, zonal_c, some_time_ago(model_.itcz_lag_month),
        some_time_ago(model_.heat_low_lag_month), row_means<double>(grid_, annual_c));
  stir(month, zonal_c);
  moisten(month);
}

void SeasonalYear::clear(AirOfMonth& month) const {
  for (auto* values : {&month.temperature_c,
                       &month.pressure_hpa,
                       &month.wind_east,
                       &month.wind_north,
                       &month.descent_1_s,
                       &month.force_east,
                       &month.force_north,
                       &month.wave_east,
                       &month.wave_north,
                       &month.diffusivity,
                       &month.own_eddies,
                       &month.eddies,
                       &month.activity,
                       &month.saturated_mm,
                       &month.open_water_1_d,
                       &month.gust_m_s,
                       &month.potential_evapotranspiration_mm_d,
                       &month.soil_evaporation_mm_d,
                       &month.land_evaporation_mm_d,
                       &month.cold_air_evaporation_mm_d,
                       &month.given_evaporation_mm_d,
                       &month.heating_w_m2}) {
    values->assign(size_, 0.0F);
  }
  month.column_mm.resize(size_);
  month.rain_mm_d.assign(size_, 0.0);
}

/// How much rougher parallels are than the sea.
std::vector<double> SeasonalYear::roughness_of_rows() const {
  std::vector<double> roughness = row_means<float>(grid_, land_);
  for (double& of_row : roughness) of_row = 1.0 + model_.land_drag * of_row;
  return roughness;
}

/// Winds of the cells about the trough, which blow along whole parallels; and pressure: by how much
/// the cells' differs where their trough does, and of heat lows and cold highs. All are as deep as
/// the troposphere, which warms and cools later than the ground.
void SeasonalYear::press(AirOfMonth& month, std::span<const double> zonal_c,
                         std::span<const float> trough_c, std::span<const float> low_c,
                         std::span<const double> annual_mean_c) const {
  const std::vector<double> trough_deg = trough_latitudes_deg(
      grid_, latitude_deg_, trough_c, row_means<float>(grid_, trough_c), model_.itcz_locality);
  std::vector<float> cells_hpa(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const Index here = static_cast<Index>(cell);
    cells_hpa[cell] =
        static_cast<float>(hadley_pressure_hpa(latitude_deg_[grid_.row(here)], model_.circulation,
                                               model_.itcz_share * trough_deg[grid_.column(here)]));
  }
  const std::vector<double> mean_hpa = row_means<float>(grid_, cells_hpa);
  if (grid_.topology() == Topology::sphere) {
    month.cells = cell_winds(grid_, model_.circulation, latitude_deg_, mean_hpa,
                             eddy_driven_wind_m_s(grid_, model_.circulation, latitude_deg_, zonal_c,
                                                  roughness_of_rows()));
  }
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    month.pressure_hpa[cell] = static_cast<float>(
        cells_hpa[cell] - mean_hpa[row] + thermal_pressure_hpa(low_c[cell] - annual_mean_c[row]) -
        model_.sea_low_hpa_k * (1.0 - land_[cell]) * sea_warmer_k_[cell]);
  }
}

/// Eddies, which mix the air's water and let it rain: their winds grow with the gradient of
/// temperature, and what they mix with their winds. Mountains hold the flow back.
void SeasonalYear::stir(AirOfMonth& month, std::span<const double> zonal_c) const {
  constexpr double kFastest_1_s = 0.01;  // on tiny planets: what mixes in minutes is mixed
  std::vector<float> surface_c = month.temperature_c;
  for (std::size_t cell = 0; cell < size_; ++cell) surface_c[cell] += warmer_below_eddies_k_[cell];
  const std::vector<float> eddies =
      eddy_strength(grid_, latitude_deg_, surface_c, zonal_c, model_.eddy_gradient_k_1000km,
                    model_.eddy_exponent, model_.eddy_locality);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double spacing_m = grid_.spacing_north_m(grid_.row(static_cast<Index>(cell)));
    const double gradient = std::pow(eddies[cell], 1.0 / model_.eddy_exponent);
    month.diffusivity[cell] = static_cast<float>(std::min(
        open_flow_[cell] * (model_.base_diffusivity_m2_s + model_.eddy_diffusivity_m2_s * gradient),
        kFastest_1_s * spacing_m * spacing_m));
    month.own_eddies[cell] = static_cast<float>(model_.eddy_rain * eddies[cell]);
    month.gust_m_s[cell] = static_cast<float>(model_.gust_m_s * gradient);
  }
}

/// What the air can hold, and what ground can give it.
void SeasonalYear::moisten(AirOfMonth& month) const {
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    const double at_sea_c = month.temperature_c[cell];
    const double surface_c = at_sea_c - model_.energy.lapse_k_m * height_m_[cell];
    const double lifted_c =
        at_sea_c - model_.energy.lapse_k_m * model_.orographic_share * height_m_[cell];
    const double saturated = saturated_column_mm(lifted_c);
    month.saturated_mm[cell] = static_cast<float>(saturated);
    month.potential_evapotranspiration_mm_d[cell] =
        static_cast<float>(oudin_evaporation_mm_d(month.sun_w_m2[row], surface_c));
  }
}

/// A first guess of the water in the air, and of what land gives it.
void SeasonalYear::guess(AirOfMonth& month) const {
  for (std::size_t cell = 0; cell < size_; ++cell) {
    month.column_mm[cell] = (has_sea_ ? 0.7 : 0.0) * month.saturated_mm[cell];
    month.land_evaporation_mm_d[cell] = has_sea_ ? static_cast<float>(0.5 * land_[cell]) *
                                                       month.potential_evapotranspiration_mm_d[cell]
                                                 : 0.0F;
  }
}

}  // namespace geo
