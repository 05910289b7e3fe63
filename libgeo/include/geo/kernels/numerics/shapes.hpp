#pragma once

#include <cmath>

#include "geo/core/numeric.hpp"

namespace geo {

/// 0 up to `from`, 1 beyond `to`, between them the cubic 3 t2 - 2 t3, flat at both ends.
template <class V>
[[nodiscard]] inline Arithmetic<V> smooth_step(const Arithmetic<V>& from, const Arithmetic<V>& to,
                                               const V& x) {
  using Number = Arithmetic<V>;
  const Number t = limited(Number((x - from) / (to - from)), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Gaussian bell of height 1 about `middle` with standard deviation `width`.
inline double bell(double x, double middle, double width) {
  const double t = (x - middle) / width;
  return std::exp(-0.5 * t * t);
}

}  // namespace geo
