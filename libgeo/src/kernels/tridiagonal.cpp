#include "tridiagonal.hpp"

#include <algorithm>

#include "wide.hpp"

namespace geo {
namespace {

constexpr int kLanes = TridiagonalBlock::kLanes;
using Lanes = std::array<double, kLanes>;

/// Elimination from the first unknown to the last: `upper` becomes what each unknown takes from the
/// next, `inverse` that of the diagonal, to whose ends `first` and `last` are added.
TERRANE_WIDE void eliminate(int n, const double* __restrict lower, double* __restrict upper,
                            double* __restrict inverse, const Lanes& first, const Lanes& last) {
  Lanes above{}, added = first;
  for (int i = 0; i < n; ++i) {
    const std::size_t at = std::size_t(i) * kLanes;
    if (i == n - 1) added = last;
    for (int k = 0; k < kLanes; ++k) {
      const double low = lower[at + k], up = upper[at + k];
      const double pivot = 1.0 / (1.0 + low + up - low * above[k] + added[k]);
      inverse[at + k] = pivot;
      above[k] = upper[at + k] = up * pivot;
    }
    added = {};
  }
}

/// Four lanes, in a register (or two) from one unknown to the next.
using Quad = double __attribute__((vector_size(32), aligned(8), may_alias));
constexpr int kQuads = kLanes / 4;

/// x may be d.
TERRANE_WIDE void substitute(int n, const double* lower, const double* upper, const double* inverse,
                             const double* d, double* x) {
  Quad last[kQuads] = {};
  for (int i = 0; i < n; ++i) {
    for (int q = 0; q < kQuads; ++q) {
      const std::size_t at = std::size_t(i) * kLanes + 4 * q;
      const Quad& right = reinterpret_cast<const Quad&>(d[at]);
      const Quad& low = reinterpret_cast<const Quad&>(lower[at]);
      last[q] = (right + low * last[q]) * reinterpret_cast<const Quad&>(inverse[at]);
      reinterpret_cast<Quad&>(x[at]) = last[q];
    }
  }
  for (int i = n - 2; i >= 0; --i) {
    for (int q = 0; q < kQuads; ++q) {
      const std::size_t at = std::size_t(i) * kLanes + 4 * q;
      Quad& here = reinterpret_cast<Quad&>(x[at]);
      here += reinterpret_cast<const Quad&>(upper[at]) * last[q];
      last[q] = here;
    }
  }
}

TERRANE_WIDE void subtract(int n, const double* __restrict ring, const Lanes& share,
                           double* __restrict x) {
  for (int i = 0; i < n; ++i) {
    const std::size_t at = std::size_t(i) * kLanes;
    for (int k = 0; k < kLanes; ++k) x[at + k] -= ring[at + k] * share[k];
  }
}

}  // namespace

void TridiagonalBlock::factorise() {
  Lanes first{}, last{};
  if (!periodic_) return eliminate(n_, lower_.data(), upper_.data(), inverse_.data(), first, last);
  const double *lower_end = lower(0), *upper_end = upper(n_ - 1);
  double *ring_begin = ring_.data(), *ring_end = ring_begin + std::size_t(n_ - 1) * kLanes;
  std::fill(ring_.begin(), ring_.end(), 0.0);
  for (int k = 0; k < kLanes; ++k) {
    first[k] = 1.0 + lower_end[k] + upper(0)[k];
    last[k] = upper_end[k] * lower_end[k] / first[k];
    ring_begin[k] = -first[k];
    ring_end[k] = -upper_end[k];
    corner_[k] = lower_end[k] / first[k];
  }
  eliminate(n_, lower_.data(), upper_.data(), inverse_.data(), first, last);
  substitute(n_, lower_.data(), upper_.data(), inverse_.data(), ring_begin, ring_begin);
  for (int k = 0; k < kLanes; ++k) {
    ring_weight_[k] = 1.0 / (1.0 + ring_begin[k] + corner_[k] * ring_end[k]);
  }
}

void TridiagonalBlock::solve(const double* d, double* x) const {
  substitute(n_, lower_.data(), upper_.data(), inverse_.data(), d, x);
  if (!periodic_) return;
  Lanes share;
  const double* last = x + std::size_t(n_ - 1) * kLanes;
  for (int k = 0; k < kLanes; ++k) share[k] = (x[k] + corner_[k] * last[k]) * ring_weight_[k];
  subtract(n_, ring_.data(), share, x);
}

}  // namespace geo
