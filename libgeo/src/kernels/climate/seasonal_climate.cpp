#include "geo/kernels/climate/seasonal_climate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "kernels/climate/zonal.hpp"
#include "seasonal_year.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerMonth = 365.25 / kMonths, kSecondsPerDay = 86400.0;
constexpr double kWattsPerMillimetreADay = 28.9;  // latent heat of rain
constexpr double kLatentOverHeat_k = 2.5e6 / 1004.0;

/// How far a latitude is one where planetary rotation is weak: half where the Coriolis parameter is
/// that of the Earth at the edge.
double weak_rotation(double latitude_deg, double edge_deg, const Circulation& circulation) {
  const double days = circulation.rotation_rad_s() / Circulation{}.rotation_rad_s();
  const double turning = days * (std::sin(latitude_deg * kRadians) / std::sin(edge_deg * kRadians));
  return 1.0 / (1.0 + turning * turning * turning * turning);
}

/// x near 0, within a bound everywhere.
double bounded(double x, double bound) { return bound * std::tanh(x / bound); }

}  // namespace

/// Heat that the air gets from rain, from ground that is warmer than its parallel and from sea that
/// is warmer than the air.
void SeasonalYear::heat_air(AirOfMonth& month) const {
  constexpr double kRelaxed = 0.5;
  const double dry = dry_sea_exchange_w_m2_k(model_.energy);
  const std::vector<double> zonal_c = row_means<float>(grid_, month.temperature_c);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double warmer_k =
        month.temperature_c[cell] - zonal_c[grid_.row(static_cast<Index>(cell))];
    const double heating = kWattsPerMillimetreADay * month.rain_mm_d[cell] +
                           model_.sensible_w_m2_k * land_[cell] * warmer_k +
                           dry * (1.0 - land_[cell]) * sea_warmer_k_[cell];
    month.heating_w_m2[cell] += static_cast<float>(kRelaxed * (heating - month.heating_w_m2[cell]));
  }
}

/// What the sea gives to the air above it: the more, the faster that blows, and besides it warms
/// and moistens air that comes from colder places.
void SeasonalYear::evaporate_sea(AirOfMonth& month) const {
  constexpr double kReference_m_s = 8.0, kSaturation_1_k = 0.065, kMostDew = 0.3;
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
    // At warm water the air is saturated with more.
    const double more = std::max(-kMostDew, std::expm1(kSaturation_1_k * sea_warmer_k_[cell]));
    month.cold_air_evaporation_mm_d[cell] = static_cast<float>(
        water * model_.cold_air_heat_j_m2_k * cooling_k_s[cell] / kWattsPerMillimetreADay +
        more * month.open_water_1_d[cell] * month.saturated_mm[cell]);
  }
}

/// Land holds the wind back by the force -d e v. What is known is the wind of the round before: the
/// force goes towards that as far as the wind may answer, which is by 1 / e where the planet's
/// rotation is weak.
void SeasonalYear::hold_back(AirOfMonth& month) const {
  const double damping_1_s = 1.0 / (model_.wave.internal.momentum_damping_d * kSecondsPerDay);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double drag = model_.land_drag * land_[cell], share = 1.0 / (1.0 + drag);
    const auto approach = [&](float& force, float wind) {
      force += static_cast<float>(share * (-drag * damping_1_s * wind - force));
    };
    approach(month.force_east[cell], month.wind_east[cell]);
    approach(month.force_north[cell], month.wind_north[cell]);
  }
}

/// Winds of cells and heat lows, and waves with them.
void SeasonalYear::add_waves(AirOfMonth& month) const {
  constexpr int kRounds = 2;  // of waves and the drag on them
  const std::vector<float> balanced_east = month.wind_east, balanced_north = month.wind_north;
  const auto add = [&] {
    for (std::size_t cell = 0; cell < size_; ++cell) {
      month.wind_east[cell] = balanced_east[cell] + month.wave_east[cell];
      month.wind_north[cell] = balanced_north[cell] + month.wave_north[cell];
    }
  };
  for (int round = 0; round < kRounds; ++round) {
    add();
    hold_back(month);
    stationary_wave(grid_, model_.wave, model_.circulation.rotation_rad_s(), latitude_deg_,
                    month.zonal_wind_m_s,
                    {month.heating_w_m2, month.force_east, month.force_north, height_m_},
                    {month.wave_east, month.wave_north, month.descent_1_s});
  }
  add();
}

void SeasonalYear::add_cells(AirOfMonth& month) const {
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const int row = grid_.row(static_cast<Index>(cell));
    month.wind_east[cell] += static_cast<float>(month.cells.east[row]);
    month.wind_north[cell] += static_cast<float>(month.cells.north[row]);
  }
}

/// Winds of cells, heat lows and waves, as mountains turn them.
void SeasonalYear::blow() {
  for_months([&](AirOfMonth& month) {
    balanced_winds(grid_, model_.circulation, latitude_deg_, land_, month.pressure_hpa,
                   month.wind_east, month.wind_north);
    if (grid_.topology() == Topology::sphere) {
      add_cells(month);
      heat_air(month);
      add_waves(month);
    }
    barrier_.turn_aside(model_.turned_share, month.wind_east, month.wind_north);
    if (has_sea_) evaporate_sea(month);
    activate(month);
  });
}

/// How far the moist static energy near the ground, in kelvins of dry air, exceeds that of the
/// tropics: where planetary rotation is weak, the free atmosphere above is level.
std::vector<float> SeasonalYear::convective_excess_k(const AirOfMonth& month) const {
  constexpr double kDryLapse_k_m = 0.0098, kSurfacePressure_pa = 1.0e5;
  std::vector<float> energy_k(size_, 0.0F);
  if (!(model_.convection_1_k > 0.0)) return energy_k;
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double at_sea_c = month.temperature_c[cell], height_m = height_m_[cell];
    const double surface_c = at_sea_c - model_.energy.lapse_k_m * height_m;
    const double humidity = 0.622 * saturation_pressure_pa(surface_c) / kSurfacePressure_pa *
                            std::min(1.0, month.column_mm[cell] / month.saturated_mm[cell]);
    energy_k[cell] =
        static_cast<float>(surface_c + kDryLapse_k_m * height_m + kLatentOverHeat_k * humidity);
  }
  const auto weak = [&](Index cell) {
    return weak_rotation(latitude_deg_[grid_.row(cell)], model_.convection_latitude_deg,
                         model_.circulation);
  };
  const double tropics_k = area_sum<double>(grid_, [&](Index c) { return weak(c) * energy_k[c]; }) /
                           area_sum<double>(grid_, weak);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    energy_k[cell] =
        static_cast<float>((energy_k[cell] - tropics_k) * weak(static_cast<Index>(cell)));
  }
  return energy_k;
}

/// Rising air rains out, and so does air that is lighter than its surroundings; sinking air keeps
/// its water, also where eddies stir it.
void SeasonalYear::activate(AirOfMonth& month) const {
  constexpr double kMostConvection = 3.0;  // of the logarithm of rain-out
  std::vector<float> rising = convergence(grid_, month.wind_east, month.wind_north);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double deep = weak_rotation(latitude_deg_[grid_.row(static_cast<Index>(cell))],
                                      model_.ascent_latitude_deg, model_.circulation);
    rising[cell] = static_cast<float>(
        deep * kSecondsPerDay *
        (model_.ascent_time_d * rising[cell] - model_.descent_time_d * month.descent_1_s[cell]));
  }
  smooth(grid_, rising, 1000.0 * model_.ascent_smoothing_km);
  const std::vector<float> excess_k = convective_excess_k(month);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    const double lighter =
        bounded(model_.convection_1_k * excess_k[cell] +
                    model_.sea_convection_1_k * (1.0 - land_[cell]) * sea_warmer_k_[cell],
                kMostConvection);
    const double moving = rising[cell] > 0.0F ? bounded(rising[cell], model_.ascent_bound)
                                              : bounded(rising[cell], model_.descent_bound);
    month.activity[cell] = static_cast<float>(ascent_[cell] * std::exp(moving + lighter));
    month.eddies[cell] =
        static_cast<float>(ascent_[cell] * month.own_eddies[cell] *
                           std::exp(model_.eddy_descent_share * std::min(0.0, moving)));
  }
}

/// Takes winds and activity over into the moisture budgets.
void SeasonalYear::exchange() {
  constexpr int kTogether = SteadyMoisture::kSeasons;
  static_assert(kMonths % kTogether == 0);
  std::vector<MoistureSeason> seasons;
  for (AirOfMonth& month : months_) {
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

void SeasonalYear::rain(double closed_to) {
  constexpr int kTogether = SteadyMoisture::kSeasons;
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) {
    errors.guard([&] {
      AirOfMonth& month = months_[m];
      if (closed_to > 0.0) budgets_[m / kTogether]->close(m % kTogether, closed_to);
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
    const AirOfMonth& month = months_[m];
    temperature_c[m] = month.temperature_c[cell] - model_.energy.lapse_k_m * height_m_[cell];
    rain_mm[m] = kDaysPerMonth * month.rain_mm_d[cell];
    potential_mm[m] = kDaysPerMonth * month.potential_evapotranspiration_mm_d[cell];
  }
  const auto evaporation_mm =
      soil_evaporation_mm(model_.soil, temperature_c, rain_mm, potential_mm);
  for (int m = 0; m < kMonths; ++m) {
    months_[m].soil_evaporation_mm_d[cell] =
        static_cast<float>(land_[cell] * evaporation_mm[m] / kDaysPerMonth);
    months_[m].land_evaporation_mm_d[cell] =
        static_cast<float>(model_.land_transpiration) * months_[m].soil_evaporation_mm_d[cell];
  }
}

void SeasonalYear::lift(const TerrainAscent& ascent) {
  std::vector<float> east(size_), north(size_);
  for (std::size_t cell = 0; cell < size_; ++cell) {
    double sum_east = 0.0, sum_north = 0.0;
    for (const AirOfMonth& month : months_) {
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
             for (const AirOfMonth& month : months_) sum += of_month(month, cell);
             return sum;
           });
  };
  return {.sea_evaporation_m3_s = over_the_year([](const AirOfMonth& month, Index cell) {
            return month.cold_air_evaporation_mm_d[cell] +
                   sea_evaporation_mm_d(month.column_mm[cell], month.saturated_mm[cell],
                                        month.open_water_1_d[cell]);
          }),
          .land_evaporation_m3_s = over_the_year([](const AirOfMonth& month, Index cell) {
            return month.land_evaporation_mm_d[cell];
          }),
          .precipitation_m3_s = over_the_year(
              [](const AirOfMonth& month, Index cell) { return month.rain_mm_d[cell]; })};
}

/// Share of the sun's heat on land that dry ground does not use up by evaporation: 1 where soil
/// gives nothing, 0 where it gives four fifths of the potential evapotranspiration or more.
double SeasonalYear::dryness(const AirOfMonth& month, std::size_t cell) const {
  constexpr double kMoist = 0.8;
  const double potential = land_[cell] * month.potential_evapotranspiration_mm_d[cell];
  if (!(potential > 0.0)) return 0.0;
  return land_[cell] * std::max(0.0, 1.0 - month.soil_evaporation_mm_d[cell] / potential / kMoist);
}

/// By how much snow-covered ground is colder than the air above it: without the sun it radiates
/// what no warmer air replaces, the more so the colder and drier that is.
double SeasonalYear::inversion_k(const AirOfMonth& month, std::size_t cell) const {
  constexpr double kSnow_c = -5.0, kSnowWidth_k = 2.5, kDry_c = -10.0;
  const EnergyBalance& energy = model_.energy;
  const double sun_w_m2 = month.sun_w_m2[grid_.row(static_cast<Index>(cell))];
  const double night = std::max(0.0, 1.0 - sun_w_m2 / energy.inversion_below_w_m2);
  const double air_c = month.temperature_c[cell] - energy.lapse_k_m * height_m_[cell];
  const double snow = 1.0 / (1.0 + std::exp((air_c - kSnow_c) / kSnowWidth_k));
  return land_[cell] * night * snow *
         (energy.inversion_k + energy.inversion_growth * std::max(0.0, kDry_c - air_c));
}

SeasonalFields SeasonalYear::fields() const {
  SeasonalFields fields;
  fields.water = water();
  for (int m = 0; m < kMonths; ++m) {
    const AirOfMonth& month = months_[m];
    fields.temperature_c[m] = month.temperature_c;
    for (std::size_t cell = 0; cell < size_; ++cell) {
      const double sun_w_m2 = month.sun_w_m2[grid_.row(static_cast<Index>(cell))];
      fields.temperature_c[m][cell] +=
          static_cast<float>(dryness(month, cell) * model_.energy.dry_warming_k_m2_w *
                                 (sun_w_m2 - model_.energy.dry_warming_from_w_m2) -
                             inversion_k(month, cell));
    }
    fields.wind_east[m] = month.wind_east;
    fields.wind_north[m] = month.wind_north;
    fields.precipitation_mm[m].resize(size_);
    for (std::size_t cell = 0; cell < size_; ++cell) {
      fields.precipitation_mm[m][cell] = static_cast<float>(kDaysPerMonth * month.rain_mm_d[cell]);
    }
  }
  return fields;
}

SeasonalFields solve_seasonal_climate(const Grid& grid, const SeasonalClimate& model,
                                      std::span<const double> latitude_deg,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m, const TerrainAscent& ascent,
                                      std::span<const float> glacier_fraction) {
  check_sizes("solve_seasonal_climate", grid.ny(), {{"latitude_deg", latitude_deg.size()}});
  check_sizes("solve_seasonal_climate", grid.size(),
              {{"land_fraction", land_fraction.size()},
               {"height_m", height_m.size()},
               {"glacier_fraction", glacier_fraction.size(), ArraySize::May::be_empty}});
  SeasonalYear year(grid, model, latitude_deg, land_fraction, height_m, glacier_fraction);
  year.warm();
  constexpr int kRounds = 7, kTradesRounds = 2, kLevelRounds = 3;
  constexpr double kNearlyClosed = 1e-4, kClosed = 1e-7;
  for (int round = 0; round < kRounds; ++round) {
    if (round == kTradesRounds) year.warm_again();
    if (round == kLevelRounds && ascent) year.lift(ascent);
    year.blow();
    year.exchange();
    year.rain(round + 1 == kRounds ? kClosed : round + 2 == kRounds ? kNearlyClosed : 0.0);
    if (round + 1 < kRounds) year.evaporate();
  }
  return year.fields();
}

}  // namespace geo
