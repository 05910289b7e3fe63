#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace geo {

// Fields whose values may carry derivatives. A value V is float (how runs keep fields), double, a
// dual number (member `a`, its value, and `v`, an array of its V::DIMENSION derivatives), or
// std::complex<double> (complex-step differentiation). Formulas are written once for all of them.

namespace detail {
template <class V>
struct ArithmeticOf {
  using type = V;
};
template <>
struct ArithmeticOf<float> {
  using type = double;
};
}  // namespace detail

/// The type that values V are computed in: double for float, else V itself.
template <class V>
using Arithmetic = typename detail::ArithmeticOf<V>::type;

template <class V>
concept Dual = requires(const V& x) {
  x.a;
  x.v[0];
  V::DIMENSION;
};

/// The number itself, without what it carries.
template <class V>
[[nodiscard]] inline double value_of(const V& x) {
  if constexpr (Dual<V>) {
    return x.a;
  } else if constexpr (requires { x.imag(); }) {
    return x.real();
  } else {
    return static_cast<double>(x);
  }
}

/// Whether a number carries a derivative that is not zero.
template <class V>
[[nodiscard]] inline bool carries_derivative(const V& x) {
  if constexpr (Dual<V>) {
    for (int d = 0; d < V::DIMENSION; ++d) {
      if (x.v[d] != 0.0) return true;
    }
    return false;
  } else if constexpr (requires { x.imag(); }) {
    return x.imag() != 0.0;
  } else {
    return false;
  }
}

/// The lesser and the greater by value; which one is not differentiated.
template <class V>
[[nodiscard]] inline V lesser(const V& x, const V& y) {
  return value_of(y) < value_of(x) ? y : x;
}
template <class V>
[[nodiscard]] inline V greater(const V& x, const V& y) {
  return value_of(x) < value_of(y) ? y : x;
}
template <class V>
[[nodiscard]] inline V limited(const V& x, double low, double high) {
  return value_of(x) < low ? V(low) : value_of(x) > high ? V(high) : x;
}

/// exp(x) - 1 without loss near 0.
template <class V>
[[nodiscard]] inline V expm1_of(const V& x) {
  if constexpr (requires { x.imag(); }) {
    return {std::expm1(x.real()) * std::cos(x.imag()) + std::cos(x.imag()) - 1.0,
            std::exp(x.real()) * std::sin(x.imag())};
  } else {
    using std::expm1;
    return expm1(x);
  }
}

/// A parameter of the model as the number to compute with: the member itself, or, where it is one
/// of those that derivatives are wanted for, with its unit derivative. Told apart by address.
template <class V>
class ActiveVariables {
 public:
  using Number = Arithmetic<V>;
  struct Variable {
    const double* member;
    Number number;
  };
  ActiveVariables() = default;
  explicit ActiveVariables(std::vector<Variable> variables) : variables_(std::move(variables)) {}

  [[nodiscard]] Number operator()(const double& member) const {
    for (const Variable& variable : variables_) {
      if (variable.member == &member) return variable.number;
    }
    return Number(member);
  }

 private:
  std::vector<Variable> variables_;
};

/// Applies `kernel(span of real numbers, parameters)`, linear in its field but not in its K
/// parameters, to a field with all that it carries. Derivatives of the field go through the same
/// kernel. With respect to the kernel's own parameters they are central differences of the kernel
/// alone, on unrounded values: right to about 1e-9.
template <class V, std::size_t K, class Kernel>
void apply_linear(std::span<V> field, const std::array<Arithmetic<V>, K>& parameters,
                  Kernel&& kernel) {
  std::array<double, K> at{};
  for (std::size_t k = 0; k < K; ++k) at[k] = value_of(parameters[k]);
  if constexpr (std::is_floating_point_v<V>) {
    kernel(field, at);
  } else {
    const std::size_t cells = field.size();
    std::vector<double> values(cells), part(cells);
    const auto differentiate = [&](std::size_t k, std::vector<double>& out) {
      const double step = 1e-5 * std::max(std::abs(at[k]), 1e-3);
      std::vector<double> below(values);
      out = values;
      auto moved = at;
      moved[k] = at[k] + step;
      kernel(std::span<double>(out), moved);
      moved[k] = at[k] - step;
      kernel(std::span<double>(below), moved);
      for (std::size_t c = 0; c < cells; ++c) out[c] = (out[c] - below[c]) / (2.0 * step);
    };
    for (std::size_t c = 0; c < cells; ++c) values[c] = value_of(field[c]);
    const auto carried = [&](auto&& get, auto&& set, auto&& of_parameter) {
      bool moves = false;
      for (std::size_t c = 0; c < cells; ++c) {
        part[c] = get(field[c]);
        moves = moves || part[c] != 0.0;
      }
      if (moves) kernel(std::span<double>(part), at);
      for (std::size_t k = 0; k < K; ++k) {
        const double rate = of_parameter(parameters[k]);
        if (rate == 0.0) continue;
        std::vector<double> change;
        differentiate(k, change);
        for (std::size_t c = 0; c < cells; ++c) part[c] += rate * change[c];
        moves = true;
      }
      if (!moves) return;
      for (std::size_t c = 0; c < cells; ++c) set(field[c], part[c]);
    };
    if constexpr (Dual<V>) {
      for (int d = 0; d < V::DIMENSION; ++d) {
        carried([d](const V& x) { return x.v[d]; }, [d](V& x, double to) { x.v[d] = to; },
                [d](const V& x) { return x.v[d]; });
      }
    } else {
      carried([](const V& x) { return x.imag(); }, [](V& x, double to) { x.imag(to); },
              [](const V& x) { return x.imag(); });
    }
    kernel(std::span<double>(values), at);
    for (std::size_t c = 0; c < cells; ++c) {
      if constexpr (Dual<V>) {
        field[c].a = values[c];
      } else {
        field[c].real(values[c]);
      }
    }
  }
}
template <class V, class Kernel>
void apply_linear(std::span<V> field, Kernel&& kernel) {
  apply_linear<V, 0>(field, {}, [&](auto values, const auto&) { kernel(values); });
}

}  // namespace geo
