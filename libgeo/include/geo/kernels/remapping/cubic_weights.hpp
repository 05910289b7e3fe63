#pragma once

#include <array>

namespace geo {

/// Weights of the four values at -1, 0, 1 and 2 for a place `t` between 0 and 1: cubic convolution
/// with a = -1/2 (Catmull & Rom 1974; Keys 1981). Passes through the values, once continuously
/// differentiable, exact for parabolas; the weights sum to 1.
template <class Real>
[[nodiscard]] constexpr std::array<Real, 4> cubic_weights(Real t) {
  constexpr Real half(0.5), one(1), two(2), three(3), four(4), five(5);
  return {half * t * ((two - t) * t - one), half * (t * t * (three * t - five) + two),
          half * t * ((four - three * t) * t + one), half * t * t * (t - one)};
}

/// The same of the cubic B-spline, which smooths: between the values, twice continuously
/// differentiable; the weights are positive and sum to 1.
template <class Real>
[[nodiscard]] constexpr std::array<Real, 4> b_spline_weights(Real t) {
  constexpr Real one(1), two(2), three(3), six(6);
  const Real u = one - t;
  return {u * u * u / six, two / three - t * t * (two - t) / two,
          two / three - u * u * (two - u) / two, t * t * t / six};
}

}  // namespace geo
