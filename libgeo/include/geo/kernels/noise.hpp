#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace geo {

/// Coherent noise in three dimensions: a function of position and seed alone, the same at any
/// resolution. Lattice gradients and values come from the counter-based generator.
class Noise {
 public:
  Noise(std::uint64_t seed, std::string_view stream);

  /// Gradient noise (Perlin 2002, quintic fade), about [-1, 1], zero mean, wavelength 1.
  [[nodiscard]] float gradient(float x, float y, float z) const;
  /// Value noise, quintic interpolation of uniform lattice values in [-1, 1].
  [[nodiscard]] float value(float x, float y, float z) const;
  /// Fractional Brownian motion: sum of `octaves` of gradient noise, frequency doubled and
  /// amplitude times `gain` each (gain = 2^-H), divided by the sum of amplitudes.
  [[nodiscard]] float fbm(const std::array<double, 3>& position, double frequency, int octaves,
                          double gain = 0.5) const;

 private:
  std::array<std::uint32_t, 4> key_;
};

}  // namespace geo
