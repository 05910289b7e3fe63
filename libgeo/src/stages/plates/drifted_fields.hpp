#pragma once

#include <cstdint>
#include <span>

#include "geo/core/stage.hpp"

namespace geo {

/// What drifting plates write for each cell, whichever model moved them.
struct DriftedFields {
  explicit DriftedFields(StageIo& io, bool knows_polarity = false)
      : plate(io.write(field::plate_id)),
        fraction(io.write(field::continental_fraction)),
        east(io.write(field::plate_velocity_east)),
        north(io.write(field::plate_velocity_north)),
        type(io.write(field::boundary_type)),
        strength(io.write(field::boundary_strength)),
        age(io.write(field::crust_age)),
        orogeny(io.write(field::orogeny_type)),
        heat(io.write(field::heat_anomaly)),
        polarity(knows_polarity ? io.write(field::subduction_polarity) : std::span<std::int8_t>()),
        elevation(io.write(field::crust_elevation)),
        thickness(io.write(field::crust_thickness)),
        orogeny_age(io.write(field::orogeny_age)),
        fold_east(io.write(field::fold_direction_east)),
        fold_north(io.write(field::fold_direction_north)),
        ridge_east(io.write(field::ridge_direction_east)),
        ridge_north(io.write(field::ridge_direction_north)) {}

  std::span<std::int16_t> plate;
  std::span<float> fraction, east, north;
  std::span<std::int8_t> type;
  std::span<float> strength, age;
  std::span<std::int8_t> orogeny;
  std::span<float> heat;
  std::span<std::int8_t> polarity;  ///< empty where the model does not know which plate subducts
  std::span<float> elevation, thickness, orogeny_age;
  std::span<float> fold_east, fold_north, ridge_east, ridge_north;
};

}  // namespace geo
