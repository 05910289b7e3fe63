#include "geo/kernels/climate/seasonal_climate.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <span>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/thermodynamics.hpp"
#include "geo/kernels/numerics/area_sum.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerYear = 365.25, kSecondsPerDay = 86400.0;

std::vector<double> row_means(const Grid& grid, std::span<const double> values) {
  std::vector<double> means(grid.ny(), 0.0);
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) means[j] += values[grid.cell(i, j)];
    means[j] /= grid.nx();
  }
  return means;
}

/// Latitude of the warmest parallels: their mean, weighted by exp(T / 1.5 K).
double thermal_equator_deg(std::span<const double> latitude_deg,
                           std::span<const double> zonal_temperature) {
  constexpr double kSharpness_k = 1.5;
  const double warmest = *std::max_element(zonal_temperature.begin(), zonal_temperature.end());
  double weight = 0.0, moment = 0.0;
  for (std::size_t j = 0; j < latitude_deg.size(); ++j) {
    const double w = std::cos(latitude_deg[j] * kRadians) *
                     std::exp((zonal_temperature[j] - warmest) / kSharpness_k);
    weight += w;
    moment += w * latitude_deg[j];
  }
  return moment / weight;
}

/// Strength of eddies per row: the zonal-mean temperature gradient over the reference one, taken
/// over about 10 degrees.
std::vector<double> eddy_strength(const Grid& grid, std::span<const double> latitude_deg,
                                  std::span<const double> zonal_temperature,
                                  double reference_k_1000km) {
  const int ny = grid.ny();
  std::vector<double> strength(ny, 0.0);
  if (latitude_deg[0] == latitude_deg[ny - 1]) return strength;  // a torus at one latitude
  const int reach = std::max(1, ny / 36);
  const double radius_1000km = grid.figure().radius_m / 1.0e6;
  for (int j = 0; j < ny; ++j) {
    const int south = std::max(0, j - reach), north = std::min(ny - 1, j + reach);
    const double distance = (latitude_deg[north] - latitude_deg[south]) * kRadians * radius_1000km;
    strength[j] = std::abs(zonal_temperature[north] - zonal_temperature[south]) / distance /
                  reference_k_1000km;
  }
  return strength;
}

/// Horizontal convergence of the winds, s-1, from face-normal velocities.
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

struct Month {
  std::vector<float> wind_east, wind_north, diffusivity, eddies, saturated_mm, evaporation_mm_d,
      land_evaporation_mm_d, open_water_1_d;
  std::vector<double> column_mm, rain_mm_d;
};

void mean_winds(std::span<const Month> months, std::vector<float>& wind_east,
                std::vector<float>& wind_north) {
  const std::size_t size = months[0].wind_east.size();
  wind_east.resize(size);
  wind_north.resize(size);
  for (std::size_t cell = 0; cell < size; ++cell) {
    double east = 0.0, north = 0.0;
    for (const Month& month : months) {
      east += month.wind_east[cell];
      north += month.wind_north[cell];
    }
    wind_east[cell] = static_cast<float>(east / kMonths);
    wind_north[cell] = static_cast<float>(north / kMonths);
  }
}

AirWater sum_water(const Grid& grid, std::span<const Month> months) {
  constexpr double kPerMillimetreADay = 1.0e-3 / kSecondsPerDay / kMonths;
  const auto over_the_year = [&](const auto& of_month) {
    return kPerMillimetreADay * area_sum<double>(grid, [&](Index cell) {
             double sum = 0.0;
             for (const Month& month : months) sum += of_month(month, cell);
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

}  // namespace

SeasonalFields solve_seasonal_climate(const Grid& grid, const SeasonalClimate& model,
                                      std::span<const double> latitude_deg,
                                      std::span<const float> land_fraction,
                                      std::span<const float> height_m, const ReliefAscent& ascent) {
  const int nx = grid.nx(), ny = grid.ny();
  const std::size_t size = static_cast<std::size_t>(grid.size());
  std::vector<double> mean_c(size);
  std::vector<std::complex<double>> harmonic_k(size);
  solve_energy_balance(grid, model.energy, latitude_deg, land_fraction, height_m, mean_c,
                       harmonic_k);
  const std::vector<double> zonal_mean_c = row_means(grid, mean_c);

  // Without open water that gives any away, the air is dry.
  const bool has_sea = model.moisture.evaporation_velocity_1_d > 0.0 &&
                       std::any_of(land_fraction.begin(), land_fraction.end(),
                                   [](float land) { return land < 1.0F; });
  constexpr double kWattsPerMillimetreADay = 28.36;
  std::vector<double> most_evaporation_mm_d(ny);
  for (int j = 0; j < ny; ++j) {
    const auto sun = insolation_cycle(latitude_deg[j], model.energy.obliquity_deg,
                                      model.energy.solar_constant_w_m2);
    most_evaporation_mm_d[j] = std::max(
        1.0e-6, model.moisture.evaporating_share * sun.mean_w_m2 / kWattsPerMillimetreADay);
  }

  std::vector<Month> months(kMonths);
  const auto compute_month = [&](int m) {
    Month& month = months[m];
    const auto phase = std::polar(1.0, month_solar_longitude_deg(m) * kRadians);
    std::vector<double> temperature_c(size);
    for (std::size_t cell = 0; cell < size; ++cell) {
      temperature_c[cell] = mean_c[cell] + (harmonic_k[cell] * phase).real();
    }
    const auto zonal_c = row_means(grid, temperature_c);
    const double itcz_deg = model.itcz_share * thermal_equator_deg(latitude_deg, zonal_c);
    const auto eddies = eddy_strength(grid, latitude_deg, zonal_c, model.eddy_gradient_k_1000km);
    std::vector<float> anomaly_k(size);
    month.diffusivity.resize(size);
    month.eddies.resize(size);
    month.saturated_mm.resize(size);
    month.evaporation_mm_d.resize(size);
    month.column_mm.resize(size);
    month.rain_mm_d.resize(size);
    month.land_evaporation_mm_d.resize(size);
    month.open_water_1_d.resize(size);
    month.wind_east.resize(size);
    month.wind_north.resize(size);
    for (int j = 0; j < ny; ++j) {
      const double insolation =
          daily_insolation_w_m2(latitude_deg[j], month_solar_longitude_deg(m),
                                model.energy.obliquity_deg, model.energy.solar_constant_w_m2);
      for (int i = 0; i < nx; ++i) {
        const Index here = grid.cell(i, j);
        const double surface_c = temperature_c[here] - model.energy.lapse_k_m * height_m[here];
        anomaly_k[here] = static_cast<float>(temperature_c[here] - zonal_mean_c[j]);
        month.diffusivity[here] = static_cast<float>(model.base_diffusivity_m2_s +
                                                     model.eddy_diffusivity_m2_s * eddies[j]);
        month.eddies[here] = static_cast<float>(1.0 + model.eddy_rain * eddies[j]);
        const double lifted_c =
            temperature_c[here] - model.energy.lapse_k_m * model.orographic_share * height_m[here];
        const double saturated = saturated_column_mm(lifted_c);
        month.saturated_mm[here] = static_cast<float>(saturated);
        month.evaporation_mm_d[here] =
            static_cast<float>(oudin_evaporation_mm_d(insolation, surface_c));
        // Evaporation in series with the energy that the sun gives through the year.
        const double resistance_d =
            1.0 / model.moisture.evaporation_velocity_1_d + saturated / most_evaporation_mm_d[j];
        month.open_water_1_d[here] = static_cast<float>((1.0 - land_fraction[here]) / resistance_d);
        month.column_mm[here] = (has_sea ? 0.7 : 0.0) * saturated;
      }
    }
    thermal_winds(grid, model.circulation, latitude_deg, itcz_deg, land_fraction, anomaly_k,
                  month.wind_east, month.wind_north);
    for (std::size_t cell = 0; cell < size; ++cell) {
      const double relative = height_m[cell] / model.blocking_height_m;
      const auto open = static_cast<float>(1.0 / (1.0 + relative * relative));
      month.wind_east[cell] *= open;
      month.wind_north[cell] *= open;
      month.diffusivity[cell] *= open;
    }
    // Rising air rains out, sinking air keeps its water.
    const auto converging = convergence(grid, month.wind_east, month.wind_north);
    for (std::size_t cell = 0; cell < size; ++cell) {
      constexpr float kMost = 2.0F;
      const float ascent =
          converging[cell] * static_cast<float>(model.ascent_time_d * kSecondsPerDay);
      month.eddies[cell] *= std::exp(std::clamp(ascent, -kMost, kMost));
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int m = 0; m < kMonths; ++m) errors.guard([&] { compute_month(m); });
  errors.rethrow();

  SeasonalFields fields;
  mean_winds(months, fields.wind_east, fields.wind_north);
  if (ascent) {
    const std::vector<float> more = ascent(fields.wind_east, fields.wind_north);
    for (Month& month : months) {
      for (std::size_t cell = 0; cell < size; ++cell) month.eddies[cell] *= more[cell];
    }
  }

  std::vector<MoistureSeason> seasons;
  for (Month& month : months) {
    seasons.push_back({month.wind_east, month.wind_north, month.diffusivity, month.eddies,
                       month.saturated_mm, month.open_water_1_d, month.land_evaporation_mm_d,
                       month.column_mm});
  }
  constexpr int kTogether = SteadyMoisture::kSeasons;
  static_assert(kMonths % kTogether == 0);
  std::vector<std::optional<SteadyMoisture>> budgets(kMonths / kTogether);
  const auto start_budget = [&](std::size_t k) {
    budgets[k].emplace(grid, model.moisture, std::span(seasons).subspan(k * kTogether, kTogether));
  };
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < budgets.size(); ++k) errors.guard([&] { start_budget(k); });
  errors.rethrow();

  // Land returns what Budyko's curve says of the rain that the last round gave it.
  constexpr int kRounds = 4;
  std::vector<float> evaporative_share(size, has_sea ? 0.5F : 0.0F);
  for (int round = 0; round < kRounds; ++round) {
#pragma omp parallel for schedule(dynamic, 1)
    for (int m = 0; m < kMonths; ++m) {
      Month& month = months[m];
      for (std::size_t cell = 0; cell < size; ++cell) {
        month.land_evaporation_mm_d[cell] =
            static_cast<float>(model.land_transpiration * land_fraction[cell] *
                               evaporative_share[cell] * month.evaporation_mm_d[cell]);
      }
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t k = 0; k < budgets.size(); ++k) {
      errors.guard([&] { budgets[k]->solve(); });
    }
    errors.rethrow();
    const bool last_round = round + 1 == kRounds;
    if (last_round) {
#pragma omp parallel for schedule(dynamic, 1)
      for (int m = 0; m < kMonths; ++m) {
        errors.guard([&] { budgets[m / kTogether]->close(m % kTogether); });
      }
      errors.rethrow();
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int m = 0; m < kMonths; ++m) {
      Month& month = months[m];
      for (std::size_t cell = 0; cell < size; ++cell) {
        month.rain_mm_d[cell] = rain_mm_d(model.moisture, month.column_mm[cell],
                                          month.saturated_mm[cell], month.eddies[cell]);
      }
    }
    if (last_round) break;
    for (std::size_t cell = 0; cell < size; ++cell) {
      double rain = 0.0, potential = 0.0;
      for (const Month& month : months) {
        rain += month.rain_mm_d[cell];
        potential += month.evaporation_mm_d[cell];
      }
      evaporative_share[cell] =
          potential > 0.0
              ? static_cast<float>(rain / potential *
                                   budyko_evaporated_share(rain > 0.0 ? potential / rain : 0.0))
              : 0.0F;
    }
  }

  fields.water = sum_water(grid, months);
  for (auto* values : {&fields.temperature_c, &fields.harmonic_cos_k, &fields.harmonic_sin_k,
                       &fields.precipitation_mm_yr, &fields.boreal_rain_share, &fields.humidity}) {
    values->resize(size);
  }
  for (std::size_t cell = 0; cell < size; ++cell) {
    double rain = 0.0, boreal = 0.0, humidity = 0.0;
    for (int m = 0; m < kMonths; ++m) {
      const Month& month = months[m];
      rain += month.rain_mm_d[cell];
      boreal += month.rain_mm_d[cell] * std::cos((m - 6) * 30.0 * kRadians);
      humidity += month.column_mm[cell] / month.saturated_mm[cell];
    }
    fields.temperature_c[cell] = static_cast<float>(mean_c[cell]);
    fields.harmonic_cos_k[cell] = static_cast<float>(harmonic_k[cell].real());
    fields.harmonic_sin_k[cell] = static_cast<float>(harmonic_k[cell].imag());
    fields.precipitation_mm_yr[cell] = static_cast<float>(rain / kMonths * kDaysPerYear);
    fields.boreal_rain_share[cell] = static_cast<float>(rain > 0.0 ? 2.0 * boreal / rain : 0.0);
    fields.humidity[cell] = static_cast<float>(humidity / kMonths);
  }
  return fields;
}

}  // namespace geo
