#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "climate_events.hpp"
#include "climate_frame.hpp"
#include "geo/core/climatology.hpp"
#include "geo/core/stage.hpp"
#include "geo/kernels/climate/seasonal_climate.hpp"
#include "geo/stages/climate/climate.hpp"

namespace geo {

/// The outputs of the stage.
struct ClimateOutputs {
  std::span<float> temperature, temperature_range, precipitation, seasonality, wind_east,
      wind_north, coast, evaporation, sea_ice, current_east, current_north;
  std::span<std::int8_t> koppen;
};

/// Range of the blueprint's temperatures; of the energy balance's, wider where the air is much
/// thicker or thinner. What would leave it is held at its end, and counted.
struct TemperatureLimits {
  static TemperatureLimits of_air(double pressure_bar) {
    const double wider_k = 40.0 * std::abs(std::log(pressure_bar));
    return {static_cast<float>(std::max(-270.0, -70.0 - wider_k)),
            static_cast<float>(55.0 + wider_k)};
  }
  [[nodiscard]] bool hold(float& temperature_c) const {
    const float held_c = std::clamp(temperature_c, lowest_c, highest_c);
    const bool changed = held_c != temperature_c;
    temperature_c = held_c;
    return changed;
  }
  [[nodiscard]] bool is_end(float temperature_c) const {
    return temperature_c <= lowest_c || temperature_c >= highest_c;
  }
  float lowest_c = -70.0F, highest_c = 55.0F;
};

/// The coarse year at the stage's own cells: their elevation, single ranges, noise and events.
class FineClimate {
 public:
  /// `land_fraction` is that of coarse cells. `on_topography` is the ascent over single ranges, of
  /// which `planet_ascent` is the mean over each coarse cell; with the blueprint's closed formulas
  /// it is their rain.
  FineClimate(const ClimateFrame& frame, const ClimateParameters& parameters,
              const SeasonalClimate& model, const SeasonalFields& fields,
              std::span<const float> land_fraction, std::span<const float> planet_ascent,
              std::span<const float> on_topography, const DimmedSun& dimmed,
              const Context& context);
  ~FineClimate();
  FineClimate(const FineClimate&) = delete;
  FineClimate& operator=(const FineClimate&) = delete;

  /// Writes all outputs; how many cells of each row were held at an end of the temperatures' range.
  std::vector<std::int64_t> fill(std::span<const float> elevation, const ClimateOutputs& out) const;
  [[nodiscard]] const TemperatureLimits& limits() const;
  [[nodiscard]] std::shared_ptr<const Climatology> year() const;

 private:
  class Rows;
  std::unique_ptr<const Rows> rows_;
};

}  // namespace geo
