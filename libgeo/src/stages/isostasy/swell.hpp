#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "geo/kernels/noise_row.hpp"

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

  /// A row's values, in the columns that were wanted.
  class Line {
   public:
    Line(const Swell& swell, int columns) : swell_(swell), noise_(columns) {}
    void read(NoiseRow& row) {
      row.fbm(swell_.noise_, swell_.frequency_, swell_.octaves_, swell_.gain_, noise_);
    }
    double operator[](int column) const { return swell_.scale_ * noise_[column]; }

   private:
    const Swell& swell_;
    std::vector<float> noise_;
  };

 private:
  Noise noise_;
  double frequency_;
  int octaves_;
  double gain_, scale_;
};

}  // namespace geo
