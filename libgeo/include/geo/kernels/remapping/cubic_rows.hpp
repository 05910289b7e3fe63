#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Reads fields of one sphere grid at the cell centres of another, row by row, so that a smooth
/// field needs no copy at full resolution. Catmull-Rom cubics along meridians and parallels,
/// across the date line and the poles; where both grids are equal the values come back unchanged.
class CubicRows {
 public:
  CubicRows(const Grid& from, const Grid& to);
  /// Values of `field` (one per cell of `from`) along row `row` of `to`. `scratch` is resized.
  /// V may carry derivatives (core/numeric.hpp).
  template <class V>
  void read(const std::vector<V>& field, int row, std::span<V> out, std::vector<V>& scratch) const;

 private:
  struct Stencil {
    int first;
    std::array<float, 4> weight;
  };
  static std::vector<Stencil> stencils(int from, int to);
  int nx_, ny_;
  std::vector<Stencil> columns_, rows_;
};

template <class V>
void CubicRows::read(const std::vector<V>& field, int row, std::span<V> out,
                     std::vector<V>& scratch) const {
  using Weight = std::conditional_t<std::is_same_v<V, float>, float, double>;
  constexpr int kMargin = 2;
  scratch.assign(nx_ + 2 * kMargin, V(0.0F));
  const Stencil& meridian = rows_[row];
  for (int k = 0; k < 4; ++k) {
    if (meridian.weight[k] == 0.0F) continue;
    int j = meridian.first + k, shift = 0;
    if (j < 0) j = -1 - j, shift = nx_ / 2;
    if (j >= ny_) j = 2 * ny_ - 1 - j, shift = nx_ / 2;
    const V* values = field.data() + static_cast<std::size_t>(j) * nx_;
    V* to = scratch.data() + kMargin;
    for (int i = 0; i < nx_ - shift; ++i) to[i] += Weight(meridian.weight[k]) * values[i + shift];
    for (int i = nx_ - shift; i < nx_; ++i)
      to[i] += Weight(meridian.weight[k]) * values[i + shift - nx_];
  }
  for (int i = 0; i < kMargin; ++i) {
    scratch[i] = scratch[nx_ + i];
    scratch[nx_ + kMargin + i] = scratch[kMargin + i];
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Stencil& s = columns_[i];
    const V* v = scratch.data() + kMargin + s.first;
    out[i] = Weight(s.weight[0]) * v[0] + Weight(s.weight[1]) * v[1] + Weight(s.weight[2]) * v[2] +
             Weight(s.weight[3]) * v[3];
  }
}

}  // namespace geo
