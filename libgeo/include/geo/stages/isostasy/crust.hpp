#pragma once

#include <cstdint>
#include <span>

#include "geo/core/stage.hpp"
#include "geo/kernels/crust/airy.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/isostasy/unit_noise.hpp"

namespace geo {

/// What the plates gave.
struct CrustInputs {
  std::span<const std::int16_t> plate;
  std::span<const std::int8_t> boundary_type;
  std::span<const float> boundary_strength, age_myr, heat, velocity_east, velocity_north;
  /// What the plates' history has made; empty unless crust = "simulated" or "given".
  std::span<const float> made_elevation_m = {};
  bool has_density = false;  ///< crust_density came with it
};

/// What all parts of the stage work with: its settings, the planet, fields read and written. V is
/// float in a run; a number that carries derivatives when they are wanted (core/numeric.hpp).
template <class V>
struct Crust {
  const IsostasyParameters& parameters;
  const Planet& planet;
  std::uint64_t seed;
  const Grid& grid;
  CrustInputs in;

  std::span<float> fraction;
  std::span<V> convergent, divergent, transform, weakness, thickness_m, density;
  std::span<std::int8_t> rock;
  std::span<float> erodibility;
  std::span<V> elevation_m;
  std::span<V> thickening_m_yr;  ///< by shortening; left to the landscape's run
  std::span<float> sediment_m;   ///< as rock without pores; empty where none asks for it

  /// How long belts grow while the landscape runs; 0: they stand as their sections have them.
  Arithmetic<V> run_myr{0.0};
  ActiveVariables<V> active = {};
  NoiseStore* noise = nullptr;  ///< keeps noise for further planets of this seed and grid

  [[nodiscard]] double radius_km() const { return 1e-3 * grid.figure().radius_m; }
  [[nodiscard]] BasicColumnDensities<Arithmetic<V>> densities() const {
    const ColumnDensities& d = parameters.density;
    return {active(d.mantle), active(d.continental_crust), active(d.oceanic_crust), active(d.water),
            active(d.sediment)};
  }
  [[nodiscard]] BasicAiryDatum<Arithmetic<V>> datum() const {
    return BasicAiryDatum<Arithmetic<V>>(densities());
  }
  [[nodiscard]] UnitNoise unit_noise(std::string_view stream, double wavelength_km, int octaves,
                                     double gain) const {
    return UnitNoise(grid, seed, stream, wavelength_km, octaves, gain, noise);
  }
};

}  // namespace geo
