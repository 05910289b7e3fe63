#include "geo/kernels/climate/seasonal_climate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "kernels/climate/zonal.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerMonth = 365.25 / kMonths, kSecondsPerDay = 86400.0;
constexpr double kWattsPerMillimetreADay = 28.9;  // latent heat of rain
constexpr double kLatentOverHeat_k = 2.5e6 / 1004.0;

/// One month's air and what it exchanges with the ground.
struct Month {
  std::vector<float> temperature_c;  ///< at sea level
  std::vector<float> pressure_hpa;   ///< of cells and heat lows, without waves
  std::vector<double> zonal_wind_m_s;
  std::vector<float> wind_east, wind_north, descent_1_s;
  std::vector<float> open_flow;  ///< share of the flow that relief lets pass
  std::vector<float> diffusivity, eddies, activity, saturated_mm, open_water_1_d;
  std::vector<float> potential_evapotranspiration_mm_d, land_evaporation_mm_d;
  std::vector<float> heating_w_m2;
  std::vector<double> column_mm, rain_mm_d;
  std::vector<double> sun_w_m2;  ///< per row
};

/// The year that is being solved.
class SeasonalYear {
 public:
  SeasonalYear(const Grid& grid, const SeasonalClimate& model, std::span<const double> latitude_deg,
               std::span<const float> land_fraction, std::span<const float> height_m)
      : grid_(grid),
        model_(model),
        latitude_deg_(latitude_deg),
        land_(land_fraction),
        height_m_(height_m),
        size_(static_cast<std::size_t>(grid.size())),
        ascent_(size_, 1.0F),
        has_sea_(model.moisture.evaporation_velocity_1_d > 0.0 &&
                 std::any_of(land_fraction.begin(), land_fraction.end(),
                             [](float land) { return land < 1.0F; })) {}

  void warm();
  void blow();
  void exchange();
  void rain(bool last);
  void evaporate();
  void lift(const TerrainAscent& ascent);
  [[nodiscard]] SeasonalFields fields() const;

 private:
  void begin_month(int m, const TemperatureCycle& temperature);
  void heat_air(Month& month) const;
  void activate(Month& month) const;
  [[nodiscard]] std::vector<float> convective_excess_k(const Month& month) const;
  void evaporate_cell(std::size_t cell);
  [[nodiscard]] AirWater water() const;
  [[nodiscard]] std::vector<float> dryness() const;
  template <class Do>
  void for_months(const Do& act) {
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
    for (int m = 0; m < kMonths; ++m) errors.guard([&] { act(months_[m]); });
    errors.rethrow();
  }

  const Grid& grid_;
  const SeasonalClimate& model_;
  std::span<const double> latitude_deg_;
  std::span<const float> land_, height_m_;
  std::size_t size_;
  std::array<Month, kMonths> months_;
  std::vector<float> ascent_;  ///< of single ranges
  std::vector<double> most_evaporation_mm_d_;
  std::vector<std::optional<SteadyMoisture>> budgets_;
  bool has_sea_;
};

/// Temperatures of the months, and all that follows from them alone.
void SeasonalYear::warm() {
  const int ny = grid_.ny();
  std::vector<double> zonal_wind(ny);
  for (int j = 0; j < ny; ++j) {
    zonal_wind[j] =
        three_cell_zonal_wind_m_s(latitude_deg_[j], model_.circulation, grid_.figure().radius_m);
  }
  const TemperatureCycle temperature =
      solve_energy_balance(grid_, model_.energy, model_.circulation.retrograde, latitude_deg_,
                           zonal_wind, land_, height_m_);
  // Evaporation in series with the energy that the sun gives through the year.
  constexpr double kWattsEvaporating = 28.36;
  most_evaporation_mm_d_.resize(ny);
  for (int j = 0; j < ny; ++j) {
    const double sun_w_m2 = annual_insolation_w_m2(latitude_deg_[j], model_.energy.orbit,
                                                   model_.energy.solar_constant_w_m2);
    most_evaporation_mm_d_[j] =
        std::max(1.0e-6, model_.moisture.evaporating_share * sun_w_m2 / kWattsEvaporating);
  }
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) errors.guard([&] { begin_month(m, temperature); });
  errors.rethrow();
}

void SeasonalYear::begin_month(int m, const TemperatureCycle& temperature) {
  Month& month = months_[m];
  const int nx = grid_.nx();
  for (auto* values :
       {&month.temperature_c, &month.pressure_hpa, &month.wind_east, &month.wind_north,
        &month.descent_1_s, &month.open_flow, &month.diffusivity, &month.eddies, &month.activity,
        &month.saturated_mm, &month.open_water_1_d, &month.potential_evapotranspiration_mm_d,
        &month.land_evaporation_mm_d, &month.heating_w_m2}) {
    values->assign(size_, 0.0F);
  }
  month.column_mm.resize(size_);
  month.rain_mm_d.assign(size_, 0.0);
  std::vector<double> annual_c(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    month.temperature_c[cell] = static_cast<float>(temperature.month_c(cell, m));
    annual_c[cell] = temperature.mean_c(cell);
  }
  const std::vector<double> annual_mean_c = row_means<double>(grid_, annual_c);
  const std::vector<double> zonal_c = row_means<float>(grid_, month.temperature_c);
  month.zonal_wind_m_s = thermal_wind_m_s(grid_, model_.circulation, latitude_deg_, zonal_c);
  const std::vector<double> trough_deg = trough_latitudes_deg(
      grid_, latitude_deg_, month.temperature_c, zonal_c, model_.itcz_locality);
  const std::vector<float> eddies =
      eddy_strength(grid_, latitude_deg_, month.temperature_c, zonal_c,
                    model_.eddy_gradient_k_1000km, model_.eddy_locality);
  month.sun_w_m2.resize(grid_.ny());
  for (int j = 0; j < grid_.ny(); ++j) {
    const double insolation = month.sun_w_m2[j] =
        daily_insolation_w_m2(latitude_deg_[j], sun_of_month(model_.energy.orbit, m),
                              model_.energy.orbit.obliquity_deg, model_.energy.solar_constant_w_m2);
    for (int i = 0; i < nx; ++i) {
      const Index here = grid_.cell(i, j);
      const double at_sea_c = month.temperature_c[here];
      const double surface_c = at_sea_c - model_.energy.lapse_k_m * height_m_[here];
      const double warmer_k = at_sea_c - annual_mean_c[j];
      month.pressure_hpa[here] =
          static_cast<float>(three_cell_pressure_hpa(latitude_deg_[j], model_.circulation,
                                                     model_.itcz_share * trough_deg[i]) -
                             model_.circulation.thermal_low_hpa_k * warmer_k *
                                 (warmer_k > 0.0 ? 1.0 : model_.circulation.cold_high_share));
      const double relative = height_m_[here] / model_.blocking_height_m;
      month.open_flow[here] = static_cast<float>(1.0 / (1.0 + relative * relative));
      month.diffusivity[here] =
          static_cast<float>(month.open_flow[here] * (model_.base_diffusivity_m2_s +
                                                      model_.eddy_diffusivity_m2_s * eddies[here]));
      month.eddies[here] = static_cast<float>(1.0 + model_.eddy_rain * eddies[here]);
      const double lifted_c =
          at_sea_c - model_.energy.lapse_k_m * model_.orographic_share * height_m_[here];
      const double saturated = saturated_column_mm(lifted_c);
      month.saturated_mm[here] = static_cast<float>(saturated);
      month.potential_evapotranspiration_mm_d[here] =
          static_cast<float>(oudin_evaporation_mm_d(insolation, surface_c));
      const double resistance_d =
          1.0 / model_.moisture.evaporation_velocity_1_d + saturated / most_evaporation_mm_d_[j];
      month.open_water_1_d[here] = static_cast<float>((1.0 - land_[here]) / resistance_d);
      month.column_mm[here] = (has_sea_ ? 0.7 : 0.0) * saturated;
      month.land_evaporation_mm_d[here] = has_sea_
                                              ? static_cast<float>(0.5 * land_[here]) *
                                                    month.potential_evapotranspiration_mm_d[here]
                                              : 0.0F;
    }
  }
}

/// Heat that the air gets from rain and from ground that is warmer than its parallel.
void SeasonalYear::heat_air(Month& month) const {
  constexpr double kRelaxed = 0.5;
  const std::vector<double> zonal_c = row_means<float>(grid_, month.temperature_c);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double warmer_k =
        month.temperature_c[cell] - zonal_c[grid_.row(static_cast<Index>(cell))];
    const double heating = kWattsPerMillimetreADay * month.rain_mm_d[cell] +
                           model_.sensible_w_m2_k * land_[cell] * warmer_k;
    month.heating_w_m2[cell] += static_cast<float>(kRelaxed * (heating - month.heating_w_m2[cell]));
  }
}

/// Winds of cells, heat lows and waves.
void SeasonalYear::blow() {
  for_months([&](Month& month) {
    balanced_winds(grid_, model_.circulation, latitude_deg_, land_, month.pressure_hpa,
                   month.wind_east, month.wind_north);
    if (grid_.topology() == Topology::sphere) {
      heat_air(month);
      std::vector<float> east(size_), north(size_);
      stationary_wave(grid_, model_.wave, model_.circulation.rotation_rad_s(), latitude_deg_,
                      month.zonal_wind_m_s, month.heating_w_m2, height_m_, east, north,
                      month.descent_1_s);
      for (std::size_t cell = 0; cell < size_; ++cell) {
        month.wind_east[cell] += east[cell];
        month.wind_north[cell] += north[cell];
      }
    }
    for (std::size_t cell = 0; cell < size_; ++cell) {
      month.wind_east[cell] *= month.open_flow[cell];
      month.wind_north[cell] *= month.open_flow[cell];
    }
    activate(month);
  });
}

/// How far the moist static energy near the ground, in kelvins of dry air, exceeds that of the
/// parallels around: where planetary rotation is weak, the free atmosphere above is level.
std::vector<float> SeasonalYear::convective_excess_k(const Month& month) const {
  constexpr double kDryLapse_k_m = 0.0098, kSurfacePressure_pa = 1.0e5, kReach_deg = 10.0;
  std::vector<float> energy_k(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double at_sea_c = month.temperature_c[cell], height_m = height_m_[cell];
    const double surface_c = at_sea_c - model_.energy.lapse_k_m * height_m;
    const double humidity = 0.622 * saturation_pressure_pa(surface_c) / kSurfacePressure_pa *
                            std::min(1.0, month.column_mm[cell] / month.saturated_mm[cell]);
    energy_k[cell] =
        static_cast<float>(surface_c + kDryLapse_k_m * height_m + kLatentOverHeat_k * humidity);
  }
  const std::vector<double> around_k =
      smooth_rows(latitude_deg_, row_means<float>(grid_, energy_k), kReach_deg);
  const double edge = std::sin(model_.convection_latitude_deg * kRadians);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    const double turning = std::sin(latitude_deg_[row] * kRadians) / edge;
    energy_k[cell] = static_cast<float>((energy_k[cell] - around_k[row]) /
                                        (1.0 + turning * turning * turning * turning));
  }
  return energy_k;
}

/// Rising air rains out, and so does air that is lighter than its surroundings; sinking air keeps
/// its water.
void SeasonalYear::activate(Month& month) const {
  constexpr double kMost = 2.0;
  std::vector<float> rising = convergence(grid_, month.wind_east, month.wind_north);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    rising[cell] =
        static_cast<float>(kSecondsPerDay * (model_.ascent_time_d * rising[cell] -
                                             model_.descent_time_d * month.descent_1_s[cell]));
  }
  smooth(grid_, rising, 1000.0 * model_.ascent_smoothing_km);
  const std::vector<float> excess_k = convective_excess_k(month);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double lighter = model_.convection_1_k * excess_k[cell];
    month.activity[cell] =
        static_cast<float>(month.eddies[cell] * ascent_[cell] *
                           std::exp(std::clamp(rising[cell] + lighter, -kMost, kMost)));
  }
}

/// Takes winds and activity over into the moisture budgets.
void SeasonalYear::exchange() {
  constexpr int kTogether = SteadyMoisture::kSeasons;
  static_assert(kMonths % kTogether == 0);
  std::vector<MoistureSeason> seasons;
  for (Month& month : months_) {
    seasons.push_back({month.wind_east, month.wind_north, month.diffusivity, month.activity,
                       month.saturated_mm, month.open_water_1_d, month.land_evaporation_mm_d,
                       month.column_mm});
  }
  budgets_.resize(kMonths / kTogether);
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < budgets_.size(); ++k) {
    errors.guard([&] {
      budgets_[k].emplace(grid_, model_.moisture,
                          std::span(seasons).subspan(k * kTogether, kTogether));
      budgets_[k]->solve();
    });
  }
  errors.rethrow();
}

void SeasonalYear::rain(bool last) {
  constexpr int kTogether = SteadyMoisture::kSeasons;
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) {
    errors.guard([&] {
      Month& month = months_[m];
      if (last) budgets_[m / kTogether]->close(m % kTogether);
      for (std::size_t cell = 0; cell < size_; ++cell) {
        month.rain_mm_d[cell] = rain_mm_d(model_.moisture, month.column_mm[cell],
                                          month.saturated_mm[cell], month.activity[cell]);
      }
    });
  }
  errors.rethrow();
}

/// What soil and snow give back of the rain that the last round gave them.
void SeasonalYear::evaporate() {
#pragma omp parallel for schedule(static)
  for (std::size_t cell = 0; cell < size_; ++cell) {
    if (land_[cell] > 0.0F) evaporate_cell(cell);
  }
}

void SeasonalYear::evaporate_cell(std::size_t cell) {
  std::array<double, kMonths> temperature_c{}, rain_mm{}, potential_mm{};
  for (int m = 0; m < kMonths; ++m) {
    const Month& month = months_[m];
    temperature_c[m] = month.temperature_c[cell] - model_.energy.lapse_k_m * height_m_[cell];
    rain_mm[m] = kDaysPerMonth * month.rain_mm_d[cell];
    potential_mm[m] = kDaysPerMonth * month.potential_evapotranspiration_mm_d[cell];
  }
  const auto evaporation_mm =
      soil_evaporation_mm(model_.soil, temperature_c, rain_mm, potential_mm);
  for (int m = 0; m < kMonths; ++m) {
    months_[m].land_evaporation_mm_d[cell] = static_cast<float>(
        model_.land_transpiration * land_[cell] * evaporation_mm[m] / kDaysPerMonth);
  }
}

void SeasonalYear::lift(const TerrainAscent& ascent) {
  std::vector<float> east(size_), north(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    double sum_east = 0.0, sum_north = 0.0;
    for (const Month& month : months_) {
      sum_east += month.wind_east[cell];
      sum_north += month.wind_north[cell];
    }
    east[cell] = static_cast<float>(sum_east / kMonths);
    north[cell] = static_cast<float>(sum_north / kMonths);
  }
  ascent_ = ascent(east, north);
}

AirWater SeasonalYear::water() const {
  constexpr double kPerMillimetreADay = 1.0e-3 / kSecondsPerDay / kMonths;
  const auto over_the_year = [&](const auto& of_month) {
    return kPerMillimetreADay * area_sum<double>(grid_, [&](Index cell) {
             double sum = 0.0;
             for (const Month& month : months_) sum += of_month(month, cell);
             return sum;
           });
  };
  return {.sea_evaporation_m3_s = over_the_year([](const Month& month, Index cell) {
            return sea_evaporation_mm_d(month.column_mm[cell], month.saturated_mm[cell],
                                        month.open_water_1_d[cell]);
          }),
          .land_evaporation_m3_s = over_the_year(
              [](const Month& month, Index cell) { return month.land_evaporation_mm_d[cell]; }),
          .precipitation_m3_s =
              over_the_year([](const Month& month, Index cell) { return month.rain_mm_d[cell]; })};
}

/// Share of the sun's heat on land that dry ground does not use up by evaporation: 1 where it never
/// rains, 0 where four fifths of the potential evapotranspiration or more rain.
std::vector<float> SeasonalYear::dryness() const {
  constexpr double kMoist = 0.8;
  std::vector<float> dry(size_, 0.0F);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    double rain = 0.0, potential = 0.0;
    for (const Month& month : months_) {
      rain += month.rain_mm_d[cell];
      potential += month.potential_evapotranspiration_mm_d[cell];
    }
    if (potential > 0.0) {
      dry[cell] = static_cast<float>(land_[cell] * std::max(0.0, 1.0 - rain / potential / kMoist));
    }
  }
  return dry;
}

SeasonalFields SeasonalYear::fields() const {
  SeasonalFields fields;
  const std::vector<float> dry = dryness();
  fields.water = water();
  fields.humidity.resize(size_);
  for (int m = 0; m < kMonths; ++m) {
    const Month& month = months_[m];
    fields.temperature_c[m] = month.temperature_c;
    for (std::size_t cell = 0; cell < size_; ++cell) {
      const double sun_w_m2 = month.sun_w_m2[grid_.row(static_cast<Index>(cell))];
      fields.temperature_c[m][cell] +=
          static_cast<float>(dry[cell] * model_.energy.dry_warming_k_m2_w *
                             (sun_w_m2 - model_.energy.dry_warming_from_w_m2));
    }
    fields.wind_east[m] = month.wind_east;
    fields.wind_north[m] = month.wind_north;
    fields.precipitation_mm[m].resize(size_);
    for (std::size_t cell = 0; cell < size_; ++cell) {
      fields.precipitation_mm[m][cell] = static_cast<float>(kDaysPerMonth * month.rain_mm_d[cell]);
      fields.humidity[cell] +=
          static_cast<float>(month.column_mm[cell] / month.saturated_mm[cell] / kMonths);
    }
  }
  return fields;
}

}  // namespace

SeasonalFields solve_seasonal_climate(const Grid& grid, const SeasonalClimate& model,
                                      std::span<const double> latitude_deg,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m,
                                      const TerrainAscent& ascent) {
  check_sizes("solve_seasonal_climate", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("solve_seasonal_climate", grid.size(),
              {{"land_fraction", land_fraction.size()}, {"height_m", height_m.size()}});
  SeasonalYear year(grid, model, latitude_deg, land_fraction, height_m);
  year.warm();
  constexpr int kRounds = 7, kLevelRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    if (round == kLevelRounds && ascent) year.lift(ascent);
    year.blow();
    year.exchange();
    const bool last = round + 1 == kRounds;
    year.rain(last);
    if (!last) year.evaporate();
  }
  return year.fields();
}

}  // namespace geo
