#pragma once

#include <cstddef>
#include <span>

namespace geo {

/// Factors of one tridiagonal matrix, lower_i x_{i-1} + diagonal_i x_i + upper_i x_{i+1} = d_i,
/// without pivoting (Thomas algorithm), for matrices whose diagonal dominates. All spans have n
/// values; lower_0 and upper_{n-1} are not used. Afterwards `upper` is what each unknown takes from
/// the next, and `diagonal` the inverse of what elimination leaves of it. Many systems side by side
/// have TridiagonalBlock.
template <class Number>
void factor_tridiagonal(std::span<const Number> lower, std::span<Number> upper,
                        std::span<Number> diagonal) {
  diagonal[0] = 1.0 / diagonal[0];
  for (std::size_t i = 1; i < diagonal.size(); ++i) {
    upper[i - 1] = upper[i - 1] * diagonal[i - 1];
    diagonal[i] = 1.0 / (diagonal[i] - lower[i] * upper[i - 1]);
  }
}

/// Solves with these factors: `values` is d before and x afterwards.
template <class Number>
void solve_tridiagonal(std::span<const Number> lower, std::span<const Number> upper,
                       std::span<const Number> inverse, std::span<Number> values) {
  values[0] *= inverse[0];
  for (std::size_t i = 1; i < values.size(); ++i) {
    values[i] = (values[i] - lower[i] * values[i - 1]) * inverse[i];
  }
  for (std::size_t i = values.size() - 1; i-- > 0;) values[i] -= upper[i] * values[i + 1];
}

}  // namespace geo
