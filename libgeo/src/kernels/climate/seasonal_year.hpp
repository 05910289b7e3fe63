#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/moisture.hpp"
#include "geo/kernels/climate/mountain_barrier.hpp"
#include "geo/kernels/climate/seasonal_climate.hpp"

namespace geo {

/// One month's air and what it exchanges with the ground, one value per cell.
struct AirOfMonth {
  std::vector<float> temperature_c;  ///< at sea level
  std::vector<float> pressure_hpa;   ///< along parallels, without waves
  CellWinds cells;
  std::vector<double> zonal_wind_m_s;
  std::vector<float> wind_east, wind_north, descent_1_s;
  std::vector<float> wave_east, wave_north;    ///< of the wind
  std::vector<float> force_east, force_north;  ///< of land on it, m s-2
  std::vector<float> diffusivity, own_eddies, eddies, activity, saturated_mm, open_water_1_d;
  std::vector<float> gust_m_s;  ///< of eddies
  std::vector<float> potential_evapotranspiration_mm_d, soil_evaporation_mm_d,
      land_evaporation_mm_d;
  std::vector<float> cold_air_evaporation_mm_d;  ///< from water under air that comes from the cold
  std::vector<float> given_evaporation_mm_d;     ///< both, whatever the column holds
  std::vector<float> heating_w_m2;
  std::vector<double> column_mm, rain_mm_d;
  std::vector<double> sun_w_m2;  ///< per row
};

/// The year that is being solved. First warm(), which gives temperatures and all that follows from
/// them alone (seasonal_start.cpp); then rounds of winds, moisture and rain, each with the heat of
/// the rain before (seasonal_climate.cpp). After some of them warm_again(): the winds along the
/// equator say where cold water wells up.
class SeasonalYear {
 public:
  SeasonalYear(const Grid& grid, const SeasonalClimate& model, std::span<const double> latitude_deg,
               std::span<const float> land_fraction, std::span<const float> height_m,
               std::span<const float> glacier_fraction)
      : grid_(grid),
        model_(model),
        latitude_deg_(latitude_deg),
        land_(land_fraction),
        height_m_(height_m),
        glacier_(glacier_fraction),
        size_(static_cast<std::size_t>(grid.size())),
        open_flow_(share_of_open_flow()),
        barrier_(grid, open_flow_),
        ascent_(size_, 1.0F),
        has_sea_(model.moisture.evaporation_velocity_1_d > 0.0 &&
                 std::any_of(land_fraction.begin(), land_fraction.end(),
                             [](float land) { return land < 1.0F; })) {}

  void warm();
  void warm_again();
  void blow();
  void exchange();
  void rain(double closed_to);
  void evaporate();
  void lift(const TerrainAscent& ascent);
  [[nodiscard]] SeasonalFields fields() const;

 private:
  [[nodiscard]] std::vector<float> share_of_open_flow() const;
  [[nodiscard]] double thermal_pressure_hpa(double warmer_k) const;
  void carry_heat(std::span<const float> month_c, std::span<const double> annual_mean_c,
                  std::span<float> east, std::span<float> north) const;
  [[nodiscard]] std::vector<double> equatorial_wind_m_s() const;
  void begin_months(std::span<const double> equatorial_wind_m_s);
  void find_warm_sea(std::span<const double> equatorial_wind_m_s);
  void begin_month(int m);
  void clear(AirOfMonth& month) const;
  [[nodiscard]] std::vector<double> roughness_of_rows() const;
  void press(AirOfMonth& month, std::span<const double> zonal_c, std::span<const float> trough_c,
             std::span<const float> low_c, std::span<const double> annual_mean_c) const;
  void stir(AirOfMonth& month, std::span<const double> zonal_c) const;
  void moisten(AirOfMonth& month) const;
  void guess(AirOfMonth& month) const;
  void hold_back(AirOfMonth& month) const;
  void add_waves(AirOfMonth& month) const;
  void add_cells(AirOfMonth& month) const;
  void heat_air(AirOfMonth& month) const;
  void evaporate_sea(AirOfMonth& month) const;
  void activate(AirOfMonth& month) const;
  [[nodiscard]] std::vector<float> convective_excess_k(const AirOfMonth& month) const;
  void evaporate_cell(std::size_t cell);
  [[nodiscard]] AirWater water() const;
  [[nodiscard]] double inversion_k(const AirOfMonth& month, std::size_t cell) const;
  [[nodiscard]] double dryness(const AirOfMonth& month, std::size_t cell) const;
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
  std::span<const float> land_, height_m_, glacier_;
  std::size_t size_;
  std::array<AirOfMonth, kMonths> months_;
  std::optional<EnergyBalanceYear> temperatures_;  ///< until winds have said where water wells up
  std::vector<float> open_flow_;                   ///< share of it that topography lets pass
  MountainBarrier barrier_;
  std::vector<float> ascent_;        ///< of single ranges
  std::vector<float> sea_warmer_k_;  ///< than the air above it, where currents bring heat
  std::vector<float> warmer_below_eddies_k_;
  std::vector<double> most_evaporation_mm_d_;
  std::vector<std::optional<SteadyMoisture>> budgets_;
  bool has_sea_;
};

}  // namespace geo
