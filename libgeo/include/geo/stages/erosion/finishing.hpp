#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/noise/noise_row.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// Noise that breaks the coherence of channels (blueprint 4.5a). Returns whether there was any.
template <class V>
bool inject_noise(const ErosionParameters& p, const ActiveVariables<V>& active, const Grid& grid,
                  std::uint64_t seed, std::span<V> elevation_m) {
  if (p.noise_injection_m <= 0.0) return false;
  constexpr double kFrequency = 48.0;
  constexpr float kLowest_m = 0.5F;
  const Noise noise(seed, "erosion.injected");
  const V amplitude(active(p.noise_injection_m));
#pragma omp parallel for schedule(dynamic, 4)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      V& height = elevation_m[grid.cell(i, j)];
      if (value_of(height) < 0.0) continue;
      const auto at = grid.unit_vector(i, j);
      const float bump = noise.value(static_cast<float>(at[0] * kFrequency),
                                     static_cast<float>(at[1] * kFrequency),
                                     static_cast<float>(at[2] * kFrequency));
      height = greater(V(height + amplitude * V(bump)), V(kLowest_m));
    }
  }
  return true;
}

/// Noise of the warping of the ground, along one row of the grid. Its derivative with respect to
/// the wavelength is a difference of the noise alone, extrapolated from two steps (Richardson's
/// way) over which the finest waves hardly move: right to about 1e-4.
class WarpingRow {
 public:
  WarpingRow(const Grid& grid, const Noise& noise, double wavelength_km)
      : noise_(noise),
        row_(grid),
        radius_km_(1e-3 * grid.figure().radius_m),
        wavelength_km_(wavelength_km),
        bend_(grid.nx()) {}

  /// In the columns that are wanted.
  template <class Wanted>
  void draw(int j, Wanted&& wanted) {
    row_.choose(j, wanted);
    draw(wavelength_km_, bend_);
  }
  /// How it changes with the wavelength, km-1, in the row that was drawn last.
  void draw_rate() {
    // The noise is read at places that scale with radius / wavelength, the finest octave at four
    // times that.
    constexpr double kMove = 0.03;  // of a wave of the finest octave
    const double step_km = kMove / (4.0 * radius_km_) * wavelength_km_ * wavelength_km_;
    rate_.assign(bend_.size(), 0.0F);
    for (const auto& [part, weight] : {std::pair{1.0, -1.0 / 3.0}, std::pair{0.5, 4.0 / 3.0}}) {
      draw(wavelength_km_ - part * step_km, shorter_);
      draw(wavelength_km_ + part * step_km, longer_);
      const double scale = weight / (2.0 * part * step_km);
      for (std::size_t i = 0; i < rate_.size(); ++i) {
        rate_[i] += static_cast<float>(scale * (longer_[i] - shorter_[i]));
      }
    }
  }
  [[nodiscard]] float bend(int column) const { return bend_[column]; }
  [[nodiscard]] float rate_1_km(int column) const { return rate_[column]; }

 private:
  void draw(double km, std::vector<float>& line) {
    line.resize(bend_.size());
    row_.fbm(noise_, radius_km_ / km, 3, 0.5, line);
  }

  const Noise& noise_;
  NoiseRow row_;
  double radius_km_, wavelength_km_;
  std::vector<float> bend_, rate_, shorter_, longer_;
};

/// The latest warping of the ground, which rivers have not yet cut through. Returns whether there
/// was any.
template <class V>
bool warp(const ErosionParameters& p, const ActiveVariables<V>& active, const Grid& grid,
          std::uint64_t seed, std::span<V> elevation_m) {
  if (p.warping_m <= 0.0 || p.steps == 0) return false;
  // Shores keep their place: the warping sets in with height.
  constexpr double kDeviation = 0.19;  // of the noise
  constexpr float kFull_m = 150.0F;
  const Noise noise(seed, "erosion.warping");
  const Arithmetic<V> wavelength_km = active(p.warping_km);
  const bool wavelength_matters = carries_derivative(wavelength_km);
  const V amplitude(active(p.warping_m) / kDeviation);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto row = errors.make<WarpingRow>(grid, noise, p.warping_km);
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        V* heights = &elevation_m[grid.cell(0, j)];
        row->draw(j, [&](int i) { return value_of(heights[i]) > 0.0; });
        if (wavelength_matters) row->draw_rate();
        for (int i = 0; i < grid.nx(); ++i) {
          V& height = heights[i];
          if (value_of(height) <= 0.0) continue;
          V bend(row->bend(i));
          if (wavelength_matters) {
            bend += V(static_cast<double>(row->rate_1_km(i)) * (wavelength_km - p.warping_km));
          }
          bend *= amplitude;
          const V part = lesser(V(height / V(kFull_m)), V(1.0F));
          height = greater(V(height + part * bend), V(V(0.2F) * height));
        }
      });
    }
  }
  errors.rethrow();
  return true;
}

}  // namespace geo
