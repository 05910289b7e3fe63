#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/noise/noise_row.hpp"

namespace geo {

/// Noise of whole grids by stream, for planets of the same seed and grid that follow each other.
using NoiseStore = std::map<std::string, std::vector<float>, std::less<>>;

/// Values of `noise` in every cell, from the store or into it; nullptr without a store.
inline const std::vector<float>* stored_fbm(const Grid& grid, const Noise& noise,
                                            std::string_view stream, double frequency, int octaves,
                                            double gain, NoiseStore* store) {
  if (store == nullptr) return nullptr;
  const std::string key = std::string(stream) + "@" + std::to_string(grid.nx());
  std::vector<float>& values = (*store)[key];
  if (!values.empty()) return &values;
  values.resize(grid.size());
  ParallelErrors errors;
#pragma omp parallel
  {
    NoiseRow row(grid);
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        row.choose_all(j);
        row.fbm(noise, frequency, octaves, gain,
                std::span<float>(values).subspan(grid.cell(0, j), grid.nx()));
      });
    }
  }
  errors.rethrow();
  return &values;
}

/// Gradient noise of several octaves scaled to unit standard deviation.
class UnitNoise {
 public:
  UnitNoise(const Grid& grid, std::uint64_t seed, std::string_view stream, double wavelength_km,
            int octaves, double gain, NoiseStore* store)
      : noise_(seed, stream),
        frequency_(1e-3 * grid.figure().radius_m / wavelength_km),
        octaves_(octaves),
        gain_(gain),
        stored_(stored_fbm(grid, noise_, stream, frequency_, octaves, gain, store)) {
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
    Line(const UnitNoise& source, int columns) : source_(source), noise_(columns) {}
    void read(NoiseRow& row) {
      if (source_.stored_ != nullptr) {
        std::copy_n(source_.stored_->begin() + row.first_cell(), noise_.size(), noise_.begin());
      } else {
        row.fbm(source_.noise_, source_.frequency_, source_.octaves_, source_.gain_, noise_);
      }
    }
    double operator[](int column) const { return source_.scale_ * noise_[column]; }

   private:
    const UnitNoise& source_;
    std::vector<float> noise_;
  };

 private:
  Noise noise_;
  double frequency_;
  int octaves_;
  double gain_, scale_;
  const std::vector<float>* stored_;
};

}  // namespace geo
