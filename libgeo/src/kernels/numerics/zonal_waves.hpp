#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// The longest waves along each row of a sphere, cos mλ and sin mλ for m = 1 .. kWaves, taken out
/// of a field and diffused without splitting rows from columns. These are what passes straight
/// over a pole (m = 1 is a slope across it), where a split step would level it: shorter waves
/// vanish as r^m towards the pole. On a sphere diffusion keeps waves apart, so each is a
/// tridiagonal system along the meridian.
class ZonalWaves {
 public:
  explicit ZonalWaves(const Grid& grid);

  /// Moves the waves from the field into this object.
  template <class Real>
  void take_from(std::span<Real> field);
  /// One implicit solve of strength κ dt (m2): amplitudes a become (1 − κ dt ∇²)^-1 a.
  void solve(double strength_m2);
  /// Applies the solve twice and combines: (1 + √2) second − √2 first.
  void solve_second_order(double strength_m2);
  /// Adds the waves to the field.
  template <class Real>
  void return_to(std::span<Real> field) const;

 private:
  static constexpr int kWaves = 3;
  static constexpr int kSeries = 2 * kWaves;  // a cosine and a sine for each

  const Grid& grid_;
  std::vector<double> basis_;      // [kSeries][nx]
  std::vector<double> amplitude_;  // [ny][kSeries]
};

}  // namespace geo
