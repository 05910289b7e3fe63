#pragma once

#include <cstdint>
#include <span>

#include "geo/core/stage.hpp"
#include "geo/stages/isostasy.hpp"

namespace geo {

/// What all parts of the stage work with: its settings, the planet, fields read and written.
struct Crust {
  Crust(const IsostasyParameters& settings, StageIo& io, const Context& context);

  const IsostasyParameters& parameters;
  const Planet& planet;
  std::uint64_t seed;
  const Grid& grid;
  double radius_km;
  AiryDatum datum;

  std::span<const std::int16_t> plate;
  std::span<const std::int8_t> boundary_type;
  std::span<const float> boundary_strength, age_myr, heat, velocity_east, velocity_north;

  /// What the plates' history has made; empty unless crust = "simulated".
  std::span<const float> made_elevation_m;

  std::span<float> fraction, convergent, divergent, transform, weakness, thickness_m, density;
  std::span<std::int8_t> rock;
  std::span<float> erodibility, elevation_m;
};

}  // namespace geo
