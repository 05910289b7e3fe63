#include "kernels/climate/ring_equations.hpp"

#include <algorithm>

#include "geo/core/error.hpp"
#include "kernels/numerics/thomas.hpp"
#include "kernels/numerics/wide.hpp"

namespace geo {
namespace {

using Complex = RingEquations::Complex;

/// A block of rows of every column: values `at + i * stride` and on, `count` of them, i < columns.
struct Block {
  int columns, stride, count;
};

/// to += coupling * from on a block.
TERRANE_WIDE void add_coupled(Block block, const double* coupling, const Complex* from,
                              Complex* to) {
  for (int i = 0; i < block.columns; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * block.stride;
    for (std::size_t k = at; k < at + block.count; ++k) to[k] += coupling[k] * from[k];
  }
}

/// to -= coupling * from on a block.
TERRANE_WIDE void take_coupled(Block block, const double* coupling, const Complex* from,
                               Complex* to) {
  for (int i = 0; i < block.columns; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * block.stride;
    for (std::size_t k = at; k < at + block.count; ++k) to[k] -= coupling[k] * from[k];
  }
}

/// to = own * from + west * (what lies a column before) + east * (a column after).
TERRANE_WIDE void multiply_rows(int nx, int ny, const Complex* own, const double* west,
                                const double* east, const Complex* from, Complex* to) {
  for (int i = 0; i < nx; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * ny;
    const Complex* const here = from + at;
    const Complex* const before = from + static_cast<std::size_t>(i > 0 ? i - 1 : nx - 1) * ny;
    const Complex* const after = from + static_cast<std::size_t>(i + 1 < nx ? i + 1 : 0) * ny;
    for (int k = 0; k < ny; ++k) {
      to[at + k] = own[at + k] * here[k] + west[at + k] * before[k] + east[at + k] * after[k];
    }
  }
}

/// The rows' equations without their corners, solved side by side: `values` is the right-hand side
/// before and the solution afterwards. `inverse` and `upper` as factor_tridiagonal leaves them.
TERRANE_WIDE void solve_open_rows(Block block, const double* west, const Complex* upper,
                                  const Complex* inverse, Complex* values) {
  for (int k = 0; k < block.count; ++k) values[k] *= inverse[k];
  for (int i = 1; i < block.columns; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * block.stride;
    for (std::size_t k = at; k < at + block.count; ++k) {
      values[k] = (values[k] - west[k] * values[k - block.stride]) * inverse[k];
    }
  }
  for (int i = block.columns - 2; i >= 0; --i) {
    const std::size_t at = static_cast<std::size_t>(i) * block.stride;
    for (std::size_t k = at; k < at + block.count; ++k) {
      values[k] -= upper[k] * values[k + block.stride];
    }
  }
}

/// What the corners change in solutions of the open rows.
TERRANE_WIDE void close_rows(Block block, const Complex* last_share, const Complex* closing,
                             const Complex* corner, Complex* share, Complex* values) {
  const Complex* const last = values + static_cast<std::size_t>(block.columns - 1) * block.stride;
  for (int k = 0; k < block.count; ++k) {
    share[k] = (values[k] + last_share[k] * last[k]) * closing[k];
  }
  for (int i = 0; i < block.columns; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * block.stride;
    for (int k = 0; k < block.count; ++k) values[at + k] -= share[k] * corner[at + k];
  }
}

/// Pairs of real numbers as complex ones, which are laid out like them.
Complex* values_of(RingEquations::Vector& v) { return reinterpret_cast<Complex*>(v.data()); }
const Complex* values_of(const RingEquations::Vector& v) {
  return reinterpret_cast<const Complex*>(v.data());
}

}  // namespace

RingEquations::RingEquations(const Grid& grid)
    : nx_(grid.nx()), ny_(grid.ny()), even_((grid.ny() + 1) / 2) {
  if (grid.topology() == Topology::plane) throw Bug("ring equations: the grid has edges");
  const auto size = static_cast<std::size_t>(grid.size());
  own_.assign(size, 0.0);
  for (auto* const side : {&west_, &east_, &south_, &north_}) side->assign(size, 0.0);
}

void RingEquations::add_own(Index cell, Complex w) {
  own_[place(static_cast<int>(cell % nx_), static_cast<int>(cell / nx_))] += w;
}

void RingEquations::add_exchange(int i, int j, int side, double w) {
  const std::size_t here = place(i, j);
  own_[here] += w;
  std::vector<double>& coupling = side == kEast    ? east_
                                  : side == kWest  ? west_
                                  : side == kNorth ? north_
                                                   : south_;
  coupling[here] -= w;
}

RingEquations::Vector RingEquations::operator*(const Vector& vector) const {
  Vector product(vector.size());
  const Complex* const x = values_of(vector);
  Complex* const y = values_of(product);
  multiply_rows(nx_, ny_, own_.data(), west_.data(), east_.data(), x, y);
  const int odd = ny_ - even_;
  // In a column even row 2k is at k, odd row 2k + 1 at even_ + k.
  add_coupled({nx_, ny_, even_ - 1}, south_.data() + 1, x + even_, y + 1);
  add_coupled({nx_, ny_, odd}, north_.data(), x + even_, y);
  add_coupled({nx_, ny_, odd}, south_.data() + even_, x, y + even_);
  add_coupled({nx_, ny_, even_ - 1}, north_.data() + even_, x + 1, y + even_);
  // From the last row to the first of a torus and back.
  const auto last = static_cast<std::ptrdiff_t>(place(0, ny_ - 1));
  add_coupled({nx_, ny_, 1}, south_.data(), x + last, y);
  add_coupled({nx_, ny_, 1}, north_.data() + last, x, y + last);
  return product;
}

void RingEquations::gather(std::span<const Complex> of_cells, Vector& vector) const {
  vector.resize(rows());
  Complex* const values = values_of(vector);
  for (int i = 0; i < nx_; ++i) {
    for (int j = 0; j < ny_; ++j) {
      values[place(i, j)] = of_cells[static_cast<std::size_t>(j) * nx_ + i];
    }
  }
}

void RingEquations::scatter(const Vector& vector, std::span<Complex> of_cells) const {
  const Complex* const values = values_of(vector);
  for (int j = 0; j < ny_; ++j) {
    for (int i = 0; i < nx_; ++i) {
      of_cells[static_cast<std::size_t>(j) * nx_ + i] = values[place(i, j)];
    }
  }
}

ZebraRows& ZebraRows::compute(const RingEquations& equations) {
  equations_ = &equations;
  const auto size = equations.own_.size();
  const int nx = equations.nx_, ny = equations.ny_;
  upper_.assign(size, 0.0);
  inverse_.assign(size, 0.0);
  corner_.assign(size, 0.0);
  last_share_.assign(ny, 0.0);
  closing_.assign(ny, 0.0);
  std::vector<Complex> lower(nx), upper(nx), inverse(nx), corner(nx);
  for (int k = 0; k < ny; ++k) {
    const auto at = [&](int i) { return static_cast<std::size_t>(i) * ny + k; };
    for (int i = 0; i < nx; ++i) {
      lower[i] = equations.west_[at(i)];
      upper[i] = equations.east_[at(i)];
      inverse[i] = equations.own_[at(i)];
    }
    // The matrix without its corners west[0] and east[n-1] is that plus u v^T,
    // u = (gamma, 0 ... east[n-1]), v = (1, 0 ... west[0] / gamma).
    const Complex gamma = -inverse.front(), first_west = lower.front(), last_east = upper.back();
    last_share_[k] = first_west / gamma;
    inverse.front() -= gamma;
    inverse.back() -= last_east * first_west / gamma;
    factor_tridiagonal<Complex>(lower, upper, inverse);
    std::fill(corner.begin(), corner.end(), Complex(0.0));
    corner.front() = gamma;
    corner.back() += last_east;
    solve_tridiagonal<Complex>(lower, upper, inverse, corner);
    closing_[k] = 1.0 / (1.0 + corner.front() + last_share_[k] * corner.back());
    for (int i = 0; i < nx; ++i) {
      upper_[at(i)] = upper[i];
      inverse_[at(i)] = inverse[i];
      corner_[at(i)] = corner[i];
    }
  }
  return *this;
}

ZebraRows::Vector ZebraRows::solve(const Vector& right) const {
  const RingEquations& of = *equations_;
  const int nx = of.nx_, ny = of.ny_, even = of.even_, odd = ny - even;
  Vector result(right.size());
  const Complex* const given = values_of(right);
  Complex* const solution = values_of(result);
  std::vector<Complex> share(even);
  const auto relax = [&](int first, int count) {
    const Block block{nx, ny, count};
    Complex* const values = solution + first;
    solve_open_rows(block, of.west_.data() + first, upper_.data() + first, inverse_.data() + first,
                    values);
    close_rows(block, last_share_.data() + first, closing_.data() + first, corner_.data() + first,
               share.data(), values);
  };
  const auto relax_even = [&] { relax(0, even); };
  const auto begin = [&](int first, int count) {
    for (int i = 0; i < nx; ++i) {
      const std::size_t at = static_cast<std::size_t>(i) * ny + first;
      std::copy_n(given + at, count, solution + at);
    }
  };
  begin(0, even);
  relax_even();
  begin(even, odd);
  take_coupled({nx, ny, odd}, of.south_.data() + even, solution, solution + even);
  take_coupled({nx, ny, even - 1}, of.north_.data() + even, solution + 1, solution + even);
  relax(even, odd);
  begin(0, even);
  take_coupled({nx, ny, even - 1}, of.south_.data() + 1, solution + even, solution + 1);
  take_coupled({nx, ny, odd}, of.north_.data(), solution + even, solution);
  relax_even();
  return result;
}

}  // namespace geo
