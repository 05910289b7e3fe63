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
#include "kernels/climate/sea_evaporation.hpp"
#include "kernels/climate/zonal.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerMonth = 365.25 / kMonths, kSecondsPerDay = 86400.0;
constexpr double kWattsPerMillimetreADay = 28.9;  // latent heat of rain
constexpr double kLatentOverHeat_k = 2.5e6 / 1004.0;

/// How far a latitude is one where planetary rotation is weak: half at the edge.
double weak_rotation(double latitude_deg, double edge_deg) {
  const double turning = std::sin(latitude_deg * kRadians) / std::sin(edge_deg * kRadians);
  return 1.0 / (1.0 + turning * turning * turning * turning);
}

/// One month's air and what it exchanges with the ground.
struct Month {
  std::vector<float> temperature_c;  ///< at sea level
  std::vector<float> pressure_hpa;   ///< of cells and heat lows, without waves
  std::vector<double> zonal_wind_m_s;
  std::vector<float> wind_east, wind_north, descent_1_s;
  std::vector<float> open_flow;  ///< share of the flow that relief lets pass
  std::vector<float> diffusivity, own_eddies, eddies, activity, saturated_mm, open_water_1_d;
  std::vector<float> gust_m_s;  ///< of eddies
  std::vector<float> potential_evapotranspiration_mm_d, land_evaporation_mm_d;
  std::vector<float> cold_air_evaporation_mm_d;  ///< from water under air that comes from the cold
  std::vector<float> given_evaporation_mm_d;     ///< both, whatever the column holds
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
  void rain(bool closed);
  void evaporate();
  void lift(const TerrainAscent& ascent);
  [[nodiscard]] SeasonalFields fields() const;

 private:
  [[nodiscard]] double thermal_pressure_hpa(double warmer_k) const;
  void carry_heat(std::span<const float> month_c, std::span<const double> annual_mean_c,
                  std::span<float> east, std::span<float> north) const;
  void begin_month(int m, const TemperatureCycle& temperature);
  void clear(Month& month) const;
  void press(Month& month, std::span<const double> zonal_c,
             std::span<const double> annual_mean_c) const;
  void stir(Month& month, std::span<const double> zonal_c) const;
  void moisten(Month& month) const;
  void heat_air(Month& month) const;
  void evaporate_sea(Month& month) const;
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

/// Temperatures of the months, and all that follows from them alone.
void SeasonalYear::warm() {
  const int ny = grid_.ny();
  const TemperatureCycle temperature =
      solve_energy_balance(grid_, model_.energy, model_.circulation.retrograde, latitude_deg_,
                           land_, height_m_, [this](auto... fields) { carry_heat(fields...); });
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
  clear(month);
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
  press(month, zonal_c, row_means<double>(grid_, annual_c));
  stir(month, zonal_c);
  moisten(month);
}

void SeasonalYear::clear(Month& month) const {
  for (auto* values :
       {&month.temperature_c, &month.pressure_hpa, &month.wind_east, &month.wind_north,
        &month.descent_1_s, &month.open_flow, &month.diffusivity, &month.own_eddies, &month.eddies,
        &month.activity, &month.saturated_mm, &month.open_water_1_d, &month.gust_m_s,
        &month.potential_evapotranspiration_mm_d, &month.land_evaporation_mm_d,
        &month.cold_air_evaporation_mm_d, &month.given_evaporation_mm_d, &month.heating_w_m2}) {
    values->assign(size_, 0.0F);
  }
  month.column_mm.resize(size_);
  month.rain_mm_d.assign(size_, 0.0);
}

/// Pressure of the three cells about the trough, and of heat lows and cold highs.
void SeasonalYear::press(Month& month, std::span<const double> zonal_c,
                         std::span<const double> annual_mean_c) const {
  const std::vector<double> trough_deg = trough_latitudes_deg(
      grid_, latitude_deg_, month.temperature_c, zonal_c, model_.itcz_locality);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const Index here = static_cast<Index>(cell);
    const int row = grid_.row(here);
    month.pressure_hpa[cell] = static_cast<float>(
        three_cell_pressure_hpa(latitude_deg_[row], model_.circulation,
                                model_.itcz_share * trough_deg[grid_.column(here)]) +
        thermal_pressure_hpa(month.temperature_c[cell] - annual_mean_c[row]));
  }
}

/// Eddies, which mix the air's water and let it rain; mountains hold the flow back.
void SeasonalYear::stir(Month& month, std::span<const double> zonal_c) const {
  constexpr double kFastest_1_s = 0.01;  // on tiny planets: what mixes in minutes is mixed
  const std::vector<float> eddies =
      eddy_strength(grid_, latitude_deg_, month.temperature_c, zonal_c,
                    model_.eddy_gradient_k_1000km, model_.eddy_exponent, model_.eddy_locality);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double relative = height_m_[cell] / model_.blocking_height_m;
    month.open_flow[cell] = static_cast<float>(1.0 / (1.0 + relative * relative));
    const double spacing_m = grid_.spacing_north_m(grid_.row(static_cast<Index>(cell)));
    month.diffusivity[cell] = static_cast<float>(
        std::min(month.open_flow[cell] *
                     (model_.base_diffusivity_m2_s + model_.eddy_diffusivity_m2_s * eddies[cell]),
                 kFastest_1_s * spacing_m * spacing_m));
    month.own_eddies[cell] = static_cast<float>(model_.eddy_rain * eddies[cell]);
    month.gust_m_s[cell] =
        static_cast<float>(model_.gust_m_s * std::pow(eddies[cell], 1.0 / model_.eddy_exponent));
  }
}

/// What the air can hold, what sea and ground can give it, and a first guess of both.
void SeasonalYear::moisten(Month& month) const {
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
    month.column_mm[cell] = (has_sea_ ? 0.7 : 0.0) * saturated;
    month.land_evaporation_mm_d[cell] = has_sea_ ? static_cast<float>(0.5 * land_[cell]) *
                                                       month.potential_evapotranspiration_mm_d[cell]
                                                 : 0.0F;
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

/// What the sea gives to the air above it: the more, the faster that blows, and besides it warms
/// and moistens air that comes from colder places.
void SeasonalYear::evaporate_sea(Month& month) const {
  constexpr double kReference_m_s = 8.0;
  const std::vector<float> cooling_k_s =
      cold_advection_k_s(grid_, month.temperature_c, month.wind_east, month.wind_north);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double water = 1.0 - land_[cell];
    const double speed_m_s =
        wind_over_sea_m_s(month.wind_east[cell], month.wind_north[cell], month.gust_m_s[cell]);
    const double velocity_1_d =
        model_.moisture.evaporation_velocity_1_d * speed_m_s / kReference_m_s;
    const int row = grid_.row(static_cast<Index>(cell));
    month.open_water_1_d[cell] = static_cast<float>(
        water / (1.0 / velocity_1_d + month.saturated_mm[cell] / most_evaporation_mm_d_[row]));
    month.cold_air_evaporation_mm_d[cell] = static_cast<float>(
        water * model_.cold_air_heat_j_m2_k * cooling_k_s[cell] / kWattsPerMillimetreADay);
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
    if (has_sea_) evaporate_sea(month);
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
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    energy_k[cell] =
        static_cast<float>((energy_k[cell] - around_k[row]) *
                           weak_rotation(latitude_deg_[row], model_.convection_latitude_deg));
  }
  return energy_k;
}

/// Rising air rains out, and so does air that is lighter than its surroundings; sinking air keeps
/// its water.
void SeasonalYear::activate(Month& month) const {
  constexpr double kMost = 2.0;
  std::vector<float> rising = convergence(grid_, month.wind_east, month.wind_north);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double deep = weak_rotation(latitude_deg_[grid_.row(static_cast<Index>(cell))],
                                      model_.ascent_latitude_deg);
    rising[cell] = static_cast<float>(
        deep * kSecondsPerDay *
        (model_.ascent_time_d * rising[cell] - model_.descent_time_d * month.descent_1_s[cell]));
  }
  smooth(grid_, rising, 1000.0 * model_.ascent_smoothing_km);
  const std::vector<float> excess_k = convective_excess_k(month);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double lighter = model_.convection_1_k * excess_k[cell];
    month.activity[cell] = static_cast<float>(
        ascent_[cell] * std::exp(std::clamp(rising[cell] + lighter, -kMost, kMost)));
    month.eddies[cell] = ascent_[cell] * month.own_eddies[cell];
  }
}

/// Takes winds and activity over into the moisture budgets.
void SeasonalYear::exchange() {
  constexpr int kTogether = SteadyMoisture::kSeasons;
  static_assert(kMonths % kTogether == 0);
  std::vector<MoistureSeason> seasons;
  for (Month& month : months_) {
    for (std::size_t cell = 0; cell < size_; ++cell) {
      month.given_evaporation_mm_d[cell] =
          month.land_evaporation_mm_d[cell] + month.cold_air_evaporation_mm_d[cell];
    }
    seasons.push_back({month.wind_east, month.wind_north, month.diffusivity, month.activity,
                       month.eddies, month.saturated_mm, month.open_water_1_d,
                       month.given_evaporation_mm_d, month.column_mm});
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

void SeasonalYear::rain(bool closed) {
  constexpr int kTogether = SteadyMoisture::kSeasons;
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) {
    errors.guard([&] {
      Month& month = months_[m];
      if (closed) budgets_[m / kTogether]->close(m % kTogether);
      for (std::size_t cell = 0; cell < size_; ++cell) {
        month.rain_mm_d[cell] =
            rain_mm_d(model_.moisture, month.column_mm[cell], month.saturated_mm[cell],
                      month.activity[cell], month.eddies[cell]);
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
            return month.cold_air_evaporation_mm_d[cell] +
                   sea_evaporation_mm_d(month.column_mm[cell], month.saturated_mm[cell],
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
  constexpr int kRounds = 7, kLevelRounds = 3, kClosedRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    if (round == kLevelRounds && ascent) year.lift(ascent);
    year.blow();
    year.exchange();
    year.rain(/*closed=*/round + kClosedRounds >= kRounds);
    if (round + 1 < kRounds) year.evaporate();
  }
  return year.fields();
}

}  // namespace geo
