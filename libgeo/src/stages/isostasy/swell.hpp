#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "geo/kernels/noise.hpp"

namespace geo {

/// Gradient noise of several octaves scaled to unit standard deviation.
class Swell {
 public:
  Swell(std::uint64_t seed, std::string_view stream, double radius_km, double wavelength_km,
        int octaves, double gain)
      : noise_(seed, stream),
        frequency_(radius_km / wavelength_km),
        octaves_(octaves),
        gain_(gain) {
    double sum = 0.0, squares = 0.0, amplitude = 1.0;
    for (int k = 0; k < octaves; ++k, amplitude *= gain) {
      sum += amplitude;
      squares += amplitude * amplitude;
    }
    constexpr double kDeviation = 0.29;  // of one octave
    scale_ = sum / (kDeviation * std::sqrt(squares));
  }
  double operator()(const std::array<double, 3>& at) const {
    return scale_ * noise_.fbm(at, frequency_, octaves_, gain_);
  }

 private:
  Noise noise_;
  double frequency_;
  int octaves_;
  double gain_, scale_;
};

}  // namespace geo
