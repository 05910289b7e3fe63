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

}  // namespace geo
